//! `roughcast render`: a map on a shape, shaded by any of the models, on the CPU or on the GPU.

mod backends;

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result};
use clap::ValueHint;
use roughcast::shading::Shading;
use roughcast::texture::TextureArray;
use roughcast_io::picture::{Plane, write_exr, write_png};
use roughcast_io::texture_files::is_same_file;
use roughcast_io::{AtomicFile, AtomicSet};
use roughcast_pipeline::Map;
use roughcast_scene::render::MAX_SAMPLES;
use roughcast_scene::{AlbedoMap, Filter, Picture, Scene, Shape, View, repeats_per_length};

use crate::added::{AddedContent, AddedMap, Place};
use crate::albedo::{Albedo, AlbedoChoice};
use crate::args::{SourceArgs, one_of, positive};
use crate::backend::Backend;
use crate::bumps::{BumpArgs, FrameChoice};
use crate::display::{exposure_of, toned};
use crate::input::read_map;
use crate::scene_args::{
    CameraArgs, CameraChoice, SHADING, SceneArgs, ShadingArgs, Size, TextureCoordinates, size,
};
use crate::tone::Tone;
use crate::{UsageError, findings, progress, say, scene_args, textures, usage};

/// Render a map on a shape with LEAN, with conventional methods, or as ground truth.
///
/// Writes a PNG for display, or an EXR of linear radiance with separate highlights (specular.R ...) and
/// the coverage of each pixel (A). With --frames the camera moves slowly, and the output is a folder.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  LEAN mapping, filtered as graphics hardware does it:
    roughcast render bricks_normal.png -o bricks.png
  The conventional method, which shimmers, and the ground truth with 256 rays per pixel:
    roughcast render bricks_normal.png -o before.png --shading blinn-phong
    roughcast render bricks_normal.png -o truth.png --filter truth:256
  On a model, by the graphics card:
    roughcast render bricks_normal.png -o pot.png --scene teapot.obj --gpu
  A model without texture coordinates: a map projected along the three axes, or procedural noise:
    roughcast render bricks_normal.png -o bunny.png --scene bunny.obj --frame triplanar
    roughcast render -o lava.png --scene bunny.obj --bump noise:turbulence:6")]
pub struct Args {
    /// A normal or height map, or a file that `bake` wrote; none for noise alone
    #[arg(value_hint = ValueHint::FilePath)]
    map: Option<PathBuf>,

    /// The picture to write, .png or .exr; with --frames the folder
    #[arg(short, long, value_name = "PATH", value_hint = ValueHint::AnyPath)]
    output: PathBuf,

    /// The shading model [default: lean; for a file that `bake` wrote, the one that samples its layout]
    #[arg(long, value_name = "MODEL", value_parser = one_of::<Shading>(), help_heading = SHADING)]
    shading: Option<Shading>,

    /// Texture filter: nearest, trilinear, anisotropic (16 taps), ewa or summed-area; or truth:N, the ground truth:
    /// N rays per pixel at the finest level, shaded with the lobe of the model itself
    #[arg(long, value_name = "FILTER", default_value = "anisotropic", value_parser = filter, help_heading = SHADING)]
    filter: FilterChoice,

    /// Always sample this level of the textures; 0 is the finest
    #[arg(long, value_name = "L", value_parser = level, help_heading = SHADING)]
    level: Option<f64>,

    /// Sample this many levels coarser than the distance requires
    #[arg(long, value_name = "B", default_value_t = 0.0, value_parser = bias, allow_negative_numbers = true, help_heading = SHADING)]
    mip_bias: f64,

    #[command(flatten)]
    bumps: BumpArgs,

    #[command(flatten)]
    shading_options: ShadingArgs,

    /// Diffuse colour, linear, as one number or R,G,B; or a picture of it, which lies on the scene as the map does (8-
    /// and 16-bit files are sRGB, floats linear)
    #[arg(long, value_name = "COLOUR|FILE", default_value = "0.1", value_parser = AlbedoChoice::parse, help_heading = SHADING)]
    albedo: AlbedoChoice,

    #[command(flatten)]
    scene: SceneArgs,

    #[command(flatten)]
    camera: CameraArgs,

    /// Width and height of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "640x480", value_parser = size)]
    size: Size,

    /// Radiance that PNG shows as white [default: all but the brightest hundredth of the picture is below it]
    #[arg(long, value_name = "RADIANCE", value_parser = positive)]
    white: Option<f32>,

