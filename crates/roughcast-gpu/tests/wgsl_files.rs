//! Validates every WGSL file of the library and of this crate with naga, in modules assembled the way the code does.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use roughcast::Anisotropy;
use roughcast::noise::Noise;
use roughcast::shading::Shading;
use roughcast::texture::Layout;
use roughcast::wgsl::{MODULES, Role, library, library_of, renamed};
use roughcast_gpu::GpuError;
use roughcast_gpu::render::{
    Bumps, Curvature, DetailSource, LevelOfDetail, MAX_SOURCES, Projection, ShaderKey, SourceKey, Strength,
    UvSlot, shader_source,
};
use roughcast_scene::{HeightDerivative, NoiseDetail, Perturbation, VolumeDerivative};

/// Parses and validates a module with every check that naga has.
fn validate(source: &str) -> Result<(), String> {
    let module = naga::front::wgsl::parse_str(source).map_err(|error| error.emit_to_string(source))?;
    let flags = naga::valid::ValidationFlags::all();
    let mut validator = naga::valid::Validator::new(flags, naga::valid::Capabilities::all());
    validator.validate(&module).map(drop).map_err(|error| error.emit_to_string(source))
}

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// The WGSL files in a folder and its subfolders, with their text.
fn files_in(folder: &Path) -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder of the repository") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(files_in(&path));
        } else if path.extension().is_some_and(|extension| extension == "wgsl") {
            let text = std::fs::read_to_string(&path).expect("text");
            found.push((path, text));
        }
    }
    found
}

#[test]
fn every_module_of_the_library_is_valid_with_what_it_needs() {
    let files = files_in(&folder("../roughcast/src"));
    assert!(files.len() > 30, "{}", files.len());
    for (path, text) in &files {
        assert!(MODULES.iter().any(|module| module.source == text), "{} is in no module", path.display());
    }
    assert_eq!(MODULES.len(), files.len());
    let alone = MODULES.iter().filter(|module| !matches!(module.role, Role::Detail | Role::Bake));
    for module in alone {
        let source = library(&[module.name]).expect("it exists");
        validate(&source).unwrap_or_else(|fault| panic!("{}: {fault}", module.name));
    }
    validate(&library_of(Role::Bake)).unwrap_or_else(|fault| panic!("the rules of baking: {fault}"));
}

/// All sources of bumps but those of layouts.
fn other_sources() -> Vec<DetailSource> {
    let heights = HeightDerivative::ALL.iter().map(|derivative| DetailSource::Heights(*derivative));
    let noise = VolumeDerivative::ALL.iter().flat_map(|derivative| {
        Perturbation::ALL.iter().map(|perturbation| {
            let noise = NoiseDetail::new(Noise::default());
            let noise = NoiseDetail { derivative: *derivative, perturbation: *perturbation, ..noise };
            DetailSource::Noise(noise.into())
        })
    });
    heights.chain(noise).chain([DetailSource::ObjectNormals, DetailSource::Flat]).collect()
}

/// Every source of bumps alone, in all projections; then two and three of them, of which all but the first are renamed.
fn surfaces() -> Vec<ShaderKey> {
    let reader =
        Layout::Lean.texel_reader(Shading::Lean.wanted(), Anisotropy::Isotropic).expect("it has one");
    let textures = DetailSource::Textures(reader);
    let mut keys = Vec::new();
    for source in other_sources().into_iter().chain([textures]) {
        for projection in
            [Projection::Mesh, Projection::Derivatives, Projection::Triplanar, Projection::Decal]
        {
            let source = SourceKey::new(source).with_projection(projection);
            keys.push(ShaderKey::of_sources(Shading::Lean, vec![source]));
            let below = SourceKey::new(textures);
            let above = source.with_uv_slot(UvSlot::Second).with_strength(Strength::Given);
            keys.push(ShaderKey::of_sources(Shading::Lean, vec![below, above]));
            keys.push(ShaderKey::of_sources(Shading::Ggx, vec![above, below, above]));
        }
    }
    keys
}

