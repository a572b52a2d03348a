//! One job: reads a map and writes all files of a layout or none.

use std::path::{Path, PathBuf};

use roughcast::texture::{Base, BaseRole, Layout, TextureArray, mark_set};
use roughcast::{Bake, BakeError, BakeOptions, Baked, Blocks};
use roughcast_io::material_names::{MaterialRole, role_of};
use roughcast_io::texture_files::{TextureFiles, WriteFilesError, check_destination, leftover_parts};
use roughcast_io::{CompressError, Container, FileInfo, Stored, stored_of};

use crate::JobError;
use crate::choices::BakeChoices;
use crate::findings::Finding;
use crate::map::{Map, MapOptions, read_map};
use crate::report::JobReport;
use crate::roughness::{Roughness, RoughnessInput};
use crate::sidecar::Sidecar;
use crate::target::reader_limits;
use crate::watch::{Stage, Watch, Watched};

/// The default exponent of Toksvig's gloss factor: the lowest one shown in the LEAN paper.
pub const TOKSVIG_POWER: f32 = 128.0;

/// What to do with broken texels: NaN, infinite, or normals that point into the surface or have no direction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum BrokenTexels {
    /// Repair and count them.
    #[default]
    Repair,
    /// Refuse the map.
    Refuse,
}

/// Whether `NAME.json` is written next to the textures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SidecarFile {
    /// It is not written.
    #[default]
    None,
    /// It is written: see [`Sidecar`].
    Json,
}

/// How maps are read and baked: everything but their paths.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct BakeSettings {
    /// How the map is read.
    pub map: MapOptions,
    /// The roughness of the material.
    pub roughness: Option<RoughnessInput>,
    /// What is stored and how.
    pub choices: BakeChoices,
    /// What to do with broken texels.
    pub broken_texels: BrokenTexels,
    /// Whether `NAME.json` is written too.
    pub sidecar: SidecarFile,
}

impl BakeSettings {
    /// A layout, with everything else open or at its default.
    pub fn new(layout: Layout) -> Self {
        Self {
            map: MapOptions::default(),
            roughness: None,
            choices: BakeChoices::new(layout),
            broken_texels: BrokenTexels::Repair,
            sidecar: SidecarFile::None,
        }
    }
}

/// A map, and the file or files to write.
#[derive(Clone, Debug, PartialEq)]
pub struct BakeJob {
    /// The map.
    pub input: PathBuf,
    /// The file to write. Its extension selects the container. A layout of several files writes `NAME.PART.ext`; PNG
    /// writes one file per level.
    pub output: PathBuf,
    /// How the map is read and baked.
    pub settings: BakeSettings,
}

impl BakeJob {
    /// Reads the map, bakes it and writes the files. If anything fails or `watch` stops the job, no file is written.
    ///
    /// The work is shared by the threads of the current rayon pool: inside of `pool.install(|| job.run(&watch))` that
    /// is `pool`, otherwise rayon's global pool. The files do not depend on the pool.
    ///
    /// # Errors
    /// [`JobError`], including [`JobError::Cancelled`].
    pub fn run(&self, watch: &dyn Watch) -> Result<JobReport, JobError> {
        let mut watched = Watched::new(watch, &self.input, 0, 1);
        let result = run(&self.input, &self.output, &self.settings, &mut watched);
        // The job is done, so there is nothing to stop.
        let _ = watched.end();
        let mut report = result?;
        report.times = watched.times().to_vec();
        report.findings.extend(named_otherwise(&self.input, &self.settings));
        Ok(report)
    }
}

/// A finding if the file name suggests something other than a bump map and the options do not state the kind.
fn named_otherwise(input: &Path, settings: &BakeSettings) -> Option<Finding> {
    let stem = input.file_stem()?.to_str()?;
    let named = role_of(stem).filter(|named| !named.by_letter && settings.map.kind.is_none())?;
    match named.role {
        MaterialRole::Other(what) => Some(Finding::NamedOtherwise { what }),
        _ => None,
    }
}

