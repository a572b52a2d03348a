//! Broken and hostile files give an error, without a panic and without allocating what a header merely claims.

use std::time::{Duration, Instant};

use roughcast::SampleType;
use roughcast_io::{BlockFormat, Limits, Payload, ReadError, Supercompression, compress, dds, ktx2};

use crate::support::{
    Random, assert_same_texels, bytes_of, dds_bytes, ktx2_bytes, names_in, noise_array, read_image, shortened,
};

/// Readable files in the folder of broken files.
const READABLE: [(&str, &str); 2] = [
    // Magnum does not know this number; it is D3DFMT_R32F, and the file has all its texels.
    ("magnum_dds_fourcc-114.dds", "R32F"),
    // Its mip chain ends before 1 x 1, which the format allows. Level 0 is complete.
    ("magnum_ktx_2d-mipmaps-incomplete.ktx2", "R8G8B8_SRGB"),
];

/// Time limit for one file. Each has a few kilobytes; one second is a thousand times as long as reading takes.
const PATIENCE: Duration = Duration::from_secs(1);

#[test]
fn every_broken_file_is_an_error() {
    let is_ours = |name: &String| name.ends_with(".dds") || name.ends_with(".ktx2") || name.ends_with(".ktx");
    let names: Vec<String> = names_in("broken").into_iter().filter(is_ours).collect();
    assert!(names.len() > 20, "{names:?}");
    for name in &names {
        let start = Instant::now();
        match read_image(&format!("broken/{name}")) {
            Ok(decoded) => {
                let row = READABLE.iter().find(|row| row.0 == name);
                assert_eq!(row.map(|row| row.1), Some(decoded.info.format.as_str()), "{name} is readable");
            }
            Err(error) => {
                assert!(!READABLE.iter().any(|row| row.0 == name), "{name}: {error}");
                let line = error.to_string();
                assert!(!line.contains('\n') && line.len() < 200, "{name}: {line}");
                assert!(!matches!(error, ReadError::Io(_)), "{name}: {line}");
            }
        }
        assert!(start.elapsed() < PATIENCE, "{name} took {:?}", start.elapsed());
    }
}

fn put(bytes: &mut [u8], at: usize, value: u32) {
    bytes[at..at + 4].copy_from_slice(&value.to_le_bytes());
}

fn small_ktx2(supercompression: Supercompression) -> Vec<u8> {
    ktx2_bytes(Payload::Texels(&noise_array(SampleType::U8, 4, (4, 4), 1)), supercompression)
}

fn small_dds() -> Vec<u8> {
    dds_bytes(Payload::Texels(&noise_array(SampleType::U8, 4, (4, 4), 1)))
}

const KTX2_WIDTH: usize = 20;
const KTX2_HEIGHT: usize = 24;
const KTX2_LAYERS: usize = 32;
const KTX2_LEVELS: usize = 40;
const KTX2_LEVEL_0_LENGTH: usize = 88;
const KTX2_LEVEL_0_UNCOMPRESSED: usize = 96;
const DDS_HEIGHT: usize = 12;
const DDS_WIDTH: usize = 16;
const DDS_LEVELS: usize = 28;
const DDS_LAYERS: usize = 140;