#[test]
fn every_shader_of_the_renderer_is_valid_and_has_all_of_its_files() {
    let mut sources = Vec::new();
    for layout in Layout::ALL {
        for (shading, anisotropy) in
            Shading::ALL.iter().flat_map(|s| Anisotropy::ALL.iter().map(move |a| (*s, *a)))
        {
            let Some(reader) = layout.texel_reader(shading.wanted(), anisotropy) else { continue };
            for level in [LevelOfDetail::Derivatives, LevelOfDetail::Fixed] {
                for bumps in [Bumps::Filtered, Bumps::Resolved] {
                    let key = ShaderKey::new(shading, DetailSource::Textures(reader))
                        .with_level(level)
                        .with_bumps(bumps);
                    let source = shader_source(&key).expect("the library has it");
                    validate(&source).unwrap_or_else(|fault| panic!("{layout}, {shading}: {fault}"));
                    sources.push(source);
                }
            }
        }
    }
    let levels = [LevelOfDetail::Derivatives, LevelOfDetail::Fixed];
    let every = |key: ShaderKey| {
        levels.iter().flat_map(move |level| {
            let key = key.clone().with_level(*level);
            [key.clone(), key.clone().with_curvature(Curvature::Filtered), key.with_bumps(Bumps::Resolved)]
        })
    };
    for key in surfaces().into_iter().flat_map(every) {
        let source = shader_source(&key).expect("the library has it");
        validate(&source).unwrap_or_else(|fault| panic!("{key:?}: {fault}"));
        sources.push(source);
    }
    assert!(sources.len() > 100, "{}", sources.len());
    // Any model in any layout: all detail modules, and all files of the renderer.
    let details = MODULES.iter().filter(|module| module.role == Role::Detail);
    let own = files_in(&folder("src/render"));
    assert!(own.len() > 10, "{}", own.len());
    let own = own.iter().map(|(path, text)| (path.display().to_string(), text.as_str()));
    for (name, text) in details.map(|module| (module.name.to_owned(), module.source)).chain(own) {
        let general = ["model_surface", "model_lobe"].iter().any(|name| text.contains(name));
        // The scene's file contains the model's names.
        let text = if general { text.lines().next().expect("a first line") } else { text };
        assert!(sources.iter().any(|source| source.contains(text)), "{name} is in no shader");
    }
}

/// Bindings of a bake, and constants that its host defines.
const BINDINGS: &str = "
@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(2) var map: texture_2d<f32>;
@group(0) @binding(3) var<storage, read_write> counts: array<atomic<u32>, 4>;
@group(0) @binding(4) var<storage, read> state_in: array<vec4f>;
@group(0) @binding(5) var<storage, read_write> state_out: array<vec4f>;
@group(0) @binding(6) var state_low: texture_2d<f32>;
@group(0) @binding(7) var state_high: texture_2d<f32>;
@group(0) @binding(8) var texture_0_1: texture_storage_2d<rgba16float, write>;
@group(0) @binding(9) var texture_1_1: texture_storage_2d<rgba16float, write>;
const MAP_STEPS = 255.0;
const MAP_X = 0;
const MAP_Y = 1;
const MAP_Z = 2;
const HALVINGS_1 = 1u;
const HALVINGS = 6u;
const WEIGHTED_TILE = 8u;
";
const STORES: &str = "@group(0) @binding(1) var<uniform> packed_stores: PackedStores;\n";
const SURVEY: &str = "@group(0) @binding(1) var<storage, read_write> packed_stores: PackedStores;
@group(0) @binding(10) var<storage, read_write> survey: Survey;
";
/// Functions that a fused kernel calls for the levels that are not tested here.
const OTHER_STORES: &str = "
fn store_0(at: vec2u, averages: Averages) {}
fn store_2(at: vec2u, averages: Averages) {}
fn store_3(at: vec2u, averages: Averages) {}
fn store_4(at: vec2u, averages: Averages) {}
fn store_5(at: vec2u, averages: Averages) {}
fn store_6(at: vec2u, averages: Averages) {}
";

