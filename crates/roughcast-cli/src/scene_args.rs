//! Arguments for the scene and its shading, shared by the subcommands that render.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::{Context, Result};
use clap::Args;
use glam::DVec3;
use roughcast::shading::{BaseFrame, FootprintModel, Form, Masking, Material, Repair, ShadingOptions};
use roughcast::{Anisotropy, SampleType};
use roughcast_io::mesh::{FileNormals, load_mesh_with_normals};
use roughcast_pipeline::TextureOptions;
use roughcast_scene::render::{MAX_PIXELS, MAX_SAMPLES};
use roughcast_scene::{
    Camera, CameraError, Light, Mesh, Plane, Scene, Shape, Sphere, Torus, View, default_light,
};

use crate::args::{one_of, positive, specular_power};
use crate::{UsageError, usage};

/// Headings under which the help lists these options.
const SCENE: &str = "Scene";
pub const SHADING: &str = "Shading";

/// The surface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SceneChoice {
    Plane,
    Sphere,
    Torus,
    Mesh(PathBuf),
}

impl SceneChoice {
    fn parse(text: &str) -> Result<Self, std::convert::Infallible> {
        Ok(match text {
            "plane" => Self::Plane,
            "sphere" => Self::Sphere,
            "torus" => Self::Torus,
            path => Self::Mesh(path.into()),
        })
    }

    /// A short name for reports.
    pub fn name(&self) -> String {
        match self {
            Self::Plane => "plane".to_owned(),
            Self::Sphere => "sphere".to_owned(),
            Self::Torus => "torus".to_owned(),
            Self::Mesh(path) => {
                path.file_stem().map_or_else(|| "mesh".to_owned(), |name| name.to_string_lossy().into_owned())
            }
        }
    }

    /// The file of a mesh.
    pub fn mesh_path(&self) -> Option<&Path> {
        match self {
            Self::Mesh(path) => Some(path),
            _ => None,
        }
    }
}

/// A mesh from a file.
pub fn mesh_of(path: &Path, normals: FileNormals) -> Result<Mesh> {
    load_mesh_with_normals(path, normals).with_context(|| path.display().to_string())
}

/// Whether the surface is textured by its own coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextureCoordinates {
    Needed,
    Unneeded,
}

/// The camera position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CameraChoice {
    View(View),
    Eye(DVec3),
}

fn camera(text: &str) -> Result<CameraChoice, String> {
    if let Ok(view) = text.parse::<View>() {
        return Ok(CameraChoice::View(view));
    }
    point(text).map(CameraChoice::Eye).map_err(|_| {
        format!(
            "it must be one of {}, or the position of the eye as X,Y,Z",
            View::ALL.iter().map(|view| view.name()).collect::<Vec<_>>().join(", ")
        )
    })
}

fn numbers(text: &str) -> Option<Vec<f64>> {
    let parsed: Option<Vec<f64>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    parsed.filter(|numbers| numbers.iter().all(|number| number.is_finite()))
}

fn point(text: &str) -> Result<DVec3, String> {
    match numbers(text).as_deref() {
        Some([x, y, z]) => Ok(DVec3::new(*x, *y, *z)),
        _ => Err("it must be three numbers, X,Y,Z".to_owned()),
    }
}

fn light(text: &str) -> Result<Light, String> {
    let (is_point, rest) = match text.strip_prefix("point:") {
        Some(rest) => (true, rest),
        None => (false, text),
    };
    let (place, strength) = match numbers(rest).as_deref() {
        Some([x, y, z]) => (DVec3::new(*x, *y, *z), Light::WHITE),
        Some([x, y, z, r, g, b]) if r.min(*g).min(*b) >= 0.0 => {
            (DVec3::new(*x, *y, *z), [*r as f32, *g as f32, *b as f32])
        }
        _ => {
            return Err(
                "it must be X,Y,Z or X,Y,Z,R,G,B, with 'point:' before it for a point light".to_owned()
            );
        }
    };
    if is_point {
        return Ok(Light::Point { position: place, intensity: strength });
    }
    let towards = place.try_normalize().ok_or("the direction towards the light must not be zero")?;
    Ok(Light::Directional { towards, irradiance: strength })
}

