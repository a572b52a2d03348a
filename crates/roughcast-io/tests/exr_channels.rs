//! Which channels, layers, parts and pixels of an EXR are read. OpenImageIO wrote the files of `cases/`, which contain
//! the surface of `plain.png`; the expected values are those that OpenImageIO reads.

use std::io::Cursor;

use exr::prelude::*;
use roughcast_io::{Decoded, ReadError, ReadOptions, read_image, read_image_file};
use roughcast_testdata::find;

fn options(layer: Option<&str>, channels: &[&str]) -> ReadOptions {
    ReadOptions::default()
        .with_layer(layer.map(str::to_owned))
        .with_channels(channels.iter().map(|&name| name.to_owned()).collect())
}

fn read(case: &str, options: &ReadOptions) -> std::result::Result<Decoded, ReadError> {
    read_image_file(&find(&format!("cases/{case}.exr")), options)
}

/// The texel at column 20, row 10.
fn texel(decoded: &Decoded) -> Vec<f32> {
    (0..decoded.image.channels()).map(|channel| decoded.image.get(20, 10, channel)).collect()
}

/// Tolerance for the expected values, which were printed with six digits.
const PRINTED: f32 = 1e-6;

#[track_caller]
fn expect(decoded: &Decoded, names: &[&str], values: &[f32]) {
    assert_eq!(decoded.info.channels, names);
    let found = texel(decoded);
    let close = found.iter().zip(values).all(|(a, b)| (a - b).abs() < PRINTED);
    assert!(found.len() == values.len() && close, "{found:?}, not {values:?}");
}

/// The normal of the surface at that texel, according to OpenImageIO; `plain.png` has (73, 113, 242) there.
const NORMAL: [f32; 3] = [-0.427_210_36, -0.112_119_53, 0.897_173_64];

#[test]
fn channels_go_by_their_names() {
    let all = options(None, &[]);
    expect(&read("exr-alpha-first/e_XYA", &all).unwrap(), &["X", "Y"], &NORMAL[..2]);
    expect(&read("exr-alpha-first/e_NxA", &all).unwrap(), &["Nx", "Ny", "Nz"], &NORMAL);
    expect(&read("exr-red-green-blue/e_red", &all).unwrap(), &["R", "G", "B"], &NORMAL);
    expect(&read("exr-red-green-blue/orm_red", &all).unwrap(), &["R", "G", "B"], &[0.9, 0.5, 0.1]);
    for (case, name) in [
        ("exr-alpha-first/h_ZA", "Z"),
        ("exr-alpha-first/h_heightA", "height"),
        ("exr-height-and-mask/h_height_mask", "height"),
    ] {
        expect(&read(case, &all).unwrap(), &[name], &[HEIGHT]);
    }
}

/// The height at that texel, according to OpenImageIO.
const HEIGHT: f32 = 0.893_742;

#[test]
fn ambiguous_names_are_refused_with_a_list() {
    for (case, layers) in [
        (
            "missing-exr-layer-choice/e_Blender",
            "ViewLayer.Combined (A, B, G, R); ViewLayer.Depth (Z); ViewLayer.Normal (X, Y, Z)",
        ),
        ("missing-exr-layer-choice/e_multipart_C_N", "C (B, G, R); N (B, G, R)"),
    ] {
        let error = read(case, &options(None, &[])).unwrap_err();
        assert!(matches!(error, ReadError::OpenChannels { .. }), "{error}");
        assert!(error.to_string().contains(layers), "{error}");
    }
}

#[test]
fn layers_and_parts_are_chosen_by_name_or_number() {
    for (case, layer, names) in [
        ("missing-exr-layer-choice/e_Blender", "ViewLayer.Normal", ["X", "Y", "Z"]),
        ("missing-exr-layer-choice/e_Blender", "normal", ["X", "Y", "Z"]),
        ("missing-exr-layer-choice/e_multipart_C_N", "N", ["R", "G", "B"]),
        ("missing-exr-layer-choice/e_multipart_C_N", "1", ["R", "G", "B"]),
    ] {
        expect(&read(case, &options(Some(layer), &[])).unwrap(), &names, &NORMAL);
    }
    let error =
        read("missing-exr-layer-choice/e_Blender", &options(Some("Albedo"), &[])).unwrap_err().to_string();
    assert!(error.contains("'Albedo'") && error.contains("ViewLayer.Depth (Z)"), "{error}");
}