/// The error message shows which check refused the file; all checks run before the allocation.
#[test]
fn a_small_file_cannot_claim_a_large_texture() {
    let unlimited = Limits::of_pixels(u64::MAX);
    for side in [65_536, 1 << 20, u32::MAX] {
        for supercompression in [Supercompression::None, Supercompression::Zstd] {
            let mut file = small_ktx2(supercompression);
            put(&mut file, KTX2_WIDTH, side);
            put(&mut file, KTX2_HEIGHT, side);
            let error = ktx2::read_image(&file, &Limits::default()).unwrap_err();
            assert!(matches!(error, ReadError::TooLarge { .. }), "{error}");
            // Without a limit, the check of the level's length refuses it, then that of the compression ratio.
            let error = ktx2::read_image(&file, &unlimited).unwrap_err().to_string();
            assert!(
                error.contains("level 0 states 64 bytes") || error.contains("fit into memory"),
                "{error}"
            );
            let claimed = u64::from(side).saturating_mul(u64::from(side)).saturating_mul(4);
            file[KTX2_LEVEL_0_UNCOMPRESSED..][..8].copy_from_slice(&claimed.to_le_bytes());
            let error = ktx2::read_image(&file, &unlimited).unwrap_err().to_string();
            let stopped = match supercompression {
                Supercompression::None => error.contains("level 0 has 64 bytes"),
                _ => error.contains("too short for its size"),
            };
            assert!(stopped || error.contains("fit into memory"), "{error}");
            assert!(ktx2::read_textures(&file, &unlimited).is_err());
        }
        let mut file = small_dds();
        put(&mut file, DDS_WIDTH, side);
        put(&mut file, DDS_HEIGHT, side);
        let error = dds::read_image(&file, &Limits::default()).unwrap_err();
        assert!(matches!(error, ReadError::TooLarge { .. }), "{error}");
        assert!(matches!(dds::read_image(&file, &unlimited), Err(ReadError::Malformed { .. })));
        assert!(matches!(dds::read_textures(&file, &unlimited), Err(ReadError::Malformed { .. })));
    }
}

#[test]
fn the_limit_counts_all_layers() {
    let array = noise_array(SampleType::U8, 1, (16, 16), 3);
    let (ktx2_file, dds_file) =
        (ktx2_bytes(Payload::Texels(&array), Supercompression::Zstd), dds_bytes(Payload::Texels(&array)));
    let (enough, too_few) = (Limits::of_pixels(768), Limits::of_pixels(767));
    assert!(
        ktx2::read_textures(&ktx2_file, &enough).is_ok() && dds::read_textures(&dds_file, &enough).is_ok()
    );
    for error in [
        ktx2::read_textures(&ktx2_file, &too_few).unwrap_err(),
        dds::read_textures(&dds_file, &too_few).unwrap_err(),
    ] {
        assert!(error.to_string().starts_with("16x48 pixels are more than the limit of 767"), "{error}");
    }
}

#[test]
fn numbers_that_contradict_each_other_are_malformed() {
    type Change = (usize, u32);
    let ktx2_changes: [&[Change]; 9] = [
        &[(KTX2_WIDTH, 0)],
        &[(KTX2_WIDTH, 5)],
        &[(KTX2_LAYERS, 7)],
        &[(KTX2_LEVELS, 4)],
        &[(KTX2_LEVELS, u32::MAX)],
        &[(KTX2_LEVEL_0_LENGTH, 63)],
        &[(KTX2_LEVEL_0_LENGTH + 4, 1)],
        &[(KTX2_LEVEL_0_UNCOMPRESSED, 65)],
        &[(60, u32::MAX)],
    ];
    for changes in ktx2_changes {
        let mut file = small_ktx2(Supercompression::None);
        changes.iter().for_each(|&(at, value)| put(&mut file, at, value));
        for error in [
            ktx2::read_image(&file, &Limits::default()).map(|_| ()).unwrap_err(),
            ktx2::read_textures(&file, &Limits::default()).map(|_| ()).unwrap_err(),
        ] {
            assert!(matches!(error, ReadError::Malformed { .. }), "{changes:?}: {error}");
        }
    }
    let dds_changes: [(Change, bool); 5] = [
        ((DDS_WIDTH, 0), false),
        ((DDS_HEIGHT, 6), false),
        // These files have level 0, which is all that an image needs.
        ((DDS_LEVELS, 4), true),
        ((DDS_LEVELS, u32::MAX), true),
        ((DDS_LAYERS, 2), true),
    ];
    for ((at, value), readable_as_image) in dds_changes {
        let mut file = small_dds();
        put(&mut file, at, value);
        assert_eq!(dds::read_image(&file, &Limits::default()).is_ok(), readable_as_image, "{at}: {value}");
        let error = dds::read_textures(&file, &Limits::default()).unwrap_err();
        assert!(matches!(error, ReadError::Malformed { .. }), "{at}: {value}: {error}");
    }
}

