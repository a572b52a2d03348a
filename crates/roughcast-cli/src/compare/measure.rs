//! One map in one view: the ground truths, every method with every filter, and the error of each against its ground truth.

use std::ops::ControlFlow;
use std::sync::Arc;

use anyhow::Result;
use indicatif::ProgressBar;
use roughcast::shading::Shading;
use roughcast_io::picture::Srgb8Picture;
use roughcast_pipeline::bake_for;
use roughcast_scene::metrics::{DEFAULT_PIXELS_PER_DEGREE, energy_error, flicker, hdr_flip, rmse};
use roughcast_scene::render::{Method, Truth};
use roughcast_scene::{
    BakedTextures, Filter, Light, Picture, Reconstruction, Sampler, Scene, Shape, SlopeDetail, SlopeMap,
    View, slow_move,
};

use super::colour_scale::error_picture;
use super::results::Row;
use super::subject::Subject;
use super::without_repeats;
use crate::display::{exposure_of, shown};
use crate::scene_args::{SceneArgs, ShadingArgs, Size};

/// How all maps and views are compared.
pub struct Settings<'a> {
    pub scene: &'a SceneArgs,
    pub shape: Arc<Shape>,
    pub shading: &'a ShadingArgs,
    /// Diffuse colour, in linear RGB.
    pub albedo: [f32; 3],
    pub filters: Vec<Filter>,
    pub size: Size,
    /// Samples per pixel of the ground truths.
    pub samples: u32,
    /// The surface between texels in the ground truths.
    pub reconstruction: Reconstruction,
    /// Frames for measuring flicker; 0 leaves it out.
    pub frames: u32,
}

/// The results of one map in one view.
pub struct Comparison {
    pub view: View,
    pub lights: Vec<Light>,
    /// The ground truth of each reference, in the order of the models.
    pub truths: Vec<(Shading, Srgb8Picture)>,
    /// By model, then by filter.
    pub trials: Vec<Trial>,
    /// Ground truth, conventional bump mapping and LEAN side by side, while the camera moves; empty without flicker.
    pub animation: Vec<Srgb8Picture>,
}

/// One method with one filter.
pub struct Trial {
    pub row: Row,
    /// The root mean square error as a fraction of the ground truth's brightest value.
    pub error_of_peak: f64,
    pub picture: Srgb8Picture,
    /// The errors of FLIP.
    pub error: Srgb8Picture,
}

/// The ground truths of a view, frame by frame.
struct Truths {
    references: Vec<Shading>,
    /// The frames of every lobe.
    frames: Vec<Vec<Picture>>,
}

/// Work is counted in samples of a ground truth with all references, 0.24 µs of a core each; a pixel of a method takes
/// as long as this many, including its filtering ...
const METHOD_PIXEL: u64 = 3;
/// ... and a pixel of FLIP, over all exposures, as long as this many.
const FLIP_PIXEL: u64 = 18;

