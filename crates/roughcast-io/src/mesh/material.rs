//! The materials of a mesh file.

use std::path::PathBuf;

use roughcast::Wrap;

/// A material, with glTF's meanings and defaults (glTF 2.0, section 3.9). For an OBJ file only its name is known.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct MeshMaterial {
    /// Its name in the file.
    pub name: Option<String>,
    /// Linear RGB and alpha; multiplies the texture.
    pub base_color: [f32; 4],
    /// sRGB colour and linear alpha.
    pub base_color_texture: Option<MeshTexture>,
    /// 0 ..= 1; multiplies the texture's blue channel.
    pub metallic: f32,
    /// Perceptual roughness, the square root of alpha, 0 ..= 1; multiplies the texture's green channel.
    pub roughness: f32,
    /// Roughness in green, metalness in blue.
    pub metallic_roughness_texture: Option<MeshTexture>,
    /// A tangent-space normal map with green up.
    pub normal_texture: Option<MeshTexture>,
    /// The factor of the normal map's x and y.
    pub normal_scale: f32,
    /// Occlusion in red.
    pub occlusion_texture: Option<MeshTexture>,
    /// Strength of the occlusion: 0 for none, 1 for the full occlusion of the texture.
    pub occlusion_strength: f32,
    /// Linear RGB; multiplies the texture.
    pub emissive: [f32; 3],
    /// sRGB colour.
    pub emissive_texture: Option<MeshTexture>,
    /// What alpha means.
    pub alpha_mode: AlphaMode,
    /// The minimum alpha at which [`AlphaMode::Mask`] shows the surface.
    pub alpha_cutoff: f32,
    /// Whether the back is shown too.
    pub double_sided: bool,
}

/// What a material's alpha means.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum AlphaMode {
    /// Alpha is ignored.
    #[default]
    Opaque,
    /// The surface is either opaque or invisible.
    Mask,
    /// Alpha is the coverage of the background by the surface.
    Blend,
}

/// A texture of a material.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct MeshTexture {
    /// Where its pixels are.
    pub image: MeshImage,
    /// The set of texture coordinates that maps it onto the mesh (glTF's `texCoord`).
    pub uv_set: usize,
    /// The wrap modes along u and v.
    pub wrap: [Wrap; 2],
}

/// Where the pixels of a texture are. Images are not read with the mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum MeshImage {
    /// In a file, by its path relative to the folder of the mesh file, within that folder.
    File(PathBuf),
    /// In the mesh file itself or in one of its buffers: the index among the file's images.
    Embedded(usize),
    /// Outside the folder of the mesh file: the URI as written in the file.
    Elsewhere(String),
}

impl Default for MeshMaterial {
    /// glTF's default material.
    fn default() -> Self {
        Self {
            name: None,
            base_color: [1.0; 4],
            base_color_texture: None,
            metallic: 1.0,
            roughness: 1.0,
            metallic_roughness_texture: None,
            normal_texture: None,
            normal_scale: 1.0,
            occlusion_texture: None,
            occlusion_strength: 1.0,
            emissive: [0.0; 3],
            emissive_texture: None,
            alpha_mode: AlphaMode::Opaque,
            alpha_cutoff: 0.5,
            double_sided: false,
        }
    }
}
