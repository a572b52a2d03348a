//! The detection of `roughcast::detect` on real maps: the entries of MANIFEST.tsv must match what the pixels
//! show.

use image::{ColorType, DynamicImage};
use roughcast::detect::{
    GreenTest, GreenVerdict, KindGuess, guess_channels, guess_kind, guess_range, test_green,
};
use roughcast::{Image, Kind, NormalChannels, NormalRange, Samples};
use roughcast_testdata::{Row, find, is_extended, manifest};

/// Slopes are derived from normals whose z is at least this.
const MIN_Z: f32 = 0.02;

/// The rows of MANIFEST.tsv of one kind whose file is an ordinary picture.
fn rows(kind: &str) -> Vec<Row> {
    let rows = manifest().into_iter();
    rows.filter(|row| row["kind"] == kind && is_picture(&row["path"])).collect()
}

fn is_picture(path: &str) -> bool {
    [".png", ".jpg", ".webp", ".tga", ".exr", ".hdr"].iter().any(|ending| path.ends_with(ending))
}

/// The image as stored, and the names of its channels. `None` for EXR files whose compression or channels these tests'
/// decoder does not support.
fn load(path: &str) -> Option<(Image, Vec<&'static str>)> {
    let mut reader = image::ImageReader::open(find(path)).unwrap_or_else(|e| panic!("{path}: {e}"));
    reader.no_limits();
    let picture = match reader.decode() {
        Ok(picture) => picture,
        Err(_) if path.ends_with(".exr") => return None,
        Err(error) => panic!("{path}: {error}"),
    };
    let names = match picture.color() {
        ColorType::L8 | ColorType::L16 => vec!["Y"],
        ColorType::La8 | ColorType::La16 => vec!["Y", "A"],
        ColorType::Rgb8 | ColorType::Rgb16 | ColorType::Rgb32F => vec!["R", "G", "B"],
        _ => vec!["R", "G", "B", "A"],
    };
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let samples = match picture {
        DynamicImage::ImageLuma8(p) => Samples::U8(p.into_raw()),
        DynamicImage::ImageLumaA8(p) => Samples::U8(p.into_raw()),
        DynamicImage::ImageRgb8(p) => Samples::U8(p.into_raw()),
        DynamicImage::ImageRgba8(p) => Samples::U8(p.into_raw()),
        DynamicImage::ImageLuma16(p) => Samples::U16(p.into_raw()),
        DynamicImage::ImageLumaA16(p) => Samples::U16(p.into_raw()),
        DynamicImage::ImageRgb16(p) => Samples::U16(p.into_raw()),
        DynamicImage::ImageRgba16(p) => Samples::U16(p.into_raw()),
        DynamicImage::ImageRgb32F(p) => Samples::F32(p.into_raw()),
        DynamicImage::ImageRgba32F(p) => Samples::F32(p.into_raw()),
        other => panic!("{path}: unexpected pixels {:?}", other.color()),
    };
    Some((Image::new(width, height, names.len(), samples).expect("the decoder fills its image"), names))
}

/// Runs the curl test on a three-channel normal map.
fn green(path: &str) -> GreenTest {
    let (image, _) = load(path).unwrap_or_else(|| panic!("{path}: the decoder reads it"));
    let (mut bx, mut by) = (Vec::new(), Vec::new());
    for y in 0..image.height() {
        for x in 0..image.width() {
            let [nx, ny, nz] =
                [0, 1, 2].map(|c| NormalRange::Unorm.component_from_stored(image.get(x, y, c)));
            bx.push(nx / nz.max(MIN_Z));
            by.push(ny / nz.max(MIN_Z));
        }
    }
    test_green(&bx, &by, image.width(), image.height()).unwrap_or_else(|| panic!("{path}: too little signal"))
}

fn guess(path: &str) -> Option<KindGuess> {
    let (image, channels) = load(path)?;
    Some(guess_kind(&image, &channels, guess_range(&image)))
}

/// The minimum number of files that must be read, with the extended corpus and with the small set alone.
struct Fewest {
    extended: usize,
    small: usize,
}

impl Fewest {
    fn here(&self) -> usize {
        if is_extended() { self.extended } else { self.small }
    }
}

/// Checks that every file of a kind is classified as `expected`, and that enough of them could be read.
fn assert_kind(kind: &str, expected: Kind, fewest: Fewest) {
    let fewest = fewest.here();
    let guesses: Vec<_> =
        rows(kind).into_iter().filter_map(|row| Some((guess(&row["path"])?, row["path"].clone()))).collect();
    assert!(guesses.len() >= fewest, "only {} files of the kind '{kind}' were read", guesses.len());
    let wrong: Vec<_> = guesses.iter().filter(|(guess, _)| *guess != KindGuess::Certain(expected)).collect();
    assert!(wrong.is_empty(), "of the kind '{kind}': {wrong:#?}");
}

#[test]
fn normal_maps_are_normals() {
    assert_kind("normal", Kind::Normal, Fewest { extended: 41, small: 16 });
}

