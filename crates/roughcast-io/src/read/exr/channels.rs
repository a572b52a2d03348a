//! Selects the channels of an EXR to read, and their order.

use exr::math::Vec2;
use exr::meta::MetaData;
use exr::meta::attribute::{ChannelDescription, SampleType as ExrSample};
use exr::meta::header::Header;
use roughcast::SampleType;

use super::super::memory::{malformed, unsupported};
use super::FORMAT;
use super::names::{Choice, choose};
use crate::{ReadError, ReadOptions};

/// Maximum number of channels of an image. OpenImageIO's bump slopes have six.
const MAX_CHANNELS: usize = 16;
/// Maximum number of channels of a file. Renderers write about two hundred; each costs time for every block.
const MAX_STORED_CHANNELS: usize = 1024;
/// Maximum number of layers listed in an error.
const MAX_LISTED: usize = 24;
/// The first of the six channels of OpenImageIO's and RenderMan's bump slopes, which belong together.
const FIRST_BUMP_SLOPE: &str = "b0_h";

/// The channels that become the image.
#[derive(Debug)]
pub(super) struct Selection {
    /// The part that contains them.
    pub(super) part: usize,
    /// In the order of the image.
    pub(super) channels: Vec<SelectedChannel>,
    /// Half if all channels are half, otherwise float.
    pub(super) sample_type: SampleType,
    /// The layer that contains them, if all channels of the file belong to layers.
    pub(super) layer: Option<String>,
    /// Description of the file's other contents, if the options chose nothing.
    pub(super) left_out: Option<String>,
}

/// A channel of the file that becomes a channel of the image.
#[derive(Debug)]
pub(super) struct SelectedChannel {
    /// Its name, without the layer.
    pub(super) name: String,
    /// How it is stored.
    pub(super) stored: SampleType,
    /// Bytes per pixel of the channels before it. In a row of n pixels, the channel begins at n times this offset.
    pub(super) bytes_before: usize,
}

/// The channels of one layer of one part.
struct Group<'a> {
    part: usize,
    /// Its display name: the name of the part, of the layer, or both; empty for channels without either.
    name: String,
    channels: Vec<Candidate<'a>>,
}

/// A channel of the file.
struct Candidate<'a> {
    /// Its name without the layer.
    name: String,
    channel: &'a ChannelDescription,
    bytes_before: usize,
}

