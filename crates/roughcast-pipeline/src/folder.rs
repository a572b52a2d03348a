//! Bakes a folder of maps. One bad file does not stop the rest.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsString;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use rayon::ThreadPool;
use roughcast::Kind;
use roughcast_io::Container;
use roughcast_io::material_names::{MaterialRole, NamedRole, roles_of};
use roughcast_io::texture_files::is_same_file;
use wildmatch::WildMatch;

use crate::error::{FolderError, JobError};
use crate::findings::Finding;
use crate::job::{self, BakeSettings};
use crate::map::{MapError, kind_by_pixels};
use crate::report::JobReport;
use crate::watch::{Progress, Stage, Watch, Watched};

/// File extensions that are considered, in lower case.
pub const EXTENSIONS: [&str; 15] = [
    "png", "jpg", "jpeg", "tga", "bmp", "webp", "tif", "tiff", "hdr", "exr", "ktx2", "dds", "rgbe", "pic",
    "tx",
];

/// The default limit on simultaneous jobs: each holds a whole map in memory.
pub const DEFAULT_JOBS: usize = 4;

/// Every map of a folder, and the folder to write to.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct FolderJob<'a> {
    /// The folder of the maps.
    pub input: PathBuf,
    /// The folder to write to; it is created if missing.
    pub output: PathBuf,
    /// The container of the outputs.
    pub container: Container,
    /// File name patterns, with `*` for any characters and `?` for one, ignoring case. Files that match any pattern are
    /// baked; without patterns all files are.
    pub patterns: Vec<String>,
    /// Number of maps baked at the same time; `None` for the pool's number of threads, but at most [`DEFAULT_JOBS`].
    pub jobs: Option<NonZeroUsize>,
    /// The pool whose threads share the work; `None` for rayon's global pool. [`FolderJob::run`] waits for it, so it
    /// must not be called from a thread of that pool.
    pub pool: Option<&'a ThreadPool>,
    /// How the maps are read and baked.
    pub settings: BakeSettings,
}

/// The outcome for one file of a folder.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum FileOutcome {
    /// The file was baked.
    Baked(Box<JobReport>),
    /// The file is not a bump map.
    Skipped(SkipReason),
}

/// Why a file of a folder is not a bump map.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SkipReason {
    /// Its name says so.
    Named {
        /// What the name suggests, such as `roughness`.
        what: &'static str,
    },
    /// Roughcast wrote it.
    Baked,
    /// The pixels are not clearly normals or heights, and the name does not state a role.
    Undecided {
        /// What the pixels show.
        reason: String,
    },
}

/// A file of a folder and its outcome.
#[derive(Debug)]
#[non_exhaustive]
pub struct FolderResult {
    /// The file.
    pub input: PathBuf,
    /// Its outcome.
    pub outcome: Result<FileOutcome, JobError>,
}

impl<'a> FolderJob<'a> {
    /// A job that bakes all maps of `input` to KTX2 files in `output`.
    pub fn new(input: impl Into<PathBuf>, output: impl Into<PathBuf>, settings: BakeSettings) -> Self {
        Self {
            input: input.into(),
            output: output.into(),
            container: Container::Ktx2,
            patterns: Vec::new(),
            jobs: None,
            pool: None,
            settings,
        }
    }

    /// Bakes every map, several at a time; a failure does not stop the others. Results are in the order of the names.
    /// Neither the results nor the files depend on the number of jobs or threads.
    ///
    /// The contents of a file are determined by its name, if its pixels agree, or by its pixels alone
    /// ([`roughcast_io::material_names`]); other files of a material are skipped. After `watch` returns `Break`, no
    /// further job starts and running jobs end at their next report; the outcome of all of these is
    /// [`JobError::Cancelled`].
    ///
    /// # Errors
    /// [`FolderError`] if there is no map to bake.
    pub fn run(&self, watch: &dyn Watch) -> Result<Vec<FolderResult>, FolderError> {
        self.check_output()?;
        self.settings.choices.check(self.container)?;
        let inputs = self.maps()?;
        std::fs::create_dir_all(&self.output).map_err(|source| self.io(&self.output, source))?;
        if is_same_file(&self.input, &self.output) {
            return Err(FolderError::OutputIsInput { path: self.output.clone() });
        }
        let outcomes = self.bake_all(&inputs, watch);
        let rows = inputs.into_iter().zip(outcomes);
        Ok(rows.map(|(input, outcome)| FolderResult { input, outcome }).collect())
    }

