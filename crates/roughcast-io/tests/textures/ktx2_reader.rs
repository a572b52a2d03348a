//! Checks our KTX2 files with an independent reader and against the rules of the specification.

use ktx2::{Format, Reader, SupercompressionScheme, dfd};
use roughcast::SampleType;
use roughcast::texture::TextureArray;
use roughcast_io::{BlockFormat, Payload, Supercompression, compress};
use roughcast_testdata::rows_with_files;

use crate::support::{bytes_of, ktx2_bytes, noise_array};

fn format_of(sample_type: SampleType, channels: usize) -> Format {
    match (sample_type, channels) {
        (SampleType::U8, 1) => Format::R8_UNORM,
        (SampleType::U8, 2) => Format::R8G8_UNORM,
        (SampleType::U8, 4) => Format::R8G8B8A8_UNORM,
        (SampleType::U16, 1) => Format::R16_UNORM,
        (SampleType::U16, 2) => Format::R16G16_UNORM,
        (SampleType::U16, 4) => Format::R16G16B16A16_UNORM,
        (SampleType::F16, 1) => Format::R16_SFLOAT,
        (SampleType::F16, 2) => Format::R16G16_SFLOAT,
        (SampleType::F16, 4) => Format::R16G16B16A16_SFLOAT,
        (SampleType::F32, 1) => Format::R32_SFLOAT,
        (SampleType::F32, 2) => Format::R32G32_SFLOAT,
        (SampleType::F32, 4) => Format::R32G32B32A32_SFLOAT,
        other => panic!("{other:?} is not written"),
    }
}

fn raw_level(array: &TextureArray, level: usize) -> Vec<u8> {
    let samples = array.layers().iter().map(|layer| layer.levels()[level].samples());
    let bytes = |samples: &roughcast::Samples| match samples {
        roughcast::Samples::U8(v) => v.clone(),
        roughcast::Samples::U16(v) => v.iter().flat_map(|s| s.to_le_bytes()).collect(),
        roughcast::Samples::F16(v) => v.iter().flat_map(|s| s.to_le_bytes()).collect(),
        roughcast::Samples::F32(v) => v.iter().flat_map(|s| s.to_le_bytes()).collect(),
    };
    samples.flat_map(bytes).collect()
}

/// Checks the header, descriptor and key-value data.
fn check_frame(file: &[u8], format: Format, layers: usize, size: (usize, usize), unit_bytes: u64) {
    let reader = Reader::new(file).unwrap();
    let header = reader.header();
    let mut wanted = dfd::Basic::from_format(format).unwrap();
    // The reader's table describes pictures; our values are not colours.
    wanted.0.color_primaries = None;
    assert_eq!(header.format, Some(format));
    assert_eq!(header.type_size, wanted.1, "typeSize of {format:?}");
    assert_eq!(reader.basic_dfd(), Some(&wanted.0), "descriptor of {format:?}");
    assert_eq!(reader.dfd_blocks().len(), 1);
    assert_eq!((header.pixel_width as usize, header.pixel_height as usize), size);
    assert_eq!((header.pixel_depth, header.face_count), (0, 1));
    assert_eq!(header.layer_count as usize, if layers == 1 { 0 } else { layers });

    let pairs: Vec<(&str, &[u8])> = reader.key_value_data().collect();
    assert!(pairs.iter().all(|(_, value)| value.ends_with(b"\0")), "text values end with NUL");
    assert!(pairs.windows(2).all(|pair| pair[0].0 < pair[1].0), "sorted by key: {pairs:?}");
    let value = |key: &str| pairs.iter().find(|pair| pair.0 == key).map(|pair| pair.1);
    assert_eq!(value("KTXorientation"), Some(&b"rd\0"[..]));
    assert_eq!(value("roughcast.layout"), Some(&b"lean\0"[..]));
    let writer = format!("roughcast {}", env!("CARGO_PKG_VERSION"));
    assert_eq!(reader.writer().map(|name| name.trim_end_matches('\0')), Some(writer.as_str()));
    check_layout(file, header.level_count as usize, header.supercompression_scheme.is_some(), unit_bytes);
}

/// Checks that the sections follow each other, aligned as required and without gaps, with levels from small to large.
fn check_layout(file: &[u8], levels: usize, supercompressed: bool, unit_bytes: u64) {
    let word = |at: usize| u64::from(u32::from_le_bytes(file[at..at + 4].try_into().unwrap()));
    let long = |at: usize| u64::from_le_bytes(file[at..at + 8].try_into().unwrap());
    assert_eq!(word(48), 80 + 24 * levels as u64, "descriptor behind the level index");
    assert_eq!(word(56), word(48) + word(52), "key-value data behind the descriptor");
    assert_eq!((long(64), long(72)), (0, 0), "no global data");
    let mut end = word(56) + word(60);
    for level in (0..levels).rev() {
        let (offset, length) = (long(80 + 24 * level), long(88 + 24 * level));
        // lcm(unit, 4), which for powers of two is the larger of both.
        let alignment = if supercompressed { 1 } else { unit_bytes.max(4) };
        assert_eq!(offset, end.next_multiple_of(alignment), "level {level}");
        assert!(file[end as usize..offset as usize].iter().all(|&byte| byte == 0), "padding is zero");
        end = offset + length;
    }
    assert_eq!(end, file.len() as u64, "nothing behind level 0");
}

