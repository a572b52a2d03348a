//! Tests of the metadata.

use super::*;

fn odd() -> TextureInfo {
    TextureInfo {
        scale: 1.234_567_9,
        spread_scale: 3.3e-5,
        base: Base::Baked,
        base_variance: 1.0 / 13777.0,
        brdf: Brdf::BlinnPhong,
        roughness_stored: RoughnessStored::SpecularPower,
        set: 0x0123_4567_89ab_cdef,
        wrap: Wrap::Mirror,
        normal_range: NormalRange::Unorm,
        ..TextureInfo::new(Layout::Toksvig, Part::Gloss)
    }
}

#[test]
fn layers_and_channels_read_back() {
    let second = TextureInfo { layer: Some(1), ..TextureInfo::new(Layout::Lean, Part::Whole) };
    let green = TextureInfo {
        roughness_texture: RoughnessTexture::Green,
        ..TextureInfo::new(Layout::Pbr, Part::Roughness)
    };
    for info in [second, green] {
        assert_eq!(TextureInfo::from_pairs(&info.to_pairs()), Ok(info));
        assert_eq!(TextureInfo::from_words(&info.to_words()), Ok(info));
    }
    assert_eq!(second.to_pairs()[LAYER], "lean2");
    let third = TextureInfo { layer: Some(2), ..second };
    assert!(TextureInfo::from_words(&third.to_words()).is_err());
}

#[test]
fn files_of_earlier_versions_keep_their_meaning() {
    let orm = TextureInfo::new(Layout::Pbr, Part::OcclusionRoughnessMetallic);
    let earlier =
        TextureInfo { normal_range: NormalRange::Signed, roughness_texture: RoughnessTexture::Packed, ..orm };
    let mut pairs = earlier.to_pairs();
    for key in [WRAP, NORMAL_RANGE, ROUGHNESS_LAYOUT] {
        pairs.remove(key);
    }
    assert_eq!(TextureInfo::from_pairs(&pairs), Ok(earlier));
    let mut words = earlier.to_words();
    (words[1], words[9]) = (1, 0);
    assert_eq!(TextureInfo::from_words(&words), Ok(earlier));
}

#[test]
fn pairs_and_words_read_back_bit_for_bit() {
    assert_eq!(TextureInfo::from_pairs(&odd().to_pairs()), Ok(odd()));
    assert_eq!(TextureInfo::from_words(&odd().to_words()), Ok(odd()));
}

#[test]
fn a_broken_scale_is_refused() {
    for scale in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        let info = TextureInfo { scale, ..odd() };
        assert!(TextureInfo::from_pairs(&info.to_pairs()).is_err(), "{scale}");
        assert!(TextureInfo::from_words(&info.to_words()).is_err(), "{scale}");
    }
}

#[test]
fn a_part_of_another_layout_is_refused() {
    let info = TextureInfo::new(Layout::Lean, Part::Gloss);
    assert!(matches!(TextureInfo::from_pairs(&info.to_pairs()), Err(InfoError::Invalid { key: PART, .. })));
    assert!(matches!(TextureInfo::from_words(&info.to_words()), Err(InfoError::Invalid { key: PART, .. })));
}

#[test]
fn foreign_metadata_is_named_as_such() {
    assert!(matches!(TextureInfo::from_pairs(&BTreeMap::new()), Err(InfoError::Missing(LAYOUT))));
    assert!(matches!(TextureInfo::from_words(&[0; 11]), Err(InfoError::Missing(LAYOUT))));
}

#[test]
fn words_and_pairs_agree_without_a_roughness_layout() {
    let odd = TextureInfo {
        roughness_texture: RoughnessTexture::Green,
        ..TextureInfo::new(Layout::Variance, Part::Split)
    };
    let read = TextureInfo::from_words(&odd.to_words()).expect("the rest makes sense");
    assert_eq!(read.roughness_texture, RoughnessTexture::Alone);
    assert_eq!(TextureInfo::from_pairs(&read.to_pairs()), Ok(read));
}
