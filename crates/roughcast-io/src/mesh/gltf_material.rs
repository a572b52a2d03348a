//! Materials of a glTF file (glTF 2.0, sections 3.8.3 and 3.9), from its validated JSON.

use gltf::json::validation::Checked;
use gltf::json::{Index, Root, material, texture};
use roughcast::Wrap;

use super::uri::relative_path;
use super::{AlphaMode, MeshImage, MeshMaterial, MeshTexture};

/// All materials, in file order. Incompletely described textures are left out.
pub(super) fn materials(root: &Root) -> Vec<MeshMaterial> {
    root.materials.iter().map(|material| of(root, material)).collect()
}

fn of(root: &Root, material: &material::Material) -> MeshMaterial {
    let pbr = &material.pbr_metallic_roughness;
    let plain = |info: &Option<texture::Info>| {
        info.as_ref().and_then(|info| mesh_texture(root, info.index, info.tex_coord))
    };
    let (normal, occlusion) = (material.normal_texture.as_ref(), material.occlusion_texture.as_ref());
    MeshMaterial {
        name: material.name.clone(),
        base_color: pbr.base_color_factor.0,
        base_color_texture: plain(&pbr.base_color_texture),
        metallic: pbr.metallic_factor.0,
        roughness: pbr.roughness_factor.0,
        metallic_roughness_texture: plain(&pbr.metallic_roughness_texture),
        normal_texture: normal.and_then(|info| mesh_texture(root, info.index, info.tex_coord)),
        normal_scale: normal.map_or(1.0, |info| info.scale),
        occlusion_texture: occlusion.and_then(|info| mesh_texture(root, info.index, info.tex_coord)),
        occlusion_strength: occlusion.map_or(1.0, |info| info.strength.0),
        emissive: material.emissive_factor.0,
        emissive_texture: plain(&material.emissive_texture),
        alpha_mode: match material.alpha_mode {
            Checked::Valid(material::AlphaMode::Mask) => AlphaMode::Mask,
            Checked::Valid(material::AlphaMode::Blend) => AlphaMode::Blend,
            Checked::Valid(material::AlphaMode::Opaque) | Checked::Invalid => AlphaMode::Opaque,
        },
        alpha_cutoff: material.alpha_cutoff.unwrap_or_default().0,
        double_sided: material.double_sided,
    }
}

fn mesh_texture(root: &Root, index: Index<texture::Texture>, set: u32) -> Option<MeshTexture> {
    let texture = root.textures.get(index.value())?;
    let sampler = texture.sampler.and_then(|index| root.samplers.get(index.value()));
    let wrap = |mode: Option<Checked<texture::WrappingMode>>| match mode {
        Some(Checked::Valid(texture::WrappingMode::ClampToEdge)) => Wrap::Clamp,
        Some(Checked::Valid(texture::WrappingMode::MirroredRepeat)) => Wrap::Mirror,
        Some(Checked::Valid(texture::WrappingMode::Repeat) | Checked::Invalid) | None => Wrap::Repeat,
    };
    let wrap = [wrap(sampler.map(|s| s.wrap_s)), wrap(sampler.map(|s| s.wrap_t))];
    Some(MeshTexture { image: image(root, texture.source.value())?, uv_set: set as usize, wrap })
}

fn image(root: &Root, index: usize) -> Option<MeshImage> {
    let image = root.images.get(index)?;
    match &image.uri {
        Some(uri) if uri.starts_with("data:") => Some(MeshImage::Embedded(index)),
        Some(uri) => Some(match relative_path(uri) {
            Some(path) => MeshImage::File(path),
            None => MeshImage::Elsewhere(uri.clone()),
        }),
        None => image.buffer_view.is_some().then_some(MeshImage::Embedded(index)),
    }
}
