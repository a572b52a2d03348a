//! Written textures are read back bit for bit.

use roughcast::SampleType;
use roughcast::texture::{TextureArray, layers_of};
use roughcast_io::{
    BlockFormat, Limits, Payload, Supercompression, WriteError, compress, dds, decompress, ktx2,
};

use crate::support::{assert_same_texels, dds_bytes, ktx2_bytes, noise_array, shortened};

/// Odd, thin and single-texel sizes, and one that is large enough for several blocks of rows.
const SIZES: [(usize, usize); 4] = [(53, 37), (1, 7), (1, 1), (640, 427)];
const SAMPLE_TYPES: [SampleType; 4] = [SampleType::U8, SampleType::U16, SampleType::F16, SampleType::F32];
const SUPERCOMPRESSIONS: [Supercompression; 2] = [Supercompression::None, Supercompression::Zstd];

fn check_all_containers(payload: Payload<'_>, wanted: &TextureArray, what: &str) {
    for supercompression in SUPERCOMPRESSIONS {
        let bytes = ktx2_bytes(payload, supercompression);
        assert!(bytes == ktx2_bytes(payload, supercompression), "{what}: written twice, two files");
        let back = ktx2::read_textures(&bytes, &Limits::default()).unwrap();
        assert_same_texels(&back, wanted, &format!("KTX2 {supercompression:?} {what}"));
        let image = ktx2::read_image(&bytes, &Limits::default()).unwrap();
        assert_eq!(
            (image.info.layers, image.info.levels),
            (wanted.layers().len(), wanted.level_count()),
            "{what}"
        );
        assert_eq!(image.info.metadata["roughcast.scale"], wanted.info.scale.to_string());
    }
    let bytes = dds_bytes(payload);
    let back = dds::read_textures(&bytes, &Limits::default()).unwrap();
    assert_same_texels(&back, wanted, &format!("DDS {what}"));
    let image = dds::read_image(&bytes, &Limits::default()).unwrap();
    assert_eq!(
        (image.info.layers, image.info.levels),
        (wanted.layers().len(), wanted.level_count()),
        "{what}"
    );
    assert_eq!(image.info.metadata, wanted.info.to_pairs(), "{what}");
}

#[test]
fn plain_texels_of_every_format() {
    for sample_type in SAMPLE_TYPES {
        for channels in [1, 2, 4] {
            for size in SIZES {
                for layers in 1..=3 {
                    let array = noise_array(sample_type, channels, size, layers);
                    let what = format!("{sample_type:?} x{channels}, {size:?}, {layers} layers");
                    check_all_containers(Payload::Texels(&array), &array, &what);
                }
            }
        }
    }
}

#[test]
fn blocks_of_every_format() {
    for format in [BlockFormat::Bc4, BlockFormat::Bc5, BlockFormat::Bc7] {
        for size in [(53, 37), (1, 7), (1, 1), (64, 28)] {
            for layers in 1..=3 {
                let array = noise_array(SampleType::U8, format.channels(), size, layers);
                let blocks = compress(&array, format).unwrap();
                let what = format!("{format:?}, {size:?}, {layers} layers");
                check_all_containers(Payload::Blocks(&blocks), &decompress(&blocks), &what);
            }
        }
    }
}

#[test]
fn a_chain_that_ends_early_is_kept_as_it_is() {
    let array = shortened(&noise_array(SampleType::U16, 2, (32, 16), 2), 3);
    check_all_containers(Payload::Texels(&array), &array, "three levels");
}

#[test]
fn the_same_file_for_any_number_of_threads() {
    let array = noise_array(SampleType::U8, 2, (300, 200), 2);
    let write_with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let blocks = compress(&array, BlockFormat::Bc5).unwrap();
            ktx2_bytes(Payload::Blocks(&blocks), Supercompression::Zstd)
        })
    };
    let one = write_with(1);
    assert!(one == write_with(2) && one == write_with(5));
}

fn refusal(payload: Payload<'_>) -> String {
    let ktx2 = ktx2::write(payload, Supercompression::None, &mut Vec::new()).unwrap_err();
    let dds = dds::write(payload, &mut Vec::new()).unwrap_err();
    assert!(matches!(ktx2, WriteError::Unsupported { container: "KTX2", .. }), "{ktx2}");
    assert!(matches!(dds, WriteError::Unsupported { container: "DDS", .. }), "{dds}");
    assert_eq!(ktx2.to_string().strip_prefix("KTX2"), dds.to_string().strip_prefix("DDS"));
    ktx2.to_string()
}

#[test]
fn unfit_payloads_are_refused_with_advice() {
    let three = noise_array(SampleType::U8, 3, (4, 4), 1);
    assert!(refusal(Payload::Texels(&three)).contains("3 channels: graphics processors seldom"));
    let six = noise_array(SampleType::F16, 6, (4, 4), 1);
    assert!(refusal(Payload::Texels(&six)).contains("6 channels: write EXR"));

    let layer = |channels| noise_array(SampleType::U8, channels, (8, 8), 1).layers()[0].clone();
    let mixed = TextureArray::new(three.info, vec![layer(4), layer(2)]).unwrap();
    assert!(refusal(Payload::Texels(&mixed)).contains("give all layers the same channels"));
}

#[test]
fn names_come_from_the_layout_where_they_fit_it() {
    let lean = noise_array(SampleType::U16, 4, (4, 4), 2);
    let back =
        ktx2::read_textures(&ktx2_bytes(Payload::Texels(&lean), Supercompression::None), &Limits::default());
    let specs = layers_of(&lean.info);
    assert_eq!(specs.len(), 2, "this test wants a layout of two layers");
    for (layer, spec) in back.unwrap().layers().iter().zip(specs) {
        assert_eq!((layer.name(), layer.channel_names()), (spec.name, spec.channels));
    }
    let other = noise_array(SampleType::U16, 4, (4, 4), 3);
    let back = dds::read_textures(&dds_bytes(Payload::Texels(&other)), &Limits::default()).unwrap();
    assert_eq!(back.layers()[2].name(), "layer2");
    assert_eq!(back.layers()[2].channel_names(), ["R", "G", "B", "A"]);
}
