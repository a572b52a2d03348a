//! Which channels of an EXR are read, and in which order.

use exr::math::Vec2;
use exr::meta::attribute::{ChannelDescription, ChannelList, SampleType as ExrSample};
use roughcast::SampleType;

use super::super::memory::{malformed, unsupported};
use super::FORMAT;
use crate::ReadError;

/// Channels of one image. OpenImageIO's bump slopes have six.
const MAX_CHANNELS: usize = 16;
/// Channels of one file. Renderers write some two hundred; each costs time for every block.
const MAX_STORED_CHANNELS: usize = 1024;

/// The channels that become the image.
#[derive(Debug)]
pub(super) struct Selection {
    /// In the order of the image.
    pub(super) channels: Vec<SelectedChannel>,
    /// Half where all of them are halves, else float.
    pub(super) sample_type: SampleType,
    /// The layer that they belong to, where the file has no channels without one.
    pub(super) layer: Option<String>,
}

/// One channel of the file that becomes one of the image.
#[derive(Debug)]
pub(super) struct SelectedChannel {
    /// Its name, without the layer.
    pub(super) name: String,
    /// How it is stored.
    pub(super) stored: SampleType,
    /// Bytes of a pixel that other channels take before it. In a row of n pixels it begins at n times as many.
    pub(super) bytes_before: usize,
}

/// Chooses the channels of the image.
///
/// Channels without a layer win over those of layers, of which only the first is read. Among them red, green and blue
/// make R, G, B with A where there is one; so do any of these four alone; else X, Y, Z in this order, or Y with A; else
/// all channels in alphabetical order, which is the file's.
///
/// # Errors
/// [`ReadError::Unsupported`]: luminance with chroma, subsampled channels, integers, more than 16 channels.
pub(super) fn select(list: &ChannelList) -> Result<Selection, ReadError> {
    let stored = &list.list;
    if stored.is_empty() {
        return Err(malformed(FORMAT, "it has no channels"));
    }
    if stored.len() > MAX_STORED_CHANNELS {
        let what = format!("a file of {} channels", stored.len());
        return Err(unsupported(FORMAT, what, "save the channels that are meant to a file of their own"));
    }
    let (layer, candidates) = first_layer(list);
    let has = |name: &str| candidates.iter().any(|candidate| candidate.is(name));
    if has("RY") || has("BY") {
        return Err(unsupported(FORMAT, "luminance with chroma", "save it as RGB"));
    }
    // Every block holds every channel: one that is subsampled moves all that follow it.
    if stored.iter().any(|channel| channel.sampling != Vec2(1, 1)) {
        return Err(unsupported(FORMAT, "a subsampled channel", "save all channels in full size"));
    }
    let chosen = order(candidates);
    if chosen.len() > MAX_CHANNELS {
        let what = format!("an image of {} channels", chosen.len());
        return Err(unsupported(
            FORMAT,
            what,
            "save the channels that are meant, at most 16, to a file of their own",
        ));
    }
    let channels: Vec<SelectedChannel> =
        chosen.into_iter().map(Candidate::selected).collect::<Result<_, _>>()?;
    let all_half = channels.iter().all(|channel| channel.stored == SampleType::F16);
    let sample_type = if all_half { SampleType::F16 } else { SampleType::F32 };
    Ok(Selection { channels, sample_type, layer })
}

/// A channel of the layer that is read.
struct Candidate<'a> {
    /// Its name without the layer.
    name: String,
    channel: &'a ChannelDescription,
    bytes_before: usize,
}

impl Candidate<'_> {
    fn is(&self, name: &str) -> bool {
        self.name.eq_ignore_ascii_case(name)
    }

    fn selected(self) -> Result<SelectedChannel, ReadError> {
        let stored = match self.channel.sample_type {
            ExrSample::F16 => SampleType::F16,
            ExrSample::F32 => SampleType::F32,
            ExrSample::U32 => {
                let what = format!("the integer channel {}", self.name);
                return Err(unsupported(FORMAT, what, "save it as half or float"));
            }
        };
        Ok(SelectedChannel { name: self.name, stored, bytes_before: self.bytes_before })
    }
}

/// The channels without a layer, or those of the layer that comes first, and its name.
fn first_layer(list: &ChannelList) -> (Option<String>, Vec<Candidate<'_>>) {
    let split = |channel: &ChannelDescription| -> (Option<String>, String) {
        let name = super::text(&channel.name);
        match name.rsplit_once('.') {
            Some((layer, name)) => (Some(layer.to_owned()), name.to_owned()),
            None => (None, name),
        }
    };
    let layers: Vec<(Option<String>, String)> = list.list.iter().map(split).collect();
    let wanted = if layers.iter().any(|(layer, _)| layer.is_none()) { None } else { layers[0].0.clone() };
    let candidates = list.channels_with_byte_offset().zip(layers).filter(|(_, (layer, _))| *layer == wanted);
    let candidates = candidates
        .map(|((bytes_before, channel), (_, name))| Candidate { name, channel, bytes_before })
        .collect();
    (wanted, candidates)
}