    /// How PNG shows bright radiance: linear clamps it to white; neutral leaves up to 80 % of white unchanged, and lets
    /// what is brighter approach white
    #[arg(long, default_value = "linear", value_parser = one_of::<Tone>())]
    tone: Tone,

    /// Render this many frames of a slow camera move into the output folder
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=MOST_FRAMES))]
    frames: Option<u32>,

    /// Format of the frames
    #[arg(long, value_parser = one_of::<PictureFormat>(), default_value = "png", requires = "frames")]
    frame_format: PictureFormat,

    /// Render on the graphics card
    #[arg(long)]
    gpu: bool,

    /// Render on the processor [default]
    #[arg(long, conflicts_with = "gpu")]
    cpu: bool,

    #[command(flatten)]
    source: SourceArgs,
}

/// Frames are numbered with four digits.
const MOST_FRAMES: i64 = 10_000;

/// The samples that a pixel averages.
#[derive(Clone, Copy, Debug, PartialEq)]
enum FilterChoice {
    /// One sample of filtered textures.
    Textures(Filter),
    /// This many samples of the finest level.
    Truth(u32),
}

fn filter(text: &str) -> Result<FilterChoice, String> {
    if let Some(samples) = text.strip_prefix("truth:") {
        return scene_args::samples(samples).map(FilterChoice::Truth).map_err(|_| {
            format!("the samples of a pixel must be a square number, from 1 to {MAX_SAMPLES}: truth:64")
        });
    }
    text.parse()
        .map(FilterChoice::Textures)
        .map_err(|error: roughcast::UnknownName| format!("{error}, truth:N"))
}

fn level(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(level) if level.is_finite() && level >= 0.0 => Ok(level),
        _ => Err("it must be a number, 0 or above".to_owned()),
    }
}

fn bias(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(bias) if bias.is_finite() => Ok(bias),
        _ => Err("it must be a number".to_owned()),
    }
}

/// Formats of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PictureFormat {
    Png,
    Exr,
}

impl roughcast::Named for PictureFormat {
    fn all() -> &'static [Self] {
        &[Self::Png, Self::Exr]
    }

    fn name(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Exr => "exr",
        }
    }
}

impl PictureFormat {
    fn of(path: &Path) -> Result<Self> {
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
        match extension.as_str() {
            "png" => Ok(Self::Png),
            "exr" => Ok(Self::Exr),
            _ => Err(usage(
                path,
                "pictures are written as .png or .exr: end the name of the output in one of them",
            )),
        }
    }
}

/// Renders the picture, or the frames.
pub fn run(args: &Args) -> Result<ExitCode> {
    args.check()?;
    let albedo = args.albedo.load(&args.source.limits())?;
    let subject = args.subject()?;
    let added = args.added()?;
    let scene = args.scene_of(&subject, &added, albedo)?;
    let mut backend = args.backend(&subject, &added, &scene)?;
    match args.frames {
        None => {
            let format = PictureFormat::of(&args.output)?;
            let bar = progress::bar(1);
            let picture = backend.render(&scene, &bar)?;
            bar.finish_and_clear();
            let mut set = AtomicSet::new();
            let exposure = args.exposure_of(&picture);
            add(&mut set, &args.output, format, &picture, (exposure, args.tone))?;
            set.commit()?;
            if format == PictureFormat::Png {
                // So that another picture can use the same exposure.
                say(&format!("{}: white is a radiance of {}", args.output.display(), 1.0 / exposure))?;
            }
        }
        Some(frames) => render_frames(args, &scene, &mut backend, frames)?,
    }
    Ok(ExitCode::SUCCESS)
}

impl Args {
    /// Rejects invalid arguments before anything is read.
    fn check(&self) -> Result<()> {
        if self.frames.is_none() {
            PictureFormat::of(&self.output)?;
            if self.map.as_ref().is_some_and(|map| is_same_file(&self.output, map)) {
                return Err(usage(
                    &self.output,
                    "it is the map, which would be lost: give the output another name",
                ));
            }
            if self.albedo.file().is_some_and(|albedo| is_same_file(&self.output, albedo)) {
                let line = "it is the picture of --albedo, which would be lost: give the output another name";
                return Err(usage(&self.output, line));
            }
            let output = || self.output.display().to_string();
            AtomicFile::create(&self.output).map(drop).with_context(output)?;
        }
        if let Some(added) = self.bumps.added.iter().find(|added| is_same_file(&self.output, &added.path)) {
            let line = "it is a map of --add, which would be lost: give the output another name";
            return Err(usage(&added.path, line));
        }
        if self.gpu && cfg!(not(feature = "gpu")) {
            let line = "this build has no code for graphics cards: build it with `--features gpu`, or leave --gpu out";
            return Err(UsageError(line.to_owned()).into());
        }
        if self.gpu
            && !matches!(
                self.filter,
                FilterChoice::Textures(Filter::Nearest | Filter::Trilinear | Filter::Anisotropic)
            )
        {
            let line = "--gpu filters as the hardware does: nearest, trilinear or anisotropic; leave --gpu out for the others";
            return Err(UsageError(line.to_owned()).into());
        }
        self.bumps.check(self.map.is_some())?;
        Ok(())
    }