/// The size of a picture in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    pub width: u32,
    pub height: u32,
}

pub fn size(text: &str) -> Result<Size, String> {
    let wanted = || "it must be WIDTHxHEIGHT, such as 640x480".to_owned();
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(wanted)?;
    let size =
        Size { width: width.parse().map_err(|_| wanted())?, height: height.parse().map_err(|_| wanted())? };
    match u64::from(size.width) * u64::from(size.height) {
        0 => Err(format!("a picture of {text} has no pixels: both numbers must be above zero")),
        pixels if pixels <= MAX_PIXELS => Ok(size),
        _ => Err(format!("a picture of {text} is too large: at most {MAX_PIXELS} pixels")),
    }
}

/// Parses the number of samples per pixel of a ground truth.
pub fn samples(text: &str) -> Result<u32, String> {
    match text.parse::<u32>() {
        Ok(samples) if (1..=MAX_SAMPLES).contains(&samples) && samples.isqrt().pow(2) == samples => {
            Ok(samples)
        }
        _ => Err(format!("it must be a square number, from 1 to {MAX_SAMPLES}, such as 64")),
    }
}

/// What the picture shows.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = SCENE)]
pub struct SceneArgs {
    /// The surface: plane, sphere, torus, or a mesh file (.obj, .gltf, .glb), with texture coordinates if a map needs them
    #[arg(long, value_name = "SCENE", default_value = "plane", value_parser = SceneChoice::parse)]
    pub scene: SceneChoice,

    /// A light: the direction towards it as X,Y,Z, or point:X,Y,Z; followed by its colour as ,R,G,B (irradiance; pi is
    /// white). May be given more than once [default: one whose highlight is in the picture]
    #[arg(long = "light", value_name = "LIGHT", value_parser = light, allow_hyphen_values = true)]
    pub lights: Vec<Light>,

    /// Normals of a mesh: those of the file (where it has none, glTF is flat and OBJ smooth), or computed ones: smooth, as
    /// if the surface were round; flat, a facet for each triangle
    #[arg(long, default_value = "file", value_parser = one_of::<FileNormals>())]
    pub normals: FileNormals,
}

impl SceneArgs {
    /// The shape; a mesh is loaded from its file, and must have texture coordinates if they are needed.
    pub fn shape(&self, coordinates: TextureCoordinates) -> Result<Shape> {
        if self.normals != FileNormals::File && self.scene.mesh_path().is_none() {
            let line = format!(
                "--normals is for meshes, and the normals of a {} are exact: leave it out",
                self.scene.name()
            );
            return Err(UsageError(line).into());
        }
        Ok(match &self.scene {
            SceneChoice::Plane => Shape::Plane(Plane::default()),
            SceneChoice::Sphere => Shape::Sphere(Sphere),
            SceneChoice::Torus => Shape::Torus(Torus::default()),
            SceneChoice::Mesh(path) => {
                let mesh = mesh_of(path, self.normals)?;
                if coordinates == TextureCoordinates::Needed && !mesh.has_texture_coordinates() {
                    return Err(usage(
                        path,
                        "the mesh has no texture coordinates, which a map needs: use `render` with --frame triplanar, or unwrap the \
                         mesh in a modelling program and export it with texture coordinates",
                    ));
                }
                Shape::Mesh(Arc::new(mesh))
            }
        })
    }

    /// The scene of a standard view of the shape, for a map of `texels` and a picture of `size`.
    pub fn view(
        &self,
        view: View,
        shape: Arc<Shape>,
        texels: (usize, usize),
        size: Size,
        material: Material,
    ) -> Scene {
        let mut scene = view.scene(shape, texels, (size.width, size.height), material);
        if !self.lights.is_empty() {
            scene.lights.clone_from(&self.lights);
        }
        scene
    }
}