    /// Refuses an output folder whose name ends like a file's, which is probably a mistake.
    fn check_output(&self) -> Result<(), FolderError> {
        let is_file = self.output.exists() && !self.output.is_dir();
        if is_file || (!self.output.exists() && Container::of(&self.output).is_some()) {
            return Err(FolderError::OutputIsFile { path: self.output.clone() });
        }
        Ok(())
    }

    fn io(&self, path: &Path, source: std::io::Error) -> FolderError {
        FolderError::Io { path: path.to_owned(), source }
    }

    /// The files of the folder that may be maps and whose names match a pattern, if there are patterns, in the order of
    /// their names.
    fn maps(&self) -> Result<Vec<PathBuf>, FolderError> {
        let folder = &self.input;
        let matches = |name: &str| {
            let one = |pattern: &String| WildMatch::new_case_insensitive(pattern).matches(name);
            self.patterns.is_empty() || self.patterns.iter().any(one)
        };
        let mut maps = Vec::new();
        for entry in std::fs::read_dir(folder).map_err(|source| self.io(folder, source))? {
            let path = entry.map_err(|source| self.io(folder, source))?.path();
            let extension =
                path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            if path.is_file() && EXTENSIONS.contains(&extension.as_str()) && matches(&name) {
                maps.push(path);
            }
        }
        maps.sort();
        if maps.is_empty() {
            return Err(FolderError::NoMaps { path: folder.clone(), patterns: self.patterns.clone() });
        }
        Ok(maps)
    }

    /// Output paths: `NAME.ktx2` for `NAME.png`. If several inputs share a name, they become `NAME_png.ktx2` and so on,
    /// so that none is overwritten.
    fn outputs(&self, inputs: &[PathBuf]) -> Vec<PathBuf> {
        let stem = |path: &Path| path.file_stem().unwrap_or_default().to_owned();
        let mut uses: BTreeMap<OsString, usize> = BTreeMap::new();
        for input in inputs {
            *uses.entry(stem(input)).or_default() += 1;
        }
        let mut taken = BTreeSet::new();
        let output_of = |input: &PathBuf| {
            let mut name = stem(input);
            if uses[&name] > 1 {
                name.push("_");
                name.push(input.extension().unwrap_or_default());
            }
            // `a.png`, `a.jpg` and `a_png.png` could still clash.
            while !taken.insert(name.clone()) {
                name.push("_");
            }
            name.push(".");
            name.push(self.container.name());
            self.output.join(name)
        };
        inputs.iter().map(output_of).collect()
    }

    /// What the names of all files reveal about each file.
    fn files<'f>(&self, inputs: &'f [PathBuf]) -> Vec<File<'f>> {
        let stem_of = |input: &'f PathBuf| input.file_stem().and_then(|stem| stem.to_str());
        let roles = roles_of(inputs.iter().map(|input| stem_of(input).unwrap_or_default()));
        let named = inputs.iter().zip(self.outputs(inputs)).zip(roles);
        let file = |((input, output), named): ((&'f PathBuf, PathBuf), Option<NamedRole>)| File {
            input,
            output,
            role: named.map(|named| named.role),
        };
        named.map(file).collect()
    }

    /// Runs the jobs on their own threads; outcomes are in the order of the inputs.
    fn bake_all(&self, inputs: &[PathBuf], watch: &dyn Watch) -> Vec<Result<FileOutcome, JobError>> {
        let files = self.files(inputs);
        let watch = &Shared { watch, stopped: AtomicBool::new(false) };
        let threads = self.pool.map_or_else(rayon::current_num_threads, ThreadPool::current_num_threads);
        let jobs = self.jobs.map_or(threads.min(DEFAULT_JOBS), NonZeroUsize::get);
        let next = AtomicUsize::new(0);
        let slots: Vec<Mutex<Option<Result<FileOutcome, JobError>>>> =
            files.iter().map(|_| Mutex::new(None)).collect();
        let work = || {
            loop {
                let index = next.fetch_add(1, Ordering::Relaxed);
                let Some(file) = files.get(index) else { break };
                let job = || {
                    let watched = Watched::new(watch, file.input, index, files.len());
                    bake_guarded(file, &self.settings, watched)
                };
                let outcome = match self.pool {
                    _ if watch.stopped.load(Ordering::Relaxed) => Err(JobError::Cancelled),
                    Some(pool) => pool.install(job),
                    None => job(),
                };
                *slots[index].lock().expect("no job panics while it holds the lock") = Some(outcome);
            }
        };
        std::thread::scope(|scope| {
            for _ in 0..jobs.min(files.len()) {
                scope.spawn(work);
            }
        });
        slots
            .into_iter()
            .map(|slot| slot.into_inner().expect("no job panicked").expect("every job was run"))
            .collect()
    }
}