/// Bakes one map. Nothing is written unless all steps succeed.
pub(crate) fn run(
    input: &Path,
    output: &Path,
    settings: &BakeSettings,
    watched: &mut Watched<'_>,
) -> Result<JobReport, JobError> {
    let path = || input.to_owned();
    let choices = &settings.choices;
    let container =
        Container::of(output).ok_or_else(|| WriteFilesError::UnknownExtension { path: output.to_owned() })?;
    choices.check(container)?;
    check_destination(output, container, &choices.first_file(container))?;

    watched.begin(Stage::Reading)?;
    let Map { image, info, options: source, green_correlation, mut findings, .. } =
        read_map(input, &settings.map).map_err(|source| JobError::Map { path: path(), source })?;
    let roughness = roughness_of(settings, &mut findings)?;
    let options = choices.options(container, roughness.as_ref());

    watched.begin(Stage::Baking)?;
    let Baked { arrays, report } = Bake::of(&image)
        .source(source)
        .roughness(roughness.as_ref().map(Roughness::base))
        .options(options)
        .watched(&|fraction| watched.report(Some(fraction)))
        .run()
        .map_err(|error| match error {
            BakeError::Stopped => JobError::Cancelled,
            source => JobError::Bake { path: path(), source },
        })?;
    if settings.broken_texels == BrokenTexels::Refuse && report.counts.broken() > 0 {
        let (counts, texels) = (report.counts, report.texels);
        return Err(JobError::BrokenTexels { path: path(), counts, texels });
    }
    // The pixels are no longer needed, and the next steps use a lot of memory.
    drop((image, roughness));

    watched.begin(Stage::Compressing)?;
    let (stored, compression) =
        compressed(arrays, choices, container, watched).map_err(|error| match error {
            CompressError::Stopped => JobError::Cancelled,
            source => JobError::Compress { path: path(), source },
        })?;

    watched.begin(Stage::Writing)?;
    let files = write(input, output, settings, &stored, watched)?;
    findings.extend(
        leftover_parts(output, options.layout, &files)
            .into_iter()
            .map(|path| Finding::LeftFromEarlierBake { path }),
    );
    findings.extend(blocks_that_do_not_fit(container, &options, &info));
    findings.extend(unused_roughness(settings));
    let of_target = choices.target.findings(container, &options);
    findings.extend(of_target.into_iter().map(|finding| Finding::Target { finding, container }));
    Ok(JobReport {
        input: path(),
        files,
        info,
        source,
        options,
        report,
        compression,
        green_correlation,
        reader_limits: reader_limits(container, stored[0].layer_count(), stored[0].sample_type()),
        findings,
        times: Vec::new(),
    })
}

/// The material's roughness, with a finding if the layout needs one that was not given.
fn roughness_of(settings: &BakeSettings, findings: &mut Vec<Finding>) -> Result<Option<Roughness>, JobError> {
    if let Some(input) = &settings.roughness {
        return Ok(Some(input.load(&settings.map.read.limits)?));
    }
    match settings.choices.layout.base_role() {
        BaseRole::Apart => {
            findings.push(Finding::SpecularPowerAssumed { power: TOKSVIG_POWER });
            Ok(Some(Roughness::Variance(1.0 / TOKSVIG_POWER)))
        }
        BaseRole::Contained => {
            findings.push(Finding::RoughnessAssumedZero);
            Ok(None)
        }
        BaseRole::OnRequest => Ok(None),
    }
}

/// The textures as stored in the files, compressed and split if requested.
fn compressed(
    mut arrays: Vec<TextureArray>,
    choices: &BakeChoices,
    container: Container,
    watched: &Watched<'_>,
) -> Result<(Vec<Stored>, Option<roughcast_io::CompressionError>), CompressError> {
    let splits = choices.splits(container);
    if splits && arrays.iter().any(|array| array.layers().len() > 1) {
        mark_set(&mut arrays);
    }
    let (stored, error) = stored_of(arrays, choices.blocks, &|fraction| watched.report(Some(fraction)))?;
    let stored = if splits { stored.into_iter().flat_map(Stored::split).collect() } else { stored };
    Ok((stored, error))
}

/// Writes all files and moves them into place unless the watch stops the job.
fn write(
    input: &Path,
    output: &Path,
    settings: &BakeSettings,
    stored: &[Stored],
    watched: &Watched<'_>,
) -> Result<Vec<PathBuf>, JobError> {
    let roughness = settings.roughness.as_ref().and_then(RoughnessInput::file);
    let inputs = [Some(input), roughness].into_iter().flatten().map(Path::to_owned);
    let mut files = TextureFiles::new(output, settings.choices.supercompression)?.protecting(inputs);
    for (index, part) in stored.iter().enumerate() {
        files.add(part)?;
        watched.tell(Some((index + 1) as f32 / stored.len() as f32))?;
    }
    if settings.sidecar == SidecarFile::Json {
        let sidecar = Sidecar::new(stored, files.paths()).to_json();
        let text = serde_json::to_string_pretty(&sidecar).expect("a sidecar is plain data");
        files.add_text("json", &text)?;
    }
    Ok(files.commit()?)
}

/// A finding if the given roughness does not affect what is stored.
fn unused_roughness(settings: &BakeSettings) -> Option<Finding> {
    let given = settings.roughness.as_ref()?.form();
    let BakeChoices { layout, base, .. } = settings.choices;
    let uses = layout.base_role() != BaseRole::OnRequest || base == Base::Baked;
    (!uses).then_some(Finding::RoughnessNotStored { layout, given })
}

/// Checks for textures that Direct3D refuses: block-compressed ones whose sides are not multiples of the block size.
/// Vulkan, Metal and OpenGL accept them (Microsoft, "Texture Block Compression in Direct3D 11", virtual size versus
/// physical size).
fn blocks_that_do_not_fit(container: Container, options: &BakeOptions, info: &FileInfo) -> Option<Finding> {
    const BLOCK_SIDE: usize = 4;
    let (width, height) = (info.width, info.height);
    let fits = width.is_multiple_of(BLOCK_SIDE) && height.is_multiple_of(BLOCK_SIDE);
    (container == Container::Dds && options.blocks == Blocks::Bc && !fits)
        .then_some(Finding::BlocksDoNotFit { width, height })
}