/// How a single picture shows the scene.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = SCENE)]
pub struct CameraArgs {
    /// Camera position: near, mid, far or grazing, or the position of the eye as X,Y,Z (y is up)
    #[arg(long, value_name = "VIEW|X,Y,Z", default_value = "mid", value_parser = camera, allow_hyphen_values = true)]
    pub camera: CameraChoice,

    /// The point that the camera looks at, with --camera X,Y,Z [default: the middle of the scene]
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub look_at: Option<DVec3>,

    /// The direction that is up in the picture, with --camera X,Y,Z [default: 0,1,0; if the camera looks along it, 0,0,-1]
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub up: Option<DVec3>,

    /// Vertical angle of view in degrees, with --camera X,Y,Z
    #[arg(long, value_name = "DEGREES", default_value_t = 40.0, value_parser = angle)]
    pub fov: f64,

    /// How often the map repeats over the scene's texture coordinates [default: chosen for the scene]
    #[arg(long, value_name = "N", value_parser = positive)]
    pub repeat: Option<f32>,
}

impl CameraArgs {
    /// The scene for a map of this many texels and a picture of this size.
    pub fn scene(
        &self,
        scene: &SceneArgs,
        texels: (usize, usize),
        size: Size,
        material: Material,
        coordinates: TextureCoordinates,
    ) -> Result<Scene> {
        let shape = Arc::new(scene.shape(coordinates)?);
        let mut seen = match self.camera {
            CameraChoice::View(view) => {
                if self.look_at.is_some() || self.up.is_some() {
                    let line = "--look-at and --up go with a camera at X,Y,Z; a named view looks at the scene by itself";
                    return Err(UsageError(line.to_owned()).into());
                }
                scene.view(view, shape, texels, size, material)
            }
            CameraChoice::Eye(eye) => {
                let target = self.look_at.unwrap_or_else(|| shape.bounds().centre);
                let camera = self.camera_at(eye, target)?;
                let mut seen = scene.view(View::Mid, shape, texels, size, material);
                if scene.lights.is_empty() {
                    let light = default_light(&seen.shape, &camera, (size.width, size.height), View::Mid);
                    seen.lights = vec![light];
                }
                Scene { camera, ..seen }
            }
        };
        if let Some(repeats) = self.repeat {
            seen.repeats = f64::from(repeats);
        }
        Ok(seen)
    }

    /// A camera that looks straight down or up shows the far side of the scene, -z, at the top of its picture.
    fn camera_at(&self, eye: DVec3, target: DVec3) -> Result<Camera, UsageError> {
        let with = |up| Camera::new(eye, target, up, self.fov.to_radians());
        let camera = match (with(self.up.unwrap_or(DVec3::Y)), self.up) {
            (Err(CameraError::ParallelUp { .. }), None) => with(DVec3::NEG_Z),
            (camera, _) => camera,
        };
        camera.map_err(|error| {
            let option = if matches!(error, CameraError::ParallelUp { .. }) { "--up" } else { "--camera" };
            UsageError(format!("{option}: {error}"))
        })
    }
}

fn angle(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(angle) if angle > 0.0 && angle < 180.0 => Ok(angle),
        _ => Err("it must be an angle above 0 and below 180 degrees".to_owned()),
    }
}

/// A colour, linear: one number or R,G,B.
pub fn colour(text: &str) -> Result<[f32; 3], String> {
    match numbers(text).as_deref() {
        Some([all]) if *all >= 0.0 => Ok([*all as f32; 3]),
        Some([r, g, b]) if r.min(*g).min(*b) >= 0.0 => Ok([*r as f32, *g as f32, *b as f32]),
        _ => Err("it must be one number or R,G,B, none below zero".to_owned()),
    }
}

/// How surfaces are shaded, whatever the model.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = SHADING)]
pub struct ShadingArgs {
    /// Blinn-Phong exponent of the surface itself, before any bumps
    #[arg(long, value_name = "S", default_value_t = 256.0, value_parser = specular_power)]
    pub specular_power: f32,