/// A file of a folder, and the role that its name states.
struct File<'a> {
    input: &'a Path,
    output: PathBuf,
    role: Option<MaterialRole>,
}

/// Bakes one file and turns a panic into an error.
fn bake_guarded(
    file: &File<'_>,
    settings: &BakeSettings,
    mut watched: Watched<'_>,
) -> Result<FileOutcome, JobError> {
    let work = || bake_by_role(file, settings, &mut watched);
    let mut outcome = catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|payload| {
        let text = payload.downcast_ref::<String>().map(String::as_str);
        let message = text.or_else(|| payload.downcast_ref::<&str>().copied()).unwrap_or("a panic");
        Err(JobError::Panicked { path: file.input.to_owned(), message: message.to_owned() })
    });
    // A `Break` stops the other jobs: `Shared` remembers it.
    let _ = watched.end();
    if let Ok(FileOutcome::Baked(report)) = &mut outcome {
        report.times = watched.times().to_vec();
    }
    outcome
}

/// The watch shared by all jobs of a folder: a `Break` in one job stops all of them.
struct Shared<'a> {
    watch: &'a dyn Watch,
    stopped: AtomicBool,
}

impl Watch for Shared<'_> {
    fn progress(&self, progress: &Progress<'_>) -> ControlFlow<()> {
        if self.watch.progress(progress).is_break() {
            self.stopped.store(true, Ordering::Relaxed);
        }
        if self.stopped.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// Bakes one file of a folder, or returns why it is not a map: because of its name, if its pixels agree, or because of
/// its pixels alone.
fn bake_by_role(
    file: &File<'_>,
    settings: &BakeSettings,
    watched: &mut Watched<'_>,
) -> Result<FileOutcome, JobError> {
    let File { input, output, role } = file;
    let role = *role;
    let baked = |report| Ok(FileOutcome::Baked(Box::new(report)));
    // An explicit kind takes precedence over file names.
    let decided = settings.map.kind.is_some();
    if let Some(MaterialRole::Other(what)) = role.filter(|_| !decided) {
        watched.begin(Stage::Reading)?;
        return match kind_by_pixels(input, &settings.map) {
            Some(Kind::Normal) => {
                let mut report = job::run(input, output, settings, watched)?;
                report.findings.push(Finding::NormalsNamedOtherwise { what });
                baked(report)
            }
            _ => Ok(FileOutcome::Skipped(SkipReason::Named { what })),
        };
    }
    let mut settings = settings.clone();
    if let Some(MaterialRole::Normal(green)) = role {
        settings.map.green_by_name = green;
    }
    match job::run(input, output, &settings, watched) {
        Ok(mut report) => {
            report.findings.extend(contradiction(role.filter(|_| !decided), report.source.kind));
            baked(report)
        }
        Err(error) => match error.no_map() {
            Some(MapError::Baked { .. }) => Ok(FileOutcome::Skipped(SkipReason::Baked)),
            Some(MapError::Undecided { reason, .. }) if role.is_none() => {
                Ok(FileOutcome::Skipped(SkipReason::Undecided { reason: reason.clone() }))
            }
            _ => Err(error),
        },
    }
}

/// A finding if the name suggests one kind of map and the pixels another.
fn contradiction(role: Option<MaterialRole>, kind: Kind) -> Option<Finding> {
    match (role?, kind) {
        (MaterialRole::Normal(_), Kind::Height) => Some(Finding::HeightsNamedNormals),
        (MaterialRole::Height, Kind::Normal) => Some(Finding::NormalsNamedHeights),
        _ => None,
    }
}