#[test]
fn foreign_files_are_not_baked_textures() {
    let ktx2_file = bytes_of("formats/ktx2/khr_s_normal_rgb8_mips_zstd.ktx2");
    let dds_file = bytes_of("formats/dds/dxtk_ground_norm.dds");
    for error in [
        ktx2::read_textures(&ktx2_file, &Limits::default()).unwrap_err(),
        dds::read_textures(&dds_file, &Limits::default()).unwrap_err(),
    ] {
        assert!(matches!(error, ReadError::Info(_)), "{error}");
        assert!(error.to_string().contains("was not written by roughcast"), "{error}");
    }
}

/// Every prefix of a file is refused, except prefixes of DDS files that have lost only levels.
#[test]
fn truncated_files_are_errors() {
    let array = noise_array(SampleType::U8, 2, (9, 7), 2);
    let blocks = compress(&array, BlockFormat::Bc5).unwrap();
    for payload in [Payload::Texels(&array), Payload::Blocks(&blocks)] {
        for supercompression in [Supercompression::None, Supercompression::Zstd] {
            let file = ktx2_bytes(payload, supercompression);
            for length in 0..file.len() {
                assert!(ktx2::read_textures(&file[..length], &Limits::default()).is_err(), "{length}");
                assert!(ktx2::read_image(&file[..length], &Limits::default()).is_err(), "{length}");
            }
        }
        let file = dds_bytes(payload);
        let whole = dds::read_image(&file, &Limits::default()).unwrap();
        for length in 0..file.len() {
            assert!(dds::read_textures(&file[..length], &Limits::default()).is_err(), "{length}");
            if let Ok(image) = dds::read_image(&file[..length], &Limits::default()) {
                assert_eq!(image, whole);
            }
        }
    }
}

/// Ten thousand files with a few changed bytes are each either read or refused.
#[test]
fn changed_bytes_never_panic() {
    let array = noise_array(SampleType::U8, 4, (13, 6), 2);
    let blocks = compress(&array, BlockFormat::Bc7).unwrap();
    let seeds = [
        ktx2_bytes(Payload::Texels(&array), Supercompression::Zstd),
        ktx2_bytes(Payload::Blocks(&blocks), Supercompression::None),
        dds_bytes(Payload::Texels(&array)),
    ];
    let limits = Limits::of_pixels(1 << 20);
    let mut random = Random::new(1);
    let mut read = 0;
    for round in 0..10_000 {
        let mut file = seeds[round % seeds.len()].clone();
        for _ in 0..1 + random.next() % 4 {
            // Half of the changes are in the header, where they matter.
            let reach = if random.next().is_multiple_of(2) { file.len().min(160) } else { file.len() };
            let at = random.next() as usize % reach;
            file[at] = random.next() as u8;
        }
        read +=
            usize::from(ktx2::read_image(&file, &limits).is_ok() || dds::read_image(&file, &limits).is_ok());
        let _ = ktx2::read_textures(&file, &limits);
        let _ = dds::read_textures(&file, &limits);
    }
    assert!(
        read > 1000 && read < 9999,
        "{read} of 10000 were readable: the changes are too small or too large"
    );
}

/// A level of several Zstandard frames is valid, since another writer may split it.
#[test]
fn several_zstd_frames_in_a_level_are_read() {
    let array = noise_array(SampleType::U16, 1, (8, 1), 1);
    let single = shortened(&array, 1);
    let file = ktx2_bytes(Payload::Texels(&single), Supercompression::Zstd);
    let raw = zstd::decode_all(&file[file.len() - u64_at(&file, 88) as usize..]).unwrap();
    let frames = [zstd::encode_all(&raw[..5], 1).unwrap(), zstd::encode_all(&raw[5..], 1).unwrap()].concat();
    let mut split = file[..u64_at(&file, 80) as usize].to_vec();
    split.extend(&frames);
    split[88..96].copy_from_slice(&(frames.len() as u64).to_le_bytes());
    assert_same_texels(&ktx2::read_textures(&split, &Limits::default()).unwrap(), &single, "two frames");
}

fn u64_at(bytes: &[u8], at: usize) -> u64 {
    u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap())
}
