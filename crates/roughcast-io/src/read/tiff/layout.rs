//! The samples of a pixel: their type, the selection to read, and their names.

use super::directory::{Directory, tag};
use super::{FORMAT, SAVE_PLAIN};
use crate::ReadError;
use crate::read::memory::{malformed, unsupported};

/// Maximum number of samples per pixel. Multispectral images have more, but are not maps.
const MAX_SAMPLES: u64 = 1024;

/// The stored type of all samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Numbers {
    Unsigned,
    Signed,
    Float,
}

/// What the numbers mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Colours {
    Grey,
    /// Grey where 0 is white.
    GreyInverted,
    Rgb,
    /// Indices into a table of colours.
    Palette,
}

/// A sample that is read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Channel {
    /// Index of the sample in the pixel.
    pub sample: usize,
    pub name: String,
    /// Whether the file marks it as alpha.
    pub is_alpha: bool,
}

/// What a pixel contains.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    pub numbers: Numbers,
    pub bits: u32,
    /// Samples per pixel in the file, whether they are read or not.
    pub samples: usize,
    pub colours: Colours,
    /// The samples that are read. For a palette this is the index.
    pub channels: Vec<Channel>,
    /// Whether the colours were multiplied by their alpha.
    pub is_premultiplied: bool,
    /// Warnings for the user.
    pub warnings: Vec<String>,
}

impl Layout {
    /// The layout of a directory's image with the named channels, or with the unambiguous ones if no names are given.
    pub fn of(directory: &Directory<'_>, wanted: &[String]) -> Result<Self, ReadError> {
        let samples = directory.unsigned_or(tag::SAMPLES_PER_PIXEL, 1)?;
        if samples == 0 {
            return Err(malformed(FORMAT, "it states 0 samples per pixel"));
        }
        if samples > MAX_SAMPLES {
            return Err(unsupported(FORMAT, format_args!("{samples} samples per pixel"), SAVE_PLAIN));
        }
        let samples = samples as usize;
        let (numbers, bits) = numbers_of(directory, samples)?;
        let colours = colours_of(directory, samples)?;
        let mut layout = Self {
            numbers,
            bits,
            samples,
            colours,
            channels: Vec::new(),
            is_premultiplied: false,
            warnings: Vec::new(),
        };
        layout.choose_channels(&alphas_of(directory, samples, colours)?, wanted)?;
        Ok(layout)
    }

    /// The layout of a 1-bit or 8-bit mask; `None` for any other bit depth.
    pub fn of_mask(directory: &Directory<'_>) -> Result<Option<Self>, ReadError> {
        const MASK: u64 = 4;
        let is_mask = directory.unsigned(tag::PHOTOMETRIC_INTERPRETATION)? == Some(MASK)
            && directory.unsigned_or(tag::SAMPLES_PER_PIXEL, 1)? == 1;
        let (numbers, bits) = numbers_of(directory, 1)?;
        if !is_mask || numbers != Numbers::Unsigned || !matches!(bits, 1 | 8) {
            return Ok(None);
        }
        Ok(Some(Self {
            numbers,
            bits,
            samples: 1,
            colours: Colours::Grey,
            channels: vec![Channel { sample: 0, name: "mask".to_owned(), is_alpha: false }],
            is_premultiplied: false,
            warnings: Vec::new(),
        }))
    }

    /// Names of all samples, colours first. Further samples whose meaning the file does not state are named by their
    /// number, as in OpenImageIO.
    fn names(&self, alphas: &[Alpha]) -> Vec<String> {
        // Several samples, none marked as alpha, are vectors, or colours from a writer that declares everything as
        // grey.
        let is_stated = alphas.iter().any(|alpha| *alpha != Alpha::No);
        let colours: &[&str] = match self.colours {
            Colours::Rgb => &["R", "G", "B"],
            _ if self.samples == 1 || is_stated => &["Y"],
            _ => &["R", "G", "B"],
        };
        let name = |(index, alpha): (usize, &Alpha)| match (colours.get(index), alpha) {
            (Some(name), _) => (*name).to_owned(),
            (None, Alpha::No) => format!("channel{index}"),
            (None, _) => "A".to_owned(),
        };
        alphas.iter().enumerate().map(name).collect()
    }

