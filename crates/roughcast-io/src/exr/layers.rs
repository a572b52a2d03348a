//! STAND-IN: which layers and channels each layout has. To be replaced by `roughcast::texture::layers_of`.

use roughcast::texture::{Layout, TextureInfo};

use crate::ReadError;

pub(super) struct LayerSpec {
    pub(super) name: &'static str,
    pub(super) channels: Vec<&'static str>,
}

pub(super) fn layers_of(info: &TextureInfo) -> Result<Vec<LayerSpec>, ReadError> {
    match info.layout {
        Layout::BumpSlopes => Ok(vec![LayerSpec {
            name: "bump-slopes",
            channels: vec!["b0_h", "b1_dhds", "b2_dhdt", "b3_dhds2", "b4_dhdt2", "b5_dh2dsdt"],
        }]),
        layout => Err(ReadError::Unsupported {
            format: "EXR",
            what: format!("the layout {layout}"),
            mend: "bake it as bump-slopes",
        }),
    }
}
