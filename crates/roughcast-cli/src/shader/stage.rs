//! The fragment shaders of the SPIR-V modules: WGSL files with generic names, combined for each model.

use anyhow::{Result, bail};
use roughcast::Anisotropy;
use roughcast::shading::{Calls, Shading};
use roughcast::texture::{Layout, TexelReader};
use roughcast::wgsl::{self, Module, renamed};

const RESOURCES: &str = include_str!("stage/resources.wgsl");
const FOOTPRINT: &str = include_str!("stage/footprint.wgsl");
const SHADE: &str = include_str!("stage/shade.wgsl");

/// The functions that differ by model.
const OWN_FUNCTIONS: [&str; 11] = [
    "texel0",
    "texel1",
    "texel2",
    "finest0",
    "finest1",
    "finest2",
    "texture_size",
    "pixel_ratio",
    "detail_slope",
    "detail_distribution",
    "shade_model",
];

/// How the textures of a model's layout are read, including anisotropy.
pub fn reader_of(model: Shading) -> &'static TexelReader {
    let reader = model.layout().texel_reader(model.wanted(), Anisotropy::Anisotropic);
    reader.expect("every model samples its layout")
}

/// The module that reads the textures of a model's layout as a source of bumps.
pub fn detail_of(model: Shading) -> &'static Module {
    wgsl::module(reader_of(model).module).expect("every reader has a module")
}

/// The textures of a layout: their bindings and how they are sampled.
fn textures_of(layout: Layout) -> Result<&'static str> {
    Ok(match layout {
        Layout::Lean => include_str!("stage/lean.wgsl"),
        Layout::Clean => include_str!("stage/clean.wgsl"),
        Layout::Toksvig => include_str!("stage/toksvig.wgsl"),
        Layout::Variance => include_str!("stage/variance.wgsl"),
        Layout::Pbr => include_str!("stage/pbr.wgsl"),
        _ => bail!("there are no bindings for the layout '{layout}'"),
    })
}

/// The modules that read the textures of a model's layout and shade them.
pub fn modules_of(model: Shading) -> Vec<&'static str> {
    // The host of an export samples the textures itself, so it has no use for a module of detail.
    let reading = detail_of(model).needs.iter().copied().filter(|name| *name != "detail");
    reading.chain([calls_of(model).module]).collect()
}

/// How a model is called for the distributions of its layout.
pub fn calls_of(model: Shading) -> Calls {
    model.calls(reader_of(model).gaussians)
}

/// WGSL of fragment shaders `shade_MODEL`, to be appended to a library with [`modules_of`] each model, `detail` and `reflectance`.
pub fn fragment_shaders(models: &[Shading]) -> Result<String> {
    let mut declared: Vec<&str> = Vec::new();
    let mut code = RESOURCES.to_owned();
    for model in models {
        let reader = reader_of(*model);
        let textures = textures_of(model.layout())?;
        // Models that share a layout share its bindings, which are declared once.
        let is_new = |line: &&str| !(line.starts_with('@') && declared.contains(line));
        let textures_once = textures.lines().filter(is_new).collect::<Vec<_>>().join("\n");
        declared.extend(textures.lines().filter(|line| line.starts_with('@')));
        let footprint = if reader.mean_input.is_some() { FOOTPRINT } else { "" };
        let detail = detail_of(*model).source;
        let parts = [&textures_once, footprint, detail, SHADE].join("\n");
        code += "\n";
        code += &renamed(&parts, &names_of(*model).iter().map(|(a, b)| (*a, b.as_str())).collect::<Vec<_>>());
    }
    Ok(code)
}

/// The generic names in the files, and their replacements for a model.
fn names_of(model: Shading) -> Vec<(&'static str, String)> {
    let identifier = model.name().replace('-', "_");
    let own = |name: &str| match name.strip_suffix("_model") {
        Some(start) => format!("{start}_{identifier}"),
        None => format!("{name}_{identifier}"),
    };
    let own = OWN_FUNCTIONS.iter().map(|name| (*name, own(name)));
    own.chain(calls_of(model).names().map(|(general, name)| (general, name.to_owned()))).collect()
}