impl Settings<'_> {
    /// The work of one view, in the bar's steps.
    pub fn work(&self) -> u64 {
        let trials = (Shading::ALL.len() * self.filters.len()) as u64;
        let frame = u64::from(self.samples) + METHOD_PIXEL * trials;
        u64::from(self.size.height) * (frame * u64::from(self.frame_count()) + FLIP_PIXEL * trials)
    }

    /// Without camera movement, the only frame is the picture itself.
    fn frame_count(&self) -> u32 {
        self.frames.max(1)
    }

    /// The filter of the pictures that represent a method: the best of the selected ones.
    pub fn main_filter(&self) -> Filter {
        let anisotropic = self.filters.iter().find(|filter| **filter == Filter::Anisotropic);
        *anisotropic.or(self.filters.last()).expect("the command line gives at least one")
    }

    /// Compares all methods on a map in a view.
    pub fn compare(&self, subject: &Subject, view: View, bar: &ProgressBar) -> Result<Comparison> {
        let texels = (subject.image.width(), subject.image.height());
        let material = self.shading.material(self.albedo);
        let scene = self.scene.view(view, Arc::clone(&self.shape), texels, self.size, material);
        let lights = scene.lights.clone();
        let moves = slow_move(&scene, self.frame_count());
        let truths = self.truths(subject, &moves, bar)?;
        let exposure = exposure_of(&truths.of(Shading::Lean)[0]);

        let mut trials = Vec::new();
        let mut moving = vec![truths.of(Shading::Lean).iter().map(|frame| shown(frame, exposure)).collect()];
        // Models that share a layout share its textures; only one layout is kept in memory at a time.
        for models in Shading::ALL.chunk_by(|a, b| a.layout() == b.layout()) {
            let arrays =
                bake_for(models[0], &subject.image, &subject.options, self.shading.texture_options())?;
            for shading in models {
                let textures = BakedTextures::of_model(*shading, &arrays)?;
                for filter in &self.filters {
                    let sampler = Sampler::default().with_filter(*filter).with_wrap(subject.options.wrap);
                    let method = Method {
                        shading: *shading,
                        detail: &textures.sampled(sampler),
                        options: self.shading.shading_options(),
                    };
                    let frames = self.frames_of(&method, &moves, bar)?;
                    let row = self.row(subject, view, *shading, *filter);
                    trials.push(self.judge(row, &frames, truths.of(*shading), exposure, bar)?);
                    let is_shown = matches!(shading, Shading::BlinnPhong | Shading::Lean);
                    if is_shown && *filter == self.main_filter() {
                        moving.push(frames.iter().map(|frame| shown(frame, exposure)).collect());
                    }
                }
            }
        }
        let animation = if self.frames > 0 { side_by_side(&moving) } else { Vec::new() };
        Ok(Comparison { view, lights, truths: truths.stills(exposure), trials, animation })
    }

    fn truths(&self, subject: &Subject, moves: &[Scene], bar: &ProgressBar) -> Result<Truths> {
        let slopes = SlopeMap::of(&subject.image, &subject.options)?;
        let truth = Truth {
            shading: Shading::Lean,
            detail: &SlopeDetail::new(slopes, subject.options.wrap).with_reconstruction(self.reconstruction),
            options: self.shading.shading_options(),
            samples: self.samples,
        };
        let references: Vec<Shading> = Shading::ALL.iter().map(|shading| shading.reference()).collect();
        let references = without_repeats(&references);
        let watch = steps(bar, u64::from(self.samples));
        let mut frames = vec![Vec::new(); references.len()];
        for scene in moves {
            let pictures =
                truth.render_each(&references, scene, (self.size.width, self.size.height), &watch)?;
            frames.iter_mut().zip(pictures).for_each(|(frames, picture)| frames.push(picture));
        }
        Ok(Truths { references, frames })
    }

    fn frames_of(&self, method: &Method<'_>, moves: &[Scene], bar: &ProgressBar) -> Result<Vec<Picture>> {
        let watch = steps(bar, METHOD_PIXEL);
        let size = (self.size.width, self.size.height);
        moves.iter().map(|scene| Ok(method.render(scene, size, &watch)?)).collect()
    }

    /// A row of the results, before its numbers are filled in.
    fn row(&self, subject: &Subject, view: View, method: Shading, filter: Filter) -> Row {
        Row {
            map: subject.name.clone(),
            scene: self.scene.scene.name(),
            view,
            method,
            filter,
            rmse: 0.0,
            flip: 0.0,
            energy: 0.0,
            flicker: None,
        }
    }

    /// Measures a method's frames against those of the ground truth.
    fn judge(
        &self,
        row: Row,
        frames: &[Picture],
        truth: &[Picture],
        exposure: f32,
        bar: &ProgressBar,
    ) -> Result<Trial> {
        let (picture, still) = (&frames[0], &truth[0]);
        let error = rmse(picture, still)?;
        let flip = hdr_flip(picture, still, DEFAULT_PIXELS_PER_DEGREE)?;
        bar.inc(FLIP_PIXEL * u64::from(self.size.height));
        let peak = still.radiance().iter().flatten().fold(0.0_f32, |peak, value| peak.max(*value));
        Ok(Trial {
            row: Row {
                rmse: error,
                flip: flip.mean,
                energy: energy_error(picture, still)?,
                flicker: if self.frames > 0 { Some(flicker(frames, truth)?) } else { None },
                ..row
            },
            error_of_peak: error / f64::from(peak),
            picture: shown(picture, exposure),
            error: error_picture(flip.width, &flip.errors),
        })
    }
}

impl Comparison {
    /// The results of a method with one of the filters.
    pub fn trial(&self, method: Shading, filter: Filter) -> &Trial {
        let found = self.trials.iter().find(|trial| trial.row.method == method && trial.row.filter == filter);
        found.expect("every method was tried with every filter")
    }
}

impl Truths {
    /// The frames of the ground truth that a method is compared with.
    fn of(&self, shading: Shading) -> &[Picture] {
        let place = self.references.iter().position(|reference| *reference == shading.reference());
        &self.frames[place.expect("there is a ground truth of every reference")]
    }

    fn stills(&self, exposure: f32) -> Vec<(Shading, Srgb8Picture)> {
        let stills = self.frames.iter().map(|frames| shown(&frames[0], exposure));
        self.references.iter().copied().zip(stills).collect()
    }
}

/// Advances the bar by this many steps for every row.
fn steps(bar: &ProgressBar, each: u64) -> impl Fn(usize, usize) -> ControlFlow<()> + Sync {
    move |_, _| {
        bar.inc(each);
        ControlFlow::Continue(())
    }
}

/// Pixels between pictures, and the grey level of the gap.
const GAP: u32 = 4;
const BLACK: u8 = 0;

/// Combines sequences of equal length and size into one, side by side.
fn side_by_side(sequences: &[Vec<Srgb8Picture>]) -> Vec<Srgb8Picture> {
    let frame = |i: usize| {
        let pictures = sequences.iter().map(|sequence| &sequence[i]);
        Srgb8Picture::side_by_side(pictures, GAP, BLACK).expect("there are sequences")
    };
    (0..sequences[0].len()).map(frame).collect()
}
