//! Options of `bake` whose effect shows in its files: block compression, filters, the conventions of normal maps.

mod common;

use std::path::{Path, PathBuf};

use common::{bake, data, difference, moments, names, run, scratch, text, textures, unpacked};
use roughcast::texture::MomentLevel;
use roughcast::{Image, Samples};
use roughcast_io::{ReadOptions, png_levels, read_image_file};

fn map() -> PathBuf {
    data("materials/surfgrad_ocean16/normals_64crop_16bit_derived.png")
}

const FLOAT_MOMENTS: [&str; 4] = ["--as", "moments", "--bits", "float"];

/// The map's moments in floats, baked with these options.
fn float_moments(map: &Path, options: &[&str]) -> Vec<MomentLevel> {
    let folder = scratch();
    let output = folder.path().join("moments.exr");
    bake(map, &output, &[&FLOAT_MOMENTS[..], options].concat()).expect_success();
    moments(&output)
}

/// Blocks are made from the 8-bit texels, and both EXR files hold floats, so only the report's rounding remains.
const SIGMA_ROUNDING: f64 = 1e-5;

/// σ = sqrt(tr Σ / 2) of each texel of each level.
fn sigmas(levels: &[MomentLevel]) -> impl Iterator<Item = f64> {
    levels.iter().flat_map(|l| l.moments()).map(|m| f64::from(0.5 * m.covariance().trace()).sqrt())
}