#[test]
fn channels_are_chosen_in_the_order_in_which_they_are_named() {
    let blender = "missing-exr-layer-choice/e_Blender";
    let [x, y, _] = NORMAL;
    let full = options(None, &["ViewLayer.Normal.Y", "viewlayer.normal.x"]);
    expect(&read(blender, &full).unwrap(), &["Y", "X"], &[y, x]);
    let within = options(Some("Normal"), &["x", "Y"]);
    expect(&read(blender, &within).unwrap(), &["X", "Y"], &[x, y]);
    // A short name is enough if it occurs only once in the file.
    expect(&read(blender, &options(None, &["Y"])).unwrap(), &["Y"], &[y]);
    let twice = read(blender, &options(None, &["Z"])).unwrap_err();
    assert!(matches!(twice, ReadError::NoSuchChannel { .. }), "depth and normal have a Z: {twice}");
    let parts =
        read("missing-exr-layer-choice/e_multipart_C_N", &options(None, &["C.R", "N.G"])).unwrap_err();
    assert!(parts.to_string().contains("several parts"), "{parts}");
    let alpha = read("exr-alpha-first/h_heightA", &options(None, &["A"])).unwrap();
    expect(&alpha, &["alpha"], &[1.0]);
}

#[test]
fn the_display_window_is_the_texture() {
    let crop = read("exr-windows/w_crop", &options(None, &[])).unwrap();
    assert_eq!((crop.image.width(), crop.image.height()), (64, 48));
    expect(&crop, &["R", "G", "B"], &NORMAL);
    for (x, y) in [(0, 0), (7, 20), (52, 20), (20, 3), (20, 44), (63, 47)] {
        assert_eq!([0, 1, 2].map(|channel| crop.image.get(x, y, channel)), [0.0; 3], "{x}, {y}");
    }
    assert_ne!(crop.image.get(8, 4, 2), 0.0);
    assert_ne!(crop.image.get(51, 43, 2), 0.0);
    let [warning] = &crop.info.warnings[..] else { panic!("{:?}", crop.info.warnings) };
    assert!(warning.contains("44x40 at (8, 4)") && warning.contains("64x48 at (0, 0)"), "{warning}");
}

/// The name of a part, and the name and value of each of its channels.
type Part<'a> = (Option<&'a str>, &'a [(&'a str, f32)]);