#[test]
fn plain_texels_are_read_by_an_independent_reader() {
    for sample_type in [SampleType::U8, SampleType::U16, SampleType::F16, SampleType::F32] {
        for channels in [1, 2, 4] {
            for (layers, size) in [(1, (53, 37)), (3, (7, 1)), (2, (1, 1))] {
                let array = noise_array(sample_type, channels, size, layers);
                let unit_bytes = (sample_type.bytes() * channels) as u64;
                for supercompression in [Supercompression::None, Supercompression::Zstd] {
                    let file = ktx2_bytes(Payload::Texels(&array), supercompression);
                    check_frame(&file, format_of(sample_type, channels), layers, size, unit_bytes);
                    let reader = Reader::new(&file[..]).unwrap();
                    for (level, data) in reader.levels().enumerate() {
                        let raw = raw_level(&array, level);
                        assert_eq!(data.uncompressed_byte_length, raw.len() as u64);
                        let unpacked = match reader.header().supercompression_scheme {
                            None => data.data.to_vec(),
                            Some(SupercompressionScheme::Zstandard) => zstd::decode_all(data.data).unwrap(),
                            other => panic!("{other:?}"),
                        };
                        assert!(unpacked == raw, "{sample_type:?} x{channels}, level {level}");
                    }
                }
            }
        }
    }
}

#[test]
fn blocks_are_read_by_an_independent_reader() {
    let formats = [
        (BlockFormat::Bc4, Format::BC4_UNORM_BLOCK, 8),
        (BlockFormat::Bc5, Format::BC5_UNORM_BLOCK, 16),
        (BlockFormat::Bc7, Format::BC7_UNORM_BLOCK, 16),
    ];
    for (block_format, format, unit_bytes) in formats {
        for (layers, size) in [(1, (53, 37)), (3, (7, 1))] {
            let array = noise_array(SampleType::U8, block_format.channels(), size, layers);
            let blocks = compress(&array, block_format).unwrap();
            let file = ktx2_bytes(Payload::Blocks(&blocks), Supercompression::None);
            check_frame(&file, format, layers, size, unit_bytes);
            for (level, data) in Reader::new(&file[..]).unwrap().levels().enumerate() {
                let raw: Vec<u8> =
                    blocks.layers().iter().flat_map(|layer| layer.levels()[level].clone()).collect();
                assert!(data.data == raw, "{block_format:?}, level {level}");
            }
        }
    }
}

/// The descriptors in the Khronos tools' own files are the reference. Only the primaries may differ: ours are
/// unspecified (0), since the values are not colours, while those of most pictures are BT.709 (1).
#[test]
fn descriptors_match_the_khronos_tools() {
    const PRIMARIES: usize = 13;
    let descriptor = |file: &[u8]| {
        let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
        file[word(48)..word(48) + word(52)].to_vec()
    };
    let type_size = |file: &[u8]| file[16..20].to_vec();
    let plain = |sample_type, channels| {
        ktx2_bytes(Payload::Texels(&noise_array(sample_type, channels, (8, 8), 1)), Supercompression::None)
    };
    let blocks = |format: BlockFormat| {
        let array = noise_array(SampleType::U8, format.channels(), (8, 8), 1);
        ktx2_bytes(Payload::Blocks(&compress(&array, format).unwrap()), Supercompression::None)
    };
    let cases = [
        ("khr_s_normal_rgba8_mips.ktx2", plain(SampleType::U8, 4)),
        ("khr_s_normal_rg16_mips.ktx2", plain(SampleType::U16, 2)),
        ("khr_s_normal_rgba16_mips_zstd.ktx2", plain(SampleType::U16, 4)),
        ("khr_s_normal_bc5_mips.ktx2", blocks(BlockFormat::Bc5)),
        ("khr_s_normal_bc7_mips.ktx2", blocks(BlockFormat::Bc7)),
        ("bevy_mars_mie_phase.ktx2", plain(SampleType::F32, 4)),
    ];
    let cases = cases.map(|(name, ours)| (format!("formats/ktx2/{name}"), ours));
    for (name, ours) in rows_with_files(cases, |(name, _)| name) {
        let theirs = bytes_of(&name);
        let mut wanted = descriptor(&theirs);
        assert!(wanted[PRIMARIES] <= 1, "{name}");
        wanted[PRIMARIES] = 0;
        assert_eq!(descriptor(&ours), wanted, "{name}");
        assert_eq!(type_size(&ours), type_size(&theirs), "{name}");
    }
}