/// Chooses the channels of the image: those named in `options`, or else the unambiguous ones.
///
/// Channels without a layer take precedence over channels in layers. If there are several layers, the options must name
/// one, unless only one has anything to read. `keep_all` takes all channels of the first part as they are.
///
/// # Errors
/// [`ReadError::Unsupported`]: luminance with chroma, subsampled channels, integers, more than 16 channels.
/// [`ReadError::OpenChannels`] and [`ReadError::NoSuchChannel`], which list what the file contains.
pub(super) fn select(meta: &MetaData, options: &ReadOptions, keep_all: bool) -> Result<Selection, ReadError> {
    let groups = groups(meta)?;
    if !options.channels.is_empty() {
        return named(&groups, options);
    }
    if let Some(layer) = &options.layer {
        let group = layer_of(&groups, layer)?;
        return clear(group, choice_of(group)).ok_or_else(|| open(&groups))?;
    }
    if keep_all || groups[0].channels[0].name == FIRST_BUMP_SLOPE {
        return selection(
            &groups[0],
            (0..groups[0].channels.len()).map(|i| (i, groups[0].channels[i].name.clone())).collect(),
        );
    }
    let choices: Vec<(&Group<'_>, Choice)> = groups.iter().map(|group| (group, choice_of(group))).collect();
    let promising: Vec<&(&Group<'_>, Choice)> =
        choices.iter().filter(|(_, choice)| *choice != Choice::Nothing).collect();
    // In a single part, the channels without a layer are the picture, and the layers are a renderer's additional
    // outputs.
    let one_part = groups.iter().all(|group| group.part == groups[0].part);
    let bare = promising.iter().find(|(group, _)| one_part && group.name.is_empty());
    let (group, choice) = match (bare, &promising[..]) {
        (Some(bare), _) => bare,
        (None, [only]) => only,
        _ => return Err(open(&groups)),
    };
    let mut selection = clear(group, choice.clone()).ok_or_else(|| open(&groups))??;
    let others: Vec<&Group<'_>> = groups.iter().filter(|other| other.name != group.name).collect();
    selection.left_out = (!others.is_empty()).then(|| listed(others.into_iter()));
    Ok(selection)
}

/// The layers of all flat parts, in the order of the file.
fn groups(meta: &MetaData) -> Result<Vec<Group<'_>>, ReadError> {
    let flat: Vec<(usize, &Header)> =
        meta.headers.iter().enumerate().filter(|(_, header)| !header.deep).collect();
    if flat.is_empty() {
        return Err(unsupported(FORMAT, "deep data", "flatten it first"));
    }
    let several_parts = meta.headers.len() > 1;
    let mut groups: Vec<Group<'_>> = Vec::new();
    for (part, header) in flat {
        let stored = &header.channels.list;
        if stored.len() > MAX_STORED_CHANNELS {
            let what = format!("a file of {} channels", stored.len());
            return Err(unsupported(FORMAT, what, "save the channels you need to a separate file"));
        }
        let part_name = header.own_attributes.layer_name.as_ref().map(super::text).filter(|_| several_parts);
        for (bytes_before, channel) in header.channels.channels_with_byte_offset() {
            let full = super::text(&channel.name);
            let (layer, name) = match full.rsplit_once('.') {
                Some((layer, name)) => (layer.to_owned(), name.to_owned()),
                None => (String::new(), full),
            };
            let name_of_group = group_name(part_name.as_deref(), &layer, several_parts.then_some(part));
            let candidate = Candidate { name, channel, bytes_before };
            match groups.iter_mut().find(|group| group.part == part && group.name == name_of_group) {
                Some(group) => group.channels.push(candidate),
                None => groups.push(Group { part, name: name_of_group, channels: vec![candidate] }),
            }
        }
    }
    if groups.is_empty() { Err(malformed(FORMAT, "it has no channels")) } else { Ok(groups) }
}

/// `part.layer`, or `layer` if the part has the same name (as Nuke and Blender write it). Parts without a name are
/// identified by their number.
fn group_name(part_name: Option<&str>, layer: &str, part: Option<usize>) -> String {
    let part_name = part_name.map(str::to_owned).or_else(|| part.map(|number| number.to_string()));
    match part_name {
        None => layer.to_owned(),
        Some(part) if layer.is_empty() || layer == part => part,
        Some(part) if layer.starts_with(&format!("{part}.")) => layer.to_owned(),
        Some(part) => format!("{part}.{layer}"),
    }
}

fn choice_of(group: &Group<'_>) -> Choice {
    let names: Vec<&str> = group.channels.iter().map(|candidate| candidate.name.as_str()).collect();
    choose(&names)
}

/// The selection for a clear choice; `None` if the choice is ambiguous. Luminance and chroma are never converted to
/// colours.
fn clear(group: &Group<'_>, choice: Choice) -> Option<Result<Selection, ReadError>> {
    if has_chroma(group) {
        return Some(Err(unsupported(FORMAT, "luminance with chroma", "save it as RGB")));
    }
    match choice {
        Choice::Clear(chosen) => Some(selection(group, chosen)),
        Choice::Nothing | Choice::Open => None,
    }
}

/// The layer whose name, or the last component of whose name, is this one, or the part with this number.
fn layer_of<'g, 'a>(groups: &'g [Group<'a>], wanted: &str) -> Result<&'g Group<'a>, ReadError> {
    let by = |test: &dyn Fn(&Group<'_>) -> bool| {
        let found: Vec<&Group<'a>> = groups.iter().filter(|group| test(group)).collect();
        if let [one] = found[..] { Some(one) } else { None }
    };
    let last = |group: &Group<'_>| group.name.rsplit('.').next().unwrap_or_default().to_owned();
    by(&|group| group.name == wanted)
        .or_else(|| by(&|group| group.name.eq_ignore_ascii_case(wanted)))
        .or_else(|| by(&|group| last(group).eq_ignore_ascii_case(wanted)))
        .or_else(|| by(&|group| wanted.parse() == Ok(group.part)))
        .ok_or_else(|| missing(groups, wanted))
}

/// The channels named in the options, in that order.
fn named(groups: &[Group<'_>], options: &ReadOptions) -> Result<Selection, ReadError> {
    let within: Vec<&Group<'_>> = match &options.layer {
        Some(layer) => vec![layer_of(groups, layer)?],
        None => groups.iter().collect(),
    };
    let mut chosen: Vec<(&Group<'_>, usize)> = Vec::new();
    for wanted in &options.channels {
        let full = |group: &Group<'_>, name: &str| {
            if group.name.is_empty() { name.to_owned() } else { format!("{}.{name}", group.name) }
        };
        let all = || within.iter().flat_map(|group| (0..group.channels.len()).map(move |i| (*group, i)));
        let by = |test: &dyn Fn(&Group<'_>, &str) -> bool| {
            let found: Vec<_> = all().filter(|(group, i)| test(group, &group.channels[*i].name)).collect();
            if let [one] = found[..] { Some(one) } else { None }
        };
        let found = by(&|group, name| full(group, name) == *wanted)
            .or_else(|| by(&|group, name| full(group, name).eq_ignore_ascii_case(wanted)))
            .or_else(|| by(&|_, name| name == wanted))
            .or_else(|| by(&|_, name| name.eq_ignore_ascii_case(wanted)));
        chosen.push(found.ok_or_else(|| missing(groups, wanted))?);
    }
    let part = chosen[0].0.part;
    if chosen.iter().any(|(group, _)| group.part != part) {
        return Err(unsupported(
            FORMAT,
            "an image made of channels of several parts",
            "choose channels of one part",
        ));
    }
    let channels = chosen.iter().map(|(group, i)| {
        let candidate = &group.channels[*i];
        // A channel chosen by name, even alpha, is treated as data.
        let name = if candidate.name.eq_ignore_ascii_case("A") { "alpha" } else { &candidate.name };
        candidate.selected(name)
    });
    of_channels(part, channels.collect::<Result<_, _>>()?, Some(chosen[0].0.name.clone()))
}

