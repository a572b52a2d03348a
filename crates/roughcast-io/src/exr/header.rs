//! The bytes before the offset table of an EXR file.
//!
//! Source: "OpenEXR File Layout". The `exr` crate could write them too, but it keeps attributes in hash maps, so the
//! bytes would differ between runs.

use std::collections::BTreeMap;

use roughcast::SampleType;
use roughcast::texture::TextureInfo;

use super::plan::{Plan, refusal};
use super::{ExrCompression, ExrOptions, TILE};
use crate::WriteError;

const MAGIC: u32 = 20_000_630;
const VERSION: u32 = 2;
const TILED: u32 = 0x200;
/// Names of attributes or channels have more than 31 bytes.
const LONG_NAMES: u32 = 0x400;
const SHORT_NAME: usize = 31;
const LONGEST_NAME: usize = 255;

const NO_COMPRESSION: u8 = 0;
const ZIP_COMPRESSION: u8 = 3;
const PIXEL_TYPE_HALF: i32 = 1;
const PIXEL_TYPE_FLOAT: i32 = 2;
const LINE_ORDER_INCREASING_Y: u8 = 0;
/// Level mode 1 (mip map), rounding mode 0 (down) in the upper four bits.
const MIP_MAP_ROUND_DOWN: u8 = 1;

const SOFTWARE: &str = "software";
const SOFTWARE_VALUE: &str = concat!("roughcast ", env!("CARGO_PKG_VERSION"));

/// Magic number, version and attributes.
///
/// # Errors
/// [`WriteError::Unsupported`] if a text attribute has a name that a file cannot contain.
pub(super) fn encode(plan: &Plan, info: &TextureInfo, options: &ExrOptions) -> Result<Vec<u8>, WriteError> {
    let mut attributes = structure(plan, options.compression);
    for (name, value) in text_attributes(info, options) {
        if name.is_empty() || name.len() > LONGEST_NAME || name.contains('\0') {
            return Err(refusal(format!("an attribute called {name:?}"), "use a name of 1 to 255 bytes"));
        }
        if attributes.contains_key(&name) {
            return Err(refusal(format!("a text attribute called '{name}'"), "OpenEXR reserves this name"));
        }
        if i32::try_from(value.len()).is_err() {
            return Err(refusal(format!("the value of '{name}'"), "it has more than 2 GiB"));
        }
        attributes.insert(name, ("string", value.into_bytes()));
    }
    let channel_names = plan.channels.iter().map(|channel| channel.name.len());
    let long = attributes.keys().map(String::len).chain(channel_names).any(|length| length > SHORT_NAME);
    let version = VERSION | TILED | if long { LONG_NAMES } else { 0 };

    let mut bytes = Vec::new();
    bytes.extend(MAGIC.to_le_bytes());
    bytes.extend(version.to_le_bytes());
    for (name, (kind, value)) in attributes {
        put_name(&name, &mut bytes);
        put_name(kind, &mut bytes);
        bytes.extend((value.len() as i32).to_le_bytes());
        bytes.extend(value);
    }
    bytes.push(0);
    Ok(bytes)
}

/// The attributes that describe the file's structure: name, type and value of each.
fn structure(plan: &Plan, compression: ExrCompression) -> BTreeMap<String, (&'static str, Vec<u8>)> {
    let (width, height) = plan.size();
    let window: Vec<u8> =
        [0, 0, width as i32 - 1, height as i32 - 1].iter().flat_map(|n| n.to_le_bytes()).collect();
    let compression = match compression {
        ExrCompression::Zip => ZIP_COMPRESSION,
        ExrCompression::None => NO_COMPRESSION,
    };
    let mut tiles = Vec::new();
    tiles.extend((TILE as u32).to_le_bytes());
    tiles.extend((TILE as u32).to_le_bytes());
    tiles.push(MIP_MAP_ROUND_DOWN);
    let one = 1_f32.to_le_bytes().to_vec();
    [
        ("channels", "chlist", channel_list(plan)),
        ("compression", "compression", vec![compression]),
        ("dataWindow", "box2i", window.clone()),
        ("displayWindow", "box2i", window),
        ("lineOrder", "lineOrder", vec![LINE_ORDER_INCREASING_Y]),
        ("pixelAspectRatio", "float", one.clone()),
        ("screenWindowCenter", "v2f", vec![0; 8]),
        ("screenWindowWidth", "float", one),
        ("tiles", "tiledesc", tiles),
    ]
    .into_iter()
    .map(|(name, kind, value)| (name.to_owned(), (kind, value)))
    .collect()
}

fn channel_list(plan: &Plan) -> Vec<u8> {
    let pixel_type = match plan.sample_type {
        SampleType::F16 => PIXEL_TYPE_HALF,
        SampleType::F32 => PIXEL_TYPE_FLOAT,
        SampleType::U8 | SampleType::U16 => unreachable!("the plan takes floats alone"),
    };
    let mut bytes = Vec::new();
    for channel in &plan.channels {
        put_name(channel.name, &mut bytes);
        bytes.extend(pixel_type.to_le_bytes());
        // The "linear" flag (a hint to lossy compressors), and three reserved bytes.
        bytes.extend([1, 0, 0, 0]);
        // No subsampling.
        bytes.extend(1_i32.to_le_bytes());
        bytes.extend(1_i32.to_le_bytes());
    }
    bytes.push(0);
    bytes
}

fn text_attributes(info: &TextureInfo, options: &ExrOptions) -> BTreeMap<String, String> {
    let mut texts = BTreeMap::from([
        (SOFTWARE.to_owned(), SOFTWARE_VALUE.to_owned()),
        ("textureformat".to_owned(), "Plain Texture".to_owned()),
    ]);
    texts.extend(options.attributes.clone());
    texts.extend(info.to_pairs());
    texts
}

fn put_name(name: &str, bytes: &mut Vec<u8>) {
    bytes.extend(name.as_bytes());
    bytes.push(0);
}