/// The candidates that are read, in the order of the image. Well-known names come out in capitals.
fn order(mut candidates: Vec<Candidate<'_>>) -> Vec<Candidate<'_>> {
    const COLOUR: &[&str] = &["R", "G", "B", "A"];
    const POSITION: &[&str] = &["X", "Y", "Z"];
    const LUMINANCE: &[&str] = &["Y", "A"];
    let has = |name: &&str| candidates.iter().any(|candidate| candidate.is(name));
    let only =
        |names: &[&str]| candidates.iter().all(|candidate| names.iter().any(|name| candidate.is(name)));

    let names = if COLOUR[..3].iter().all(has) || only(COLOUR) {
        COLOUR
    } else if POSITION.iter().all(has) {
        POSITION
    } else if only(LUMINANCE) {
        LUMINANCE
    } else {
        return candidates;
    };
    let mut ordered = Vec::new();
    for name in names {
        if let Some(i) = candidates.iter().position(|candidate| candidate.is(name)) {
            let candidate = candidates.swap_remove(i);
            ordered.push(Candidate { name: (*name).to_owned(), ..candidate });
        }
    }
    ordered
}

#[cfg(test)]
mod tests {
    use super::*;

    fn list(names: &[&str]) -> ChannelList {
        let half = |name: &&str| ChannelDescription::named(*name, ExrSample::F16);
        ChannelList::new(names.iter().map(half).collect())
    }

    fn names(stored: &[&str]) -> Vec<String> {
        select(&list(stored)).unwrap().channels.into_iter().map(|channel| channel.name).collect()
    }

    #[test]
    fn well_known_names_have_their_own_order() {
        assert_eq!(names(&["A", "B", "G", "R"]), ["R", "G", "B", "A"]);
        assert_eq!(names(&["B", "G", "R", "Y", "Z"]), ["R", "G", "B"]);
        assert_eq!(names(&["b", "g", "r"]), ["R", "G", "B"]);
        assert_eq!(names(&["G", "R"]), ["R", "G"]);
        assert_eq!(names(&["X", "Y", "Z", "w"]), ["X", "Y", "Z"]);
        assert_eq!(names(&["A", "Y"]), ["Y", "A"]);
    }

    #[test]
    fn other_names_stay_as_the_file_has_them() {
        let slopes = ["b0_h", "b1_dhds", "b2_dhdt", "b3_dhds2", "b4_dhdt2", "b5_dh2dsdt"];
        assert_eq!(names(&slopes), slopes);
        assert_eq!(names(&["A", "height"]), ["A", "height"]);
    }

    #[test]
    fn channels_without_a_layer_win() {
        assert_eq!(names(&["R", "diffuse.B", "diffuse.G", "diffuse.R"]), ["R"]);
        let layered = select(&list(&["n.X", "n.Y", "n.Z", "p.X", "p.Y", "p.Z"])).unwrap();
        assert_eq!(layered.layer.as_deref(), Some("n"));
        assert_eq!(layered.channels.len(), 3);
    }

    #[test]
    fn a_channel_knows_the_bytes_before_it() {
        let red = ChannelDescription::named("R", ExrSample::F32);
        let mut list = list(&["A", "B", "G"]);
        list.list.push(red);
        let selection = select(&ChannelList::new(list.list)).unwrap();
        let bytes: Vec<usize> = selection.channels.iter().map(|channel| channel.bytes_before).collect();
        assert_eq!(bytes, [6, 4, 2, 0]);
        assert_eq!(selection.sample_type, SampleType::F32);
    }

    #[test]
    fn refusals_name_the_reason() {
        let many: Vec<String> = (0..17).map(|i| format!("c{i:02}")).collect();
        let many: Vec<&str> = many.iter().map(String::as_str).collect();
        let mut subsampled = list(&["R"]);
        subsampled.list[0].sampling = Vec2(2, 2);
        let integer =
            ChannelList::new([ChannelDescription::named("Z", ExrSample::U32)].into_iter().collect());
        let cases = [
            (list(&["BY", "RY", "Y"]), "luminance with chroma"),
            (list(&many), "17 channels"),
            (subsampled, "subsampled"),
            (integer, "integer channel Z"),
        ];
        for (channels, reason) in cases {
            let error = select(&channels).unwrap_err().to_string();
            assert!(error.contains(reason), "{error}");
        }
    }
}