    /// The scene, with its diffuse colour. Projected maps repeat per unit of length, others over the scene's texture
    /// coordinates.
    fn scene_of(&self, subject: &Subject, added: &[Added<'_>], albedo: Albedo) -> Result<Scene> {
        let (colour, map) = match albedo {
            Albedo::Colour(colour) => (colour, None),
            Albedo::Map(map) => ([1.0; 3], Some(map)),
        };
        let material = self.shading_options.material(colour);
        let projected = self.repeats_per_length();
        let sets = self.bumps.uv_sets(self.map.is_some());
        let coordinates = match map {
            None if sets.is_empty() => TextureCoordinates::Unneeded,
            _ => TextureCoordinates::Needed,
        };
        let highest = sets.into_iter().max().unwrap_or(0);
        let texels = texels_of(subject, added, map.as_deref());
        let mut scene = self.camera.scene(&self.scene, texels, self.size, material, coordinates)?;
        if let (Shape::Mesh(mesh), Some(path)) = (&*scene.shape, self.scene.scene.mesh_path()) {
            let sets = mesh.uv_set_count();
            if coordinates == TextureCoordinates::Needed && highest >= sets {
                let line = format!(
                    "the mesh has no set {highest} of texture coordinates, and its last one is {}: use a lower --uv-set, or \
                     uv-set of --add",
                    sets.saturating_sub(1)
                );
                return Err(usage(path, &line));
            }
        } else if highest > 0 {
            let line = "only meshes have several sets of texture coordinates: leave out --uv-set, and uv-set of --add";
            return Err(UsageError(line.to_owned()).into());
        }
        if map.is_some() && (projected || self.bumps.uv_set > 0) {
            let line = "a picture as --albedo lies on the first set of texture coordinates, with the repeats of the bumps: leave out \
                        --frame triplanar and --uv-set, or give a colour";
            return Err(UsageError(line.to_owned()).into());
        }
        scene.albedo = map;
        if projected && self.camera.repeat.is_none() {
            let view = match self.camera.camera {
                CameraChoice::View(view) => view,
                CameraChoice::Eye(_) => View::Mid,
            };
            let size = (self.size.width, self.size.height);
            let per_pixel = view.texels_per_pixel();
            scene.repeats = repeats_per_length(&scene.shape, &scene.camera, texels.0, size, per_pixel);
        }
        Ok(scene)
    }

    /// The exposure of a picture. All frames use the first one's, since they would flicker otherwise.
    fn exposure_of(&self, first: &Picture) -> f32 {
        self.white.map_or_else(|| exposure_of(first), |white| 1.0 / white)
    }

    /// Whether maps repeat per unit of length: if the first one is projected along three axes.
    fn repeats_per_length(&self) -> bool {
        match (&self.map, self.bumps.added.iter().find(|added| !added.is_decal())) {
            (None, Some(first)) => first.place == Place::Frame(FrameChoice::Triplanar, 0),
            _ => self.bumps.frame == FrameChoice::Triplanar,
        }
    }

    /// The maps of `--add`.
    fn added(&self) -> Result<Vec<Added<'_>>> {
        let load = |map| Ok((map, AddedMap::load(map, &self.source.limits())?));
        self.bumps.added.iter().map(load).collect()
    }

    /// What lies on the shape.
    fn subject(&self) -> Result<Subject> {
        let Some(path) = &self.map else { return Ok(Subject::Nothing) };
        let limits = self.source.limits();
        if textures::is_baked(path, &limits) {
            return Ok(Subject::Baked(textures::read_with_parts(path, &limits)?));
        }
        let map = read_map(path, &self.source)?;
        findings::warn_of(path, &map);
        Ok(Subject::Map(Box::new(map)))
    }

    /// The path of the map, for errors about it.
    fn map_path(&self) -> &Path {
        self.map.as_deref().unwrap_or(Path::new(""))
    }