    /// Reflectance: a microfacet BRDF with shadowing and masking, the normalised distribution alone, or the LEAN paper's form
    #[arg(long, default_value = "physical", value_parser = one_of::<Form>())]
    pub form: Form,

    /// Which slopes shadow and mask in the physical form: those of the base roughness, as in bump mapping, or those of
    /// base and bumps, as in displaced geometry
    #[arg(long, default_value = "base", value_parser = one_of::<Masking>())]
    pub masking: Masking,

    /// Which variance counts as roughness: that under the pixel, or all under the texture filter, as in the
    /// papers
    #[arg(long, default_value = "corrected", value_parser = one_of::<FootprintModel>())]
    pub footprint: FootprintModel,

    /// The base roughness in the plane of the surface: round, as in LEAN, or the lobe of the tilted facet as seen in
    /// that plane
    #[arg(long = "base-lobe", value_name = "BASE", default_value = "plane", value_parser = one_of::<BaseFrame>())]
    pub base_frame: BaseFrame,

    /// What to do with covariances that rounding made invalid: clamp them, or follow the papers' rules
    #[arg(long, default_value = "clamp", value_parser = one_of::<Repair>())]
    pub repair: Repair,

    /// For ggx: one roughness, or two with a direction
    #[arg(long = "lobe", default_value = "isotropic", value_parser = one_of::<Anisotropy>())]
    pub anisotropy: Anisotropy,

    /// Bits of the textures that the model samples
    #[arg(long, default_value = "16", value_parser = one_of::<SampleType>())]
    pub bits: SampleType,

    /// Ambient light, as one number or R,G,B
    #[arg(long, value_name = "COLOUR", default_value = "0.2", value_parser = colour)]
    pub ambient: [f32; 3],

    /// Reflectance at normal incidence, as one number or R,G,B; 0.04 is plastic
    #[arg(long, value_name = "COLOUR", default_value = "0.04", value_parser = colour)]
    pub specular: [f32; 3],
}

impl ShadingArgs {
    /// The library's options.
    pub fn shading_options(&self) -> ShadingOptions {
        ShadingOptions::default()
            .with_specular_power(self.specular_power)
            .with_form(self.form)
            .with_base_frame(self.base_frame)
            .with_repair(self.repair)
            .with_masking(self.masking)
            .with_footprint(self.footprint)
    }

    /// How the textures of a model are baked.
    pub fn texture_options(&self) -> TextureOptions {
        TextureOptions::default()
            .with_sample_type(self.bits)
            .with_anisotropy(self.anisotropy)
            .with_specular_power(self.specular_power)
    }

    /// The material with this diffuse colour, linear.
    pub fn material(&self, albedo: [f32; 3]) -> Material {
        Material::default().with_albedo(albedo).with_ambient(self.ambient).with_specular(self.specular)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_without_pixels_and_beyond_memory_are_refused() {
        assert_eq!(size("640x480"), Ok(Size { width: 640, height: 480 }));
        for wrong in ["0x0", "0x5", "640", "x", "-1x5", "99999999x99999999", "1e3x5"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn lights_are_directions_or_points() {
        let Ok(Light::Directional { towards, irradiance }) = light("0,2,0") else { panic!("a direction") };
        assert_eq!((towards, irradiance), (DVec3::Y, Light::WHITE));
        let Ok(Light::Point { position, intensity }) = light("point:1,2,-3,4,5,6") else { panic!("a point") };
        assert_eq!((position, intensity), (DVec3::new(1.0, 2.0, -3.0), [4.0, 5.0, 6.0]));
        for wrong in ["0,0,0", "1,2", "point:", "1,2,3,4", "1,2,3,-1,0,0", "nan,1,2", "inf,0,0"] {
            assert!(light(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn cameras_are_views_or_points() {
        assert!(matches!(camera("grazing"), Ok(CameraChoice::View(View::Grazing))));
        assert_eq!(camera("1,2,-3"), Ok(CameraChoice::Eye(DVec3::new(1.0, 2.0, -3.0))));
        assert!(camera("elsewhere").expect_err("no view").contains("near"));
    }
}