fn has_chroma(group: &Group<'_>) -> bool {
    group
        .channels
        .iter()
        .any(|channel| ["RY", "BY"].iter().any(|name| name.eq_ignore_ascii_case(&channel.name)))
}

fn selection(group: &Group<'_>, chosen: Vec<(usize, String)>) -> Result<Selection, ReadError> {
    let channels = chosen.into_iter().map(|(place, name)| group.channels[place].selected(&name));
    of_channels(group.part, channels.collect::<Result<_, _>>()?, Some(group.name.clone()))
}

fn of_channels(
    part: usize,
    channels: Vec<SelectedChannel>,
    layer: Option<String>,
) -> Result<Selection, ReadError> {
    if channels.len() > MAX_CHANNELS {
        let what = format!("an image of {} channels", channels.len());
        return Err(unsupported(
            FORMAT,
            what,
            "save the channels that are meant, at most 16, to a file of their own",
        ));
    }
    let all_half = channels.iter().all(|channel| channel.stored == SampleType::F16);
    let sample_type = if all_half { SampleType::F16 } else { SampleType::F32 };
    let layer = layer.filter(|name| !name.is_empty());
    Ok(Selection { part, channels, sample_type, layer, left_out: None })
}

/// Refuses subsampled channels: every block holds every channel, so a subsampled one shifts all channels after it.
pub(super) fn check_sampling(header: &Header) -> Result<(), ReadError> {
    if header.channels.list.iter().any(|channel| channel.sampling != Vec2(1, 1)) {
        return Err(unsupported(FORMAT, "a subsampled channel", "save all channels in full size"));
    }
    Ok(())
}

impl Candidate<'_> {
    fn selected(&self, name: &str) -> Result<SelectedChannel, ReadError> {
        let stored = match self.channel.sample_type {
            ExrSample::F16 => SampleType::F16,
            ExrSample::F32 => SampleType::F32,
            ExrSample::U32 => {
                let what = format!("the integer channel {}", self.name);
                return Err(unsupported(FORMAT, what, "save it as half or float"));
            }
        };
        Ok(SelectedChannel { name: name.to_owned(), stored, bytes_before: self.bytes_before })
    }
}

fn open(groups: &[Group<'_>]) -> ReadError {
    ReadError::OpenChannels { format: FORMAT, contents: listed(groups.iter()) }
}

fn missing(groups: &[Group<'_>], wanted: &str) -> ReadError {
    ReadError::NoSuchChannel { format: FORMAT, wanted: wanted.to_owned(), contents: listed(groups.iter()) }
}

/// A text list of layers with their channels: `Depth (Z), Normal (X, Y, Z)`.
fn listed<'g, 'a: 'g>(groups: impl Iterator<Item = &'g Group<'a>>) -> String {
    let words = |group: &Group<'_>| {
        let names: Vec<&str> = group.channels.iter().map(|channel| channel.name.as_str()).collect();
        if group.name.is_empty() {
            names.join(", ")
        } else {
            format!("{} ({})", group.name, names.join(", "))
        }
    };
    let mut all: Vec<String> = groups.map(words).collect();
    if all.len() > MAX_LISTED {
        let more = all.len() - MAX_LISTED;
        all.truncate(MAX_LISTED);
        all.push(format!("{more} more"));
    }
    all.join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_have_the_names_that_users_know() {
        assert_eq!(group_name(None, "ViewLayer.Normal", None), "ViewLayer.Normal");
        assert_eq!(group_name(Some("N"), "", Some(1)), "N");
        assert_eq!(group_name(Some("N"), "N", Some(1)), "N");
        assert_eq!(group_name(Some("View"), "View.Normal", Some(0)), "View.Normal");
        assert_eq!(group_name(Some("beauty"), "diffuse", Some(0)), "beauty.diffuse");
        assert_eq!(group_name(None, "", Some(2)), "2");
    }
}