    fn choose_channels(&mut self, alphas: &[Alpha], wanted: &[String]) -> Result<(), ReadError> {
        let names = self.names(alphas);
        if self.colours == Colours::Palette {
            if self.samples > 1 {
                return Err(unsupported(FORMAT, "a palette with extra samples", SAVE_PLAIN));
            }
            self.channels = vec![Channel { sample: 0, name: "index".to_owned(), is_alpha: false }];
            return Ok(());
        }
        let channel = |sample: usize| Channel {
            sample,
            name: names[sample].clone(),
            is_alpha: alphas[sample] != Alpha::No,
        };
        if !wanted.is_empty() {
            let find = |name: &String| names.iter().position(|known| known.eq_ignore_ascii_case(name));
            // A channel chosen by name, even alpha, is treated as data.
            let called = |sample: usize| {
                let name = if names[sample] == "A" { "alpha" } else { &names[sample] };
                Channel { sample, name: name.to_owned(), is_alpha: false }
            };
            self.channels = wanted
                .iter()
                .map(|name| find(name).map(called).ok_or_else(|| no_such_channel(name, &names)))
                .collect::<Result<_, _>>()?;
            return Ok(());
        }
        if self.colours == Colours::GreyInverted && alphas.iter().any(|alpha| *alpha != Alpha::No) {
            return Err(unsupported(FORMAT, "an alpha with grey where 0 is white", SAVE_PLAIN));
        }
        let colours = if names[0] == "Y" { 1 } else { self.samples.min(3) };
        let alpha = (colours..self.samples).find(|&sample| alphas[sample] != Alpha::No);
        let fourth = (self.samples == 4 && colours == 3).then_some(3);
        if self.colours != Colours::Rgb && self.samples > 4 && alpha.is_none() {
            return Err(ReadError::OpenChannels { format: FORMAT, contents: list_of(&names) });
        }
        self.channels = (0..colours).chain(alpha.or(fourth)).map(channel).collect();
        if let Some(last) = self.channels.get_mut(3) {
            // A fourth sample without a stated meaning is treated as alpha, which is used only if its values show that
            // it matters.
            last.name = "A".to_owned();
        }
        self.is_premultiplied = alpha.is_some_and(|sample| alphas[sample] == Alpha::Associated);
        let read: Vec<usize> = self.channels.iter().map(|channel| channel.sample).collect();
        let unread: Vec<&str> = (0..self.samples)
            .filter(|sample| !read.contains(sample))
            .map(|sample| names[sample].as_str())
            .collect();
        if let [first, ..] = unread[..] {
            let rest =
                if unread.len() > 1 { format!(" to {}", unread[unread.len() - 1]) } else { String::new() };
            self.warnings
                .push(format!("of its {} samples per pixel, {first}{rest} are not read", self.samples));
        }
        Ok(())
    }

    /// Whether the samples form one bit stream, most significant bit first. OpenImageIO and tifffile treat 24-bit
    /// integers this way too, although libtiff swaps their bytes according to the byte order of the file.
    pub fn is_bit_stream(&self) -> bool {
        match self.numbers {
            Numbers::Float => false,
            _ => !matches!(self.bits, 8 | 16 | 32),
        }
    }

    /// `RGB 16-bit unsigned` and the like.
    pub fn words(&self) -> String {
        let colours = match self.colours {
            Colours::Palette => "palette",
            _ => match self.channels.iter().map(|channel| channel.name.as_str()).collect::<Vec<_>>()[..] {
                ["Y"] => "grey",
                ["Y", "A"] => "grey and alpha",
                ["R", "G"] => "two channels",
                ["R", "G", "B"] => "RGB",
                ["R", "G", "B", "A"] if self.channels[3].is_alpha => "RGBA",
                ["R", "G", "B", "A"] => "RGB and a fourth sample",
                _ => "channels",
            },
        };
        let numbers = match self.numbers {
            Numbers::Unsigned => "unsigned",
            Numbers::Signed => "signed",
            Numbers::Float => "float",
        };
        format!("{colours} {}-bit {numbers}", self.bits)
    }
}

fn no_such_channel(name: &str, names: &[String]) -> ReadError {
    ReadError::NoSuchChannel { format: FORMAT, wanted: name.to_owned(), contents: list_of(names) }
}

/// Names in one line of bounded length: a long list is abbreviated.
fn list_of(names: &[String]) -> String {
    const MOST: usize = 16;
    match names {
        [first @ .., last] if names.len() > MOST => format!("{} ... {last}", first[..MOST - 1].join(", ")),
        _ => names.join(", "),
    }
}