#[test]
fn the_report_states_the_cost_of_block_compression() {
    for container in ["ktx2", "dds"] {
        for (layout, parts) in [
            ("variance", vec![("map", "BC5_UNORM")]),
            ("toksvig", vec![("map.normal", "BC5_UNORM"), ("map.gloss", "BC4_UNORM")]),
            ("pbr", vec![("map.normal", "BC5_UNORM"), ("map.roughness", "BC7_UNORM")]),
            ("pbr --roughness-layout r", vec![("map.normal", "BC5_UNORM"), ("map.roughness", "BC4_UNORM")]),
        ] {
            let (plain, blocks) = (scratch(), scratch());
            let words: Vec<&str> = layout.split(' ').collect();
            let (layout, further) = (words[0], &words[1..]);
            let options = ["--as", layout, "--bits", "8", "--specular-power", "64", "--json"];
            let options = [&options[..], further].concat();
            let output = |folder: &Path| folder.join("map").with_extension(container);
            bake(&map(), &output(plain.path()), &options).expect_success();
            let report =
                bake(&map(), &output(blocks.path()), &[&options[..], &["--compress", "bc"]].concat())
                    .expect_success()
                    .json();
            let file = |stem: &str| blocks.path().join(format!("{stem}.{container}"));
            for (stem, format) in &parts {
                let told = run(["info", text(&file(stem)), "--json"]).expect_success().json();
                let found = told["format"].as_str().expect("a text").to_owned();
                assert!(found.starts_with(format), "{layout} in {container}: {stem} is {found}");
            }
            let stated = report["compression"]["sigma_error_max"].as_f64().expect("a number");
            assert!(stated > 0.0, "{layout}: blocks are lossy");
            if layout == "toksvig" {
                // Toksvig's uncompressed form stores the normal in three channels, a form that blocks do not compress.
                continue;
            }
            let plain_first =
                names(plain.path()).into_iter().find(|name| !name.contains("roughness")).expect("a file");
            let before = unpacked(&plain.path().join(plain_first), plain.path());
            let after = unpacked(&file(parts[0].0), blocks.path());
            let off = sigmas(&before).zip(sigmas(&after)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(
                (off - stated).abs() <= SIGMA_ROUNDING,
                "{layout} in {container}: {off}, the report says {stated}"
            );
        }
    }
}

#[test]
fn packed_occlusion_roughness_and_metalness_become_bc7() {
    let folder = scratch();
    let output = folder.path().join("sphere.ktx2");
    let packed = data("crops/spheremat_orm_256.png");
    let normals = data("crops/spheremat_normal_256.png");
    let options =
        ["--as", "pbr", "--roughness", text(&packed), "--green", "down", "--compress", "bc", "--json"];
    let report = bake(&normals, &output, &options).expect_success().json();
    assert_eq!(names(folder.path()), ["sphere.normal.ktx2", "sphere.orm.ktx2"]);
    assert!(report["compression"]["sigma_error_rms"].as_f64().expect("a number") > 0.0);
    let orm = folder.path().join("sphere.orm.ktx2");
    let told = run(["info", text(&orm), "--json"]).expect_success().json();
    assert!(told["format"].as_str().expect("a text").starts_with("BC7_UNORM"), "{}", told["format"]);

    // Occlusion and metalness are only averaged, so their means equal those of the picture.
    /// BC7's error of single texels averages out; a channel in the wrong place is off by a tenth or more.
    const MEAN: f64 = 0.01;
    let source = read_image_file(&packed, &ReadOptions::default()).expect("the picture").image;
    let mean = |image: &Image, channel: usize| {
        let texels = image.width() * image.height();
        let samples = image.samples();
        let sum: f64 = (0..texels).map(|i| f64::from(samples.get(i * image.channels() + channel))).sum();
        sum / texels as f64
    };
    let orm = textures(&orm);
    let levels = orm.layers()[0].levels();
    for channel in [0, 2] {
        for level in levels {
            let (found, wanted) = (mean(level, channel), mean(&source, channel));
            assert!((found - wanted).abs() < MEAN, "channel {channel}: {found} for {wanted}");
        }
    }
    let base = mean(&source, 1);
    let filtered = mean(levels.last().expect("a level"), 1);
    assert!(filtered > base, "bumps add to the roughness: {filtered} from {base}");
}

#[test]
fn layouts_unfit_for_blocks_are_refused_with_the_reason() {
    let folder = scratch();
    let output = folder.path().join("map.ktx2");
    for layout in ["lean", "clean"] {
        let line = bake(&map(), &output, &["--as", layout, "--compress", "bc"]).expect_refusal(2, &map());
        assert!(
            line.contains("small difference of large numbers") && line.contains("--as variance"),
            "{line}"
        );
    }
    for layout in ["schilling", "schilling-isotropic"] {
        let line = bake(&map(), &output, &["--as", layout, "--compress", "bc"]).expect_refusal(2, &map());
        assert!(line.contains("cannot be block-compressed"), "{line}");
    }
    for name in ["map.exr", "map.png"] {
        let output = folder.path().join(name);
        bake(&map(), &output, &["--as", "pbr", "--compress", "bc"]).expect_usage_error(".ktx2 or .dds");
    }
    assert!(names(folder.path()).is_empty());
}

#[test]
fn filters_with_negative_lobes_are_refused_with_the_reason() {
    let folder = scratch();
    let output = folder.path().join("map.ktx2");
    for filter in ["lanczos3", "mitchell", "catrom"] {
        let outcome = bake(&map(), &output, &["--filter", filter]);
        assert_eq!(outcome.code, Some(2), "{}", outcome.stderr);
        assert!(outcome.stderr.contains("lobes below zero"), "{}", outcome.stderr);
    }
    let unknown = bake(&map(), &output, &["--filter", "boxx"]);
    assert!(unknown.code == Some(2) && unknown.stderr.contains("box, triangle"), "{}", unknown.stderr);
    assert!(names(folder.path()).is_empty());
    let levels = ["box", "triangle", "gaussian"].map(|filter| float_moments(&map(), &["--filter", filter]));
    for (a, b) in [(0, 1), (1, 2), (0, 2)] {
        assert_eq!(difference(&levels[a][..1], &levels[b][..1]).slope, 0.0, "level 0 is not filtered");
        assert!(difference(&levels[a], &levels[b]).slope > 0.0, "the filters differ");
    }
}

/// Writes a picture that the test has made.
fn write_png(path: &Path, image: &Image) {
    let mut bytes = Vec::new();
    png_levels::write_level(image, &Default::default(), &mut bytes).expect("PNG holds it");
    std::fs::write(path, bytes).expect("space");
}

/// The map with every pixel changed, in 16 bits.
fn changed(map: &Path, channels: usize, change: impl Fn([u16; 3]) -> Vec<u16>) -> Image {
    let image = read_image_file(map, &ReadOptions::default()).expect("the map").image;
    let Samples::U16(samples) = image.samples() else { panic!("the map has 16 bits") };
    let pixels = samples.chunks_exact(3).flat_map(|pixel| change([pixel[0], pixel[1], pixel[2]]));
    Image::new(image.width(), image.height(), channels, Samples::U16(pixels.collect())).expect("whole pixels")
}

/// Two forms of a 16-bit map differ by a code at most, times the slope's growth per component (1 + B^2, B = 1.04).
const CODE: f32 = 4.0 / 65535.0 * 2.1;

#[test]
fn conventions_of_normal_maps_give_the_same_moments() {
    let folder = scratch();
    let reference = float_moments(&map(), &[]);
    let down = folder.path().join("down.png");
    write_png(&down, &changed(&map(), 3, |[r, g, b]| vec![r, 65535 - g, b]));
    let read = float_moments(&down, &["--green", "down"]);
    assert!(difference(&read, &reference).slope <= CODE);
    let wrong = float_moments(&down, &[]);
    assert!(difference(&wrong, &reference).slope > 0.1, "green the other way is another map");

    // The vectors have unit length, so z follows from x and y.
    let two = folder.path().join("two.png");
    write_png(&two, &changed(&map(), 3, |[r, g, _]| vec![r, g, 0]));
    let read = float_moments(&two, &["--kind", "normal", "--normal-channels", "xy"]);
    assert!(difference(&read, &reference).slope <= 2.0 * CODE, "{:?}", difference(&read, &reference));
    let swizzled = folder.path().join("swizzled.png");
    write_png(&swizzled, &changed(&map(), 4, |[r, g, _]| vec![65535, g, 65535, r]));
    let read = float_moments(&swizzled, &["--kind", "normal", "--normal-channels", "ag"]);
    assert!(difference(&read, &reference).slope <= 2.0 * CODE, "{:?}", difference(&read, &reference));
}

/// The half floats of the derived map have eleven bits over 0 to 1, doubled and divided by z like the codes.
const HALF_CODE: f32 = 2.0 / 2048.0 * 2.1;

#[test]
fn floats_have_either_range_and_pictures_one() {
    let floats = data("crops/ocean_128_half.exr");
    let picture = data("crops/ocean_128.png");
    let [guessed, unorm, signed] = [vec![], vec!["--range", "unorm"], vec!["--range", "signed"]]
        .map(|options| float_moments(&floats, &[&["--kind", "normal"], &options[..]].concat()));
    assert_eq!(difference(&guessed, &unorm).slope, 0.0, "none of its values is below 0");
    assert!(difference(&guessed[..1], &float_moments(&picture, &[])[..1]).slope < HALF_CODE);
    // All components lie between 0 and 1: read as signed values, they make all slopes point up and to the right.
    assert!(signed[0].moments().iter().all(|m| m.mean.x > 0.0 && m.mean.y > 0.0));
    let folder = scratch();
    let refused = bake(&picture, &folder.path().join("out.ktx2"), &["--range", "signed"]);
    let line = refused.expect_refusal(2, &picture);
    assert!(line.contains("--range signed is for signed numbers"), "{line}");
}

#[test]
fn a_map_with_green_down_gets_a_warning() {
    let folder = scratch();
    let output = folder.path().join("map.ktx2");
    let directx = data("crops/rock020_normal_256.jpg");
    let options = ["--as", "clean", "--json"];
    let unaware = bake(&directx, &output, &options).expect_success();
    assert!(
        unaware.stderr.contains("--green down") && unaware.stderr.contains("correlation"),
        "{}",
        unaware.stderr
    );
    assert!(unaware.json()["green_correlation"].as_f64().expect("a number") < -0.3);
    let aware = bake(&directx, &output, &[&options[..], &["--green", "down"]].concat()).expect_success();
    assert!(aware.stderr.is_empty(), "{}", aware.stderr);
    assert!(aware.json()["green_correlation"].as_f64().expect("a number") > 0.3);
}

/// Near the horizon one code of BC5 is a large slope, so slopes steeper than 63 degrees are clamped in both versions.
const CUT: &str = "2";
/// Tolerance of mean slopes and of the roots of mean squares over the whole map: zero is off by half a code (127 or 128
/// of 255), and the derivative of the slope by the component averages 1.3.
const WHOLE_MAP: f32 = 0.004;
/// Tolerance of the root mean square difference between the slopes of single texels: BC5's codes are a fourteenth of a
/// block's range apart.
const TEXELS: f64 = 0.05;

#[test]
fn directx_and_opengl_versions_of_a_material_agree() {
    let directx = data("crops/spheremat_normal_256.png");
    let opengl = data("crops/spheremat_normal_256.dds");
    let down = float_moments(&directx, &["--green", "down", "--max-slope", CUT]);
    let up = float_moments(&opengl, &["--green", "up", "--max-slope", CUT]);
    let wrong = float_moments(&directx, &["--green", "up", "--max-slope", CUT]);
    let (agree, differ) = (rms_difference(&down, &up), rms_difference(&wrong, &up));
    assert!(agree < TEXELS && differ > 4.0 * TEXELS, "{agree}, with green the other way {differ}");
    let last = |levels: &[MomentLevel]| levels.last().expect("a level").moments()[0];
    let (a, b) = (last(&down), last(&up));
    let off =
        [a.mean.x - b.mean.x, a.mean.y - b.mean.y, a.xx.sqrt() - b.xx.sqrt(), a.yy.sqrt() - b.yy.sqrt()];
    assert!(off.iter().all(|off| off.abs() < WHOLE_MAP), "{off:?}");
}

fn rms_difference(a: &[MomentLevel], b: &[MomentLevel]) -> f64 {
    let texels = a[0].moments().iter().zip(b[0].moments());
    let squares =
        texels.map(|(a, b)| f64::from((a.mean.x - b.mean.x).powi(2) + (a.mean.y - b.mean.y).powi(2)));
    (squares.sum::<f64>() / a[0].moments().len() as f64).sqrt()
}
