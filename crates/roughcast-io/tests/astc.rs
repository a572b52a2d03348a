//! ASTC in KTX2, against Arm's astcenc.

use roughcast::{Image, Samples};
use roughcast_io::{ReadOptions, read_image_file};
use roughcast_testdata::find;

/// Decoders round the 16 bits of the specification to 8 in different ways.
const STEPS: u8 = 1;

fn read(name: &str) -> Image {
    let path = find(&format!("generated/astc/{name}"));
    read_image_file(&path, &ReadOptions::default()).expect("a valid file").image
}

fn bytes(image: &Image) -> &[u8] {
    match image.samples() {
        Samples::U8(bytes) => bytes,
        other => panic!("8 bits, not {:?}", other.sample_type()),
    }
}

#[test]
fn blocks_of_any_size_match_astcenc() {
    for block in ["4x4", "8x8", "12x12"] {
        let (ours, reference) = (read(&format!("{block}.ktx2")), read(&format!("{block}.png")));
        assert_eq!((ours.width(), ours.height(), ours.channels()), (33, 17, 4));
        let pairs = bytes(&ours).iter().zip(bytes(&reference));
        let largest = pairs.map(|(a, b)| a.abs_diff(*b)).max();
        assert!(largest <= Some(STEPS), "{block}: {largest:?}");
    }
}