/// The meaning of a sample after the colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Alpha {
    No,
    /// The colours are multiplied by it.
    Associated,
    Unassociated,
}

/// Whether each sample of a pixel is alpha.
fn alphas_of(directory: &Directory<'_>, samples: usize, colours: Colours) -> Result<Vec<Alpha>, ReadError> {
    let mut alphas = vec![Alpha::No; samples];
    let Some(extra) = directory.values(tag::EXTRA_SAMPLES)? else { return Ok(alphas) };
    let base = if colours == Colours::Rgb { 3 } else { 1 };
    // The entries describe the last samples.
    let first = samples.saturating_sub(extra.len()).max(base);
    for (index, alpha) in alphas.iter_mut().skip(first).enumerate() {
        *alpha = match extra.unsigned(index) {
            Some(1) => Alpha::Associated,
            Some(2) => Alpha::Unassociated,
            _ => Alpha::No,
        };
    }
    Ok(alphas)
}

/// The type of the samples, which must be the same for all.
fn numbers_of(directory: &Directory<'_>, samples: usize) -> Result<(Numbers, u32), ReadError> {
    let all_same = |tag: u16, default: u64, what: &str| {
        let Some(values) = directory.values(tag)? else { return Ok(default) };
        let not_a_number = || malformed(FORMAT, format_args!("its tag {tag} is not an unsigned integer"));
        let first = values.unsigned(0).ok_or_else(not_a_number)?;
        let differs = (0..values.len().min(samples)).any(|index| values.unsigned(index) != Some(first));
        if differs {
            Err(unsupported(FORMAT, format_args!("samples of different {what}"), SAVE_PLAIN))
        } else {
            Ok(first)
        }
    };
    let bits = all_same(tag::BITS_PER_SAMPLE, 1, "sizes")?;
    let numbers = match all_same(tag::SAMPLE_FORMAT, 1, "types")? {
        // 4 is "undefined", which libtiff treats as unsigned.
        1 | 4 => Numbers::Unsigned,
        2 => Numbers::Signed,
        3 => Numbers::Float,
        5 | 6 => return Err(unsupported(FORMAT, "samples of complex numbers", SAVE_PLAIN)),
        other => return Err(malformed(FORMAT, format_args!("there is no sample format {other}"))),
    };
    let is_read = match numbers {
        Numbers::Unsigned => matches!(bits, 1..=32),
        Numbers::Signed => matches!(bits, 8 | 16 | 32),
        Numbers::Float => matches!(bits, 16 | 24 | 32 | 64),
    };
    if bits == 0 {
        return Err(malformed(FORMAT, "it states samples of 0 bits"));
    }
    if !is_read {
        let name = match numbers {
            Numbers::Unsigned => "unsigned integers",
            Numbers::Signed => "signed integers",
            Numbers::Float => "floats",
        };
        let what = format_args!("{name} of {bits} bits");
        return Err(unsupported(FORMAT, what, "save it as unsigned integers of 8 or 16 bits, or as floats"));
    }
    Ok((numbers, bits as u32))
}

fn colours_of(directory: &Directory<'_>, samples: usize) -> Result<Colours, ReadError> {
    let refuse = |what: &str| Err(unsupported(FORMAT, what, SAVE_PLAIN));
    match directory.unsigned(tag::PHOTOMETRIC_INTERPRETATION)? {
        Some(0) => Ok(Colours::GreyInverted),
        Some(2) if samples < 3 => {
            Err(malformed(FORMAT, format_args!("it states RGB of {samples} samples per pixel")))
        }
        Some(2) => Ok(Colours::Rgb),
        Some(3) => Ok(Colours::Palette),
        // The tag is required. If it is missing, libtiff also infers the value from the number of samples.
        None if samples >= 3 => Ok(Colours::Rgb),
        Some(1) | None => Ok(Colours::Grey),
        Some(4) => refuse("a transparency mask"),
        Some(5) => refuse("CMYK colour"),
        Some(6) => refuse("YCbCr colour"),
        Some(8..=10) => refuse("L*a*b* colour"),
        Some(32803) => refuse("a camera's colour filter array"),
        Some(32844 | 32845) => refuse("LogLuv colour"),
        Some(34892) => refuse("linear raw colour"),
        Some(other) => {
            Err(unsupported(FORMAT, format_args!("the photometric interpretation {other}"), SAVE_PLAIN))
        }
    }
}