/// The passes of a bake: files in addition to `common`. A name after `=` is WGSL from this test.
fn passes() -> Vec<Vec<&'static str>> {
    let normal = |texel, component, slope| vec![texel, component, slope, "neutral"];
    let height = |texel, of, gradient| vec![texel, of, gradient, "height"];
    let maps = [
        normal("map_unorm", "component_of_code", "normal_xyz"),
        normal("map_as_loaded", "component_unorm", "normal_xy"),
        normal("map_as_loaded", "component_signed", "normal_xyz"),
        height("map_unorm", "height_of_code", "gradient_sobel"),
        height("map_as_loaded", "height_of_value", "gradient_central"),
        height("map_as_loaded", "height_of_value", "gradient_forward"),
    ];
    let lean = ["averages_with_normal", "nearest_unorm16"];
    let clean = ["averages_without_normal", "nearest_half"];
    let mut passes = Vec::new();
    for map in &maps {
        let with = |rest: &[&'static str]| [map, rest].concat();
        passes.push(with(&["averages_with_normal", "scale"]));
        passes.push(with(&[&lean[..], &["slope_limit", "input_map", "raster", "output_lean"]].concat()));
        passes.push(with(&[&clean[..], &["slope_limit", "input_map", "raster", "output_clean"]].concat()));
        let stores = ["store_lean", "store_no_state", "store", "=others", "quad_of_four", "fused"];
        passes.push(with(&[&lean[..], &["slope_limit", "input_map_counted"], &stores].concat()));
    }
    passes.push(vec!["input_textures", "raster", "next_of_four", "output_state"]);
    passes.push(vec!["input_textures", "weighted", "raster", "next_weighted", "output_state"]);
    let later = ["input_buffer", "nearest_unorm8", "store_clean", "store_state", "store", "=others"];
    passes.push([&later[..], &["quad_weighted", "fused"]].concat());
    let weighted = ["input_buffer", "store_no_texels", "store_state", "store", "weighted", "weighted_kernel"];
    passes.push(weighted.to_vec());
    passes
}

#[test]
fn every_file_of_the_bake_is_valid_in_a_pass() {
    let files = files_in(&folder("src/bake/wgsl"));
    assert!(files.len() > 30, "{}", files.len());
    let stem = |path: &Path| path.file_stem().expect("a name").to_string_lossy().into_owned();
    let text_of = |name: &str| match name {
        "=others" => OTHER_STORES.to_owned(),
        name => {
            let found = files.iter().find(|(path, _)| stem(path) == name);
            let text = &found.unwrap_or_else(|| panic!("there is no {name}.wgsl")).1;
            let names = ["store", "store_texels", "store_state", "texture_0", "texture_1", "HALVINGS"];
            let pairs = names.map(|name| (format!("{name}_n"), format!("{name}_1")));
            renamed(text, &pairs.each_ref().map(|(from, to)| (from.as_str(), to.as_str())))
        }
    };
    let rules = library_of(Role::Bake);
    let mut tested = BTreeSet::from(["common".to_owned(), "copy".to_owned()]);
    for pass in passes() {
        let surveys = pass.contains(&"scale");
        let bindings = [BINDINGS, if surveys { SURVEY } else { STORES }].concat();
        let texts = pass.iter().map(|name| text_of(name)).collect::<Vec<_>>().join("\n");
        let source = [&rules, &text_of("common"), &bindings, &texts].map(String::as_str).join("\n");
        validate(&source).unwrap_or_else(|fault| panic!("{pass:?}: {fault}"));
        tested.extend(pass.iter().filter(|name| !name.starts_with('=')).map(|name| (*name).to_owned()));
    }
    let copy = "@group(0) @binding(0) var source: texture_2d<u32>;
@group(0) @binding(1) var copied: texture_storage_2d<rgba32uint, write>;\n";
    validate(&(copy.to_owned() + &text_of("copy"))).expect("the copy");
    let all: BTreeSet<String> = files.iter().map(|(path, _)| stem(path)).collect();
    assert_eq!(tested, all);
}

#[test]
fn no_source_of_bumps_and_too_many_are_refused() {
    for got in [0, 4] {
        let sources = vec![SourceKey::new(DetailSource::Flat); got];
        let key = ShaderKey::of_sources(Shading::Lean, sources);
        assert_eq!(shader_source(&key), Err(GpuError::Sources { most: MAX_SOURCES, got }));
    }
}

#[test]
fn what_is_not_valid_is_refused() {
    assert!(validate("fn f() -> f32 { return unknown; }").is_err());
    assert!(validate("fn f() -> f32 { return 1u; }").is_err());
}