    /// The model: the named one, or else LEAN's for a map, and for a baked file the one that samples its layout.
    fn model(&self, subject: &Subject) -> Result<Shading> {
        let Subject::Baked(arrays) = subject else { return Ok(self.shading.unwrap_or(Shading::Lean)) };
        let layout = arrays[0].info.layout;
        match self.shading {
            Some(shading) if shading.layout() == layout => Ok(shading),
            Some(shading) => Err(usage(
                self.map_path(),
                &format!(
                    "it contains the layout '{layout}', and the model '{shading}' samples '{}': leave --shading out, or bake \
                     with --as {0}",
                    shading.layout()
                ),
            )),
            // If there are several, the last is the one named after the layout.
            None => Shading::ALL.iter().rev().copied().find(|shading| shading.layout() == layout).ok_or_else(
                || {
                    usage(
                        self.map_path(),
                        &format!("no shading model samples the layout '{layout}': give the map instead"),
                    )
                },
            ),
        }
    }
}

/// What lies on the shape.
enum Subject {
    /// No map: noise alone.
    Nothing,
    Map(Box<Map>),
    /// All textures of one bake.
    Baked(Vec<TextureArray>),
}

impl Subject {
    /// Width and height of level 0, if there is a map.
    fn texels(&self) -> Option<(usize, usize)> {
        match self {
            Subject::Nothing => None,
            Subject::Map(map) => Some((map.image.width(), map.image.height())),
            Subject::Baked(arrays) => Some(arrays[0].size()),
        }
    }
}

/// A map of `--add` with what its file contains.
type Added<'a> = (&'a AddedMap, AddedContent);

/// Width and height in texels of the picture that decides how often all of them repeat: the map, or else the first one of
/// `--add` that is no decal, or else the diffuse colours.
fn texels_of(subject: &Subject, added: &[Added<'_>], albedo: Option<&AlbedoMap>) -> (usize, usize) {
    let of_added = || added.iter().find(|(map, _)| !map.is_decal()).map(|(_, content)| content.size());
    let of_albedo = || albedo.map(|map| (map.levels()[0].width(), map.levels()[0].height()));
    subject.texels().or_else(of_added).or_else(of_albedo).unwrap_or((1, 1))
}

/// Writes all frames, or none.
fn render_frames(args: &Args, scene: &Scene, backend: &mut Backend, frames: u32) -> Result<()> {
    let folder = || args.output.display().to_string();
    fs::create_dir_all(&args.output).with_context(folder)?;
    let bar = progress::bar(1);
    let mut set = AtomicSet::new();
    let mut exposure = None;
    for (frame, scene) in roughcast_scene::slow_move(scene, frames).into_iter().enumerate() {
        bar.set_message(format!("frame {} of {frames}", frame + 1));
        let picture = backend.render(&scene, &bar)?;
        let exposure = *exposure.get_or_insert_with(|| args.exposure_of(&picture));
        let path = args.output.join(format!("{frame:04}.{}", roughcast::Named::name(args.frame_format)));
        add(&mut set, &path, args.frame_format, &picture, (exposure, args.tone))?;
    }
    bar.finish_and_clear();
    set.commit().with_context(folder)
}

/// Writes a picture to a file of the set.
fn add(
    set: &mut AtomicSet,
    path: &Path,
    format: PictureFormat,
    picture: &Picture,
    (exposure, tone): (f32, Tone),
) -> Result<()> {
    let named = || path.display().to_string();
    let mut file = AtomicFile::create(path).with_context(named)?;
    match format {
        PictureFormat::Png => write_png(&toned(picture, exposure, tone), &mut file),
        PictureFormat::Exr => write_exr((picture.width(), picture.height()), planes(picture), &mut file),
    }
    .with_context(named)?;
    file.flush().with_context(named)?;
    set.push(file).with_context(named)
}

/// The channels of a picture in EXR. Radiance is premultiplied by coverage, as usual in EXR, and the background is black.
fn planes(picture: &Picture) -> Vec<Plane> {
    let channel = |pixels: &[[f32; 3]], i: usize| pixels.iter().map(|pixel| pixel[i]).collect();
    let mut planes = vec![Plane { name: "A", values: picture.coverage().to_vec() }];
    for (i, name) in ["R", "G", "B"].into_iter().enumerate() {
        planes.push(Plane { name, values: channel(picture.radiance(), i) });
    }
    for (i, name) in ["specular.R", "specular.G", "specular.B"].into_iter().enumerate() {
        planes.push(Plane { name, values: channel(picture.specular(), i) });
    }
    planes
}