/// A file whose layers are in one part or in several.
fn written(parts: &[Part<'_>], display: IntegerBounds, data: IntegerBounds) -> Vec<u8> {
    let layers = parts.iter().map(|(name, channels)| {
        let len = data.size.area();
        let channel =
            |(name, value): &(&str, f32)| AnyChannel::new(*name, FlatSamples::F32(vec![*value; len]));
        let attributes = LayerAttributes {
            layer_name: name.map(Text::new_or_panic),
            layer_position: data.position,
            ..LayerAttributes::default()
        };
        let channels = AnyChannels::sort(channels.iter().map(channel).collect());
        Layer::new(data.size, attributes, Encoding::FAST_LOSSLESS, channels)
    });
    let mut file = Cursor::new(Vec::new());
    let image = Image::from_layers(ImageAttributes::new(display), layers.collect::<Layers<_>>());
    image.write().to_buffered(&mut file).expect("the image can be written");
    file.into_inner()
}

fn read_bytes(file: &[u8], options: &ReadOptions) -> std::result::Result<Decoded, ReadError> {
    read_image(file, None, options)
}

fn values(decoded: &Decoded) -> Vec<f32> {
    (0..decoded.image.channels()).map(|channel| decoded.image.get(0, 0, channel)).collect()
}

#[test]
fn files_of_other_programs_are_read_by_name_or_refused_as_ambiguous() {
    let window = IntegerBounds::new((0, 0), (4, 3));
    let houdini: &[(&str, f32)] = &[("debris", 1.0), ("height", 2.0), ("mask", 3.0), ("water", 4.0)];
    let beauty: &[(&str, f32)] = &[("R", 1.0), ("G", 2.0), ("B", 3.0), ("A", 4.0)];
    let with_layers: &[(&str, f32)] =
        &[("R", 1.0), ("G", 2.0), ("B", 3.0), ("N.X", 4.0), ("N.Y", 5.0), ("N.Z", 6.0)];
    let cases: &[(&[Part<'_>], Option<&[f32]>)] = &[
        (&[(None, houdini)], Some(&[2.0])),
        (&[(None, beauty)], Some(&[1.0, 2.0, 3.0, 4.0])),
        (&[(None, with_layers)], Some(&[1.0, 2.0, 3.0])),
        (&[(None, &[("N.x", 1.0), ("N.y", 2.0), ("N.z", 3.0)])], Some(&[1.0, 2.0, 3.0])),
        (
            &[(None, &[("normal.X", 1.0), ("normal.Y", 2.0), ("normal.Z", 3.0), ("id.objectId", 4.0)])],
            Some(&[1.0, 2.0, 3.0]),
        ),
        (&[(None, &[("V", 2.0), ("U", 1.0)])], Some(&[1.0, 2.0])),
        (&[(None, &[("Displacement", 1.0), ("A", 2.0)])], Some(&[1.0])),
        (&[(None, &[("foo", 1.0), ("bar", 2.0)])], None),
        (&[(None, &[("A", 1.0)])], None),
        (
            &[(None, &[("N.X", 1.0), ("N.Y", 2.0), ("N.Z", 3.0), ("P.X", 1.0), ("P.Y", 2.0), ("P.Z", 3.0)])],
            None,
        ),
        (
            &[
                (Some("N"), &[("X", 1.0), ("Y", 2.0), ("Z", 3.0)]),
                (Some("albedo"), beauty),
                (Some("C"), beauty),
            ],
            None,
        ),
        (
            &[(Some("N"), &[("X", 1.0), ("Y", 2.0), ("Z", 3.0)]), (Some("ids"), &[("objectId", 1.0)])],
            Some(&[1.0, 2.0, 3.0]),
        ),
    ];
    for (parts, expected) in cases {
        let read = read_bytes(&written(parts, window, window), &ReadOptions::default());
        match (read, expected) {
            (Ok(decoded), Some(expected)) => assert_eq!(values(&decoded), *expected, "{parts:?}"),
            (Err(ReadError::OpenChannels { .. }), None) => {}
            (other, _) => panic!("{parts:?}: {:?}", other.map(|decoded| decoded.info)),
        }
    }
    let file = written(&[(None, with_layers)], window, window);
    let told = read_bytes(&file, &ReadOptions::default()).unwrap().info.warnings;
    assert!(told.iter().any(|warning| warning.contains("left out: N (X, Y, Z)")), "{told:?}");
}

#[test]
fn overscan_is_cut_and_a_window_outside_refused() {
    let display = IntegerBounds::new((0, 0), (4, 3));
    let rgb: &[(&str, f32)] = &[("R", 1.0), ("G", 2.0), ("B", 3.0)];
    let over = written(&[(None, rgb)], display, IntegerBounds::new((-2, -1), (9, 7)));
    let decoded = read_bytes(&over, &ReadOptions::default()).unwrap();
    assert_eq!((decoded.image.width(), decoded.image.height()), (4, 3));
    assert!(
        decoded.info.warnings[0].contains("9x7 at (-2, -1)") && decoded.info.warnings[0].contains("cut off")
    );
    let outside = written(&[(None, rgb)], display, IntegerBounds::new((4, 0), (2, 2)));
    let error = read_bytes(&outside, &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.contains("outside of the display window"), "{error}");
}

#[test]
fn an_integer_channel_beside_the_map_does_not_matter() {
    let window = IntegerBounds::new((0, 0), (2, 1));
    let channels = [
        AnyChannel::new("height", FlatSamples::F16(vec![f16::from_f32(0.25), f16::from_f32(0.5)])),
        AnyChannel::new("objectId", FlatSamples::U32(vec![7, 70_000])),
    ];
    let layer = Layer::new(
        window.size,
        LayerAttributes::default(),
        Encoding::UNCOMPRESSED,
        AnyChannels::sort(channels.into_iter().collect()),
    );
    let mut file = Cursor::new(Vec::new());
    Image::from_layer(layer).write().to_buffered(&mut file).expect("the image can be written");
    let decoded = read_bytes(file.get_ref(), &ReadOptions::default()).unwrap();
    assert_eq!((values(&decoded), decoded.image.get(1, 0, 0)), (vec![0.25], 0.5));
    let error = read_bytes(file.get_ref(), &options(None, &["objectId"])).unwrap_err().to_string();
    assert!(error.contains("the integer channel objectId"), "{error}");
}
