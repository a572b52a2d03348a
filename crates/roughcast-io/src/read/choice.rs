//! Channels chosen by name, for the formats without layers.

use crate::texels::{Source, swizzled};
use crate::{Decoded, ReadError, ReadOptions};

/// The picture with the channels named in the options, in that order; unchanged if the options name none.
///
/// # Errors
/// [`ReadError::NoSuchChannel`] if a channel does not exist or a layer is named.
pub(super) fn chosen(decoded: Decoded, options: &ReadOptions) -> Result<Decoded, ReadError> {
    let Decoded { image, mut info } = decoded;
    let missing = |wanted: &str| ReadError::NoSuchChannel {
        format: info.container,
        wanted: wanted.to_owned(),
        contents: info.channels.join(", "),
    };
    if let Some(layer) = &options.layer {
        return Err(missing(layer));
    }
    if options.channels.is_empty() {
        return Ok(Decoded { image, info });
    }
    let place = |wanted: &String| {
        let found = info.channels.iter().position(|name| name.eq_ignore_ascii_case(wanted));
        found.ok_or_else(|| missing(wanted))
    };
    let places = options.channels.iter().map(place).collect::<Result<Vec<usize>, _>>()?;
    let sources: Vec<Source> = places.iter().map(|&place| Source::Channel(place)).collect();
    let image = swizzled(&image, &sources);
    // A channel chosen by name, even alpha, is treated as data.
    let called = |place: usize| {
        if info.channels[place] == "A" { "alpha".to_owned() } else { info.channels[place].clone() }
    };
    info.channels = places.into_iter().map(called).collect();
    Ok(Decoded { image, info })
}

#[cfg(test)]
mod tests {
    use roughcast::{Image, Samples};

    use super::*;
    use crate::FileInfo;

    fn picture() -> Decoded {
        let image = Image::new(1, 1, 4, Samples::U8(vec![1, 2, 3, 4])).expect("a pixel");
        Decoded {
            image,
            info: FileInfo::of_picture("PNG", "RGBA 8-bit".to_owned(), (1, 1), &["R", "G", "B", "A"]),
        }
    }

    fn with(channels: &[&str]) -> ReadOptions {
        ReadOptions {
            channels: channels.iter().map(|&name| name.to_owned()).collect(),
            ..ReadOptions::default()
        }
    }

    #[test]
    fn channels_come_in_the_order_in_which_they_are_named() {
        let read = chosen(picture(), &with(&["a", "G"])).expect("both are there");
        assert_eq!(*read.image.samples(), Samples::U8(vec![4, 2]));
        assert_eq!(read.info.channels, ["alpha", "G"]);
    }

    #[test]
    fn missing_channels_are_refused_with_a_list() {
        let error = chosen(picture(), &with(&["height"])).expect_err("no height").to_string();
        assert!(error.contains("'height'") && error.contains("R, G, B, A"), "{error}");
        let layer = ReadOptions { layer: Some("N".to_owned()), ..ReadOptions::default() };
        assert!(matches!(chosen(picture(), &layer), Err(ReadError::NoSuchChannel { .. })));
    }
}