#[test]
fn height_maps_are_heights() {
    assert_kind("height", Kind::Height, Fewest { extended: 20, small: 9 });
}

/// Pixels cannot distinguish a roughness map from a height map; the guess is the same for both.
#[test]
fn grey_maps_of_other_kinds_count_as_heights() {
    assert_kind("roughness", Kind::Height, Fewest { extended: 4, small: 0 });
    assert_kind("ao", Kind::Height, Fewest { extended: 3, small: 1 });
    assert_kind("metalness", Kind::Height, Fewest { extended: 2, small: 0 });
    assert_kind("albedo (grey)", Kind::Height, Fewest { extended: 2, small: 0 });
}

#[test]
fn other_pictures_in_colour_are_doubtful() {
    let kinds = ["albedo", "orm", "hdr env", "hdr", "mask", "tangent", "flow/anisotropy"];
    let mut doubtful = 0;
    for row in kinds.iter().flat_map(|kind| rows(kind)) {
        let path = &row["path"];
        let Some((image, channels)) = load(path) else { continue };
        if image.channels() < 3 {
            continue; // A grey picture: see the test above.
        }
        match guess_kind(&image, &channels, guess_range(&image)) {
            KindGuess::Doubtful { reason } => assert!(!reason.is_empty(), "{path}"),
            certain => panic!("{path}: {certain:?}"),
        }
        doubtful += 1;
    }
    assert!(
        doubtful >= Fewest { extended: 20, small: 3 }.here(),
        "only {doubtful} pictures in colour were read"
    );
}

/// Blue contains z in all of the maps except two: one stores z without scale and bias, and one has a blue of 255 nearly
/// everywhere.
#[test]
fn blue_without_z_is_detected() {
    for row in rows("normal") {
        let path = &row["path"];
        let (image, channels) = load(path).unwrap_or_else(|| panic!("{path}: the decoder reads it"));
        let expected = match path.as_str() {
            "materials/simple_spheres_jme/Simple_normal.png" | "models/BoomBox/BoomBox_normal.png" => {
                NormalChannels::Xy
            }
            _ => NormalChannels::Xyz,
        };
        assert_eq!(guess_channels(&image, &channels, guess_range(&image)), expected, "{path}");
    }
}

#[test]
fn the_range_of_float_normals_is_detected() {
    let (as_unorm, channels) = load("crops/ocean_128_half.exr").expect("a plain EXR");
    assert_eq!(guess_range(&as_unorm), NormalRange::Unorm);

    let stored = (0..as_unorm.samples().len()).map(|i| as_unorm.samples().get(i));
    let components = stored.map(|value| NormalRange::Unorm.component_from_stored(value)).collect();
    let as_signed = Image::new(as_unorm.width(), as_unorm.height(), 3, Samples::F32(components)).unwrap();
    assert_eq!(guess_range(&as_signed), NormalRange::Signed);
    assert_eq!(guess_kind(&as_signed, &channels, NormalRange::Signed), KindGuess::Certain(Kind::Normal));
}

/// The direction that MANIFEST.tsv states, which was measured independently: against the height map of the same
/// material, or by the curl of the whole map.
fn stated_direction(row: &Row) -> Option<GreenVerdict> {
    let convention = row["convention"].as_str();
    match convention.split_whitespace().next() {
        Some("GL") => Some(GreenVerdict::Up),
        Some("DX") => Some(GreenVerdict::Down),
        _ => None,
    }
}

/// JPEG has destroyed this map's red channel: its correlation with the height map is only 0.07 (green's is 0.94), so no
/// curl can be measured. Undecided is the right answer.
const RED_IS_LOST: &str = "materials/woodfloor043/WoodFloor043_1K_Normal.jpg";

#[test]
fn the_direction_of_green_is_detected_if_known() {
    let (mut against_height, mut by_curl) = (0, 0);
    for row in rows("normal") {
        let path = row["path"].as_str();
        let Some(stated) = stated_direction(&row).filter(|_| path != RED_IS_LOST) else { continue };
        let test = green(path);
        assert_eq!(test.verdict(), stated, "{path}: {test:?}, {}", row["convention"]);
        if row["convention"].contains("measured vs height") { against_height += 1 } else { by_curl += 1 }
    }
    assert!(
        against_height >= Fewest { extended: 9, small: 4 }.here()
            && by_curl >= Fewest { extended: 29, small: 11 }.here(),
        "{against_height} and {by_curl} maps with a known direction"
    );
}

#[test]
fn the_direction_of_green_stays_open_if_unknown() {
    let unknown: Vec<Row> =
        rows("normal").into_iter().filter(|row| stated_direction(row).is_none()).collect();
    assert_eq!(unknown.len(), Fewest { extended: 2, small: 0 }.here(), "maps without a known direction");
    for path in unknown.iter().map(|row| row["path"].as_str()).chain([RED_IS_LOST]) {
        let test = green(path);
        assert_eq!(test.verdict(), GreenVerdict::Undecided, "{path}: {test:?}");
    }
}
