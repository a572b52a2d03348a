//! From map files to baked texture files: the code shared by the command-line program, a Python package, a web server
//! and an asset importer.
//!
//! A short tour, in the order of the work:
//!
//! 1. [`read_map`] reads a file and decides what was not specified: heights or normals, in which channels, with green
//!    up or down. It returns oddities as [`Finding`]s, which are data; the calling program words them.
//! 2. [`RoughnessInput`] loads the roughness of the material, from a number or a picture.
//! 3. [`BakeChoices`] specifies what is stored and how; open options are chosen for the container and the [`Target`].
//! 4. [`BakeJob`] processes one map: read, bake, compress, write. Its files appear together or not at all, with a
//!    [`Sidecar`] if requested. [`JobReport`] contains the numbers.
//! 5. [`FolderJob`] processes a folder of maps, several at a time.
//! 6. A [`Watch`] receives the progress of jobs, and may stop them.
//!
//! [`read_colours`] reads a picture of colours for a renderer.
//!
//! [`bake_for`] is the shortcut for renderers: it bakes the textures of a shading model from a map in memory.
//!
//! The library prints nothing and does not depend on command-line options. The work runs on the rayon pool in which it
//! is called.
//!
//! # Example
//!
//! ```
//! use std::ops::ControlFlow;
//!
//! use roughcast::texture::Layout;
//! use roughcast::{Image, SampleType};
//! use roughcast_io::png_levels;
//! use roughcast_pipeline::{BakeJob, BakeSettings, Finding, Progress};
//!
//! # let folder = std::env::temp_dir().join(format!("roughcast-doc-{}", std::process::id()));
//! # std::fs::create_dir_all(&folder)?;
//! let map = folder.join("flat.png");
//! let heights = Image::zeros(16, 16, 1, SampleType::U8);
//! png_levels::write_level(&heights, &Default::default(), std::fs::File::create(&map)?)?;
//!
//! let mut settings = BakeSettings::new(Layout::Pbr);
//! settings.map.kind = Some(roughcast::Kind::Height);
//! let job = BakeJob { input: map, output: folder.join("flat.ktx2"), settings };
//! let report = job.run(&|progress: &Progress<'_>| {
//!     eprintln!("{} {}", progress.input.display(), progress.stage);
//!     ControlFlow::Continue(())
//! })?;
//!
//! assert_eq!(report.files, [folder.join("flat.normal.ktx2"), folder.join("flat.roughness.ktx2")]);
//! assert_eq!(report.findings, [Finding::RoughnessAssumedZero]);
//! # std::fs::remove_dir_all(&folder)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![forbid(unsafe_code)]

mod choices;
mod colour;
mod error;
mod findings;
mod folder;
mod job;
mod map;
mod model_textures;
mod report;
mod report_json;
mod roughness;
mod sidecar;
mod target;
mod watch;

pub use choices::{BakeChoices, ChoiceError, LayerFiles, PbrChoice};
pub use colour::{ColourError, read_colours};
pub use error::{FolderError, JobError};
pub use findings::{Finding, RoughnessForm};
pub use folder::{DEFAULT_JOBS, EXTENSIONS, FileOutcome, FolderJob, FolderResult, SkipReason};
pub use job::{BakeJob, BakeSettings, BrokenTexels, SidecarFile, TOKSVIG_POWER};
pub use map::{Map, MapError, MapOptions, ReadMapError, kind_by_pixels, map_of, read_map};
pub use model_textures::{TextureOptions, bake_for};
pub use report::JobReport;
pub use roughness::{Roughness, RoughnessError, RoughnessInput, SPECULAR_POWERS};
pub use sidecar::{Sidecar, SidecarPart};
pub use target::{ReaderLimit, Target, TargetError, TargetFinding, reader_limits};
pub use watch::{Progress, Stage, Unwatched, Watch};
