//! Temporary storage for the bytes of a file until it is complete.
//!
//! On Linux, if the file system supports it, the bytes go into an unnamed file: however the program ends, nothing is
//! left behind. Otherwise they go into a hidden file in the destination's folder. A killed program leaves this file
//! behind; the next program that writes to the same destination removes it if it is old.

use std::fs::{self, File, Permissions};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::Path;
use std::time::{Duration, SystemTime};

use tempfile::NamedTempFile;

/// Characters of the destination's name used in the temporary name, which could otherwise be too long for the file
/// system.
const NAME_CHARACTERS: usize = 48;
/// Suffix of the names of hidden files.
const SUFFIX: &str = ".tmp";
/// A hidden file that has not been written to for this long is assumed to belong to a killed program.
const STALE: Duration = Duration::from_secs(3600);

/// A file that has not been moved to its destination yet; it is deleted when dropped.
#[derive(Debug)]
pub(super) enum Temporary {
    /// Without a name.
    #[cfg(target_os = "linux")]
    Unnamed(File),
    /// Under a hidden name in the destination's folder.
    Named(NamedTempFile),
}

impl Temporary {
    /// An empty file for a destination with a resolved path.
    pub(super) fn create(destination: &Path) -> io::Result<Self> {
        #[cfg(target_os = "linux")]
        if let Some(file) = unnamed(folder_of(destination)) {
            return Ok(Self::Unnamed(file));
        }
        Self::create_named(destination)
    }

    /// Creates an empty hidden file, after removing those left by killed programs.
    pub(super) fn create_named(destination: &Path) -> io::Result<Self> {
        remove_stale(destination, SystemTime::now());
        named(destination).map(Self::Named)
    }

    /// The file, to set its permissions.
    pub(super) fn as_file(&self) -> &File {
        match self {
            #[cfg(target_os = "linux")]
            Self::Unnamed(file) => file,
            Self::Named(file) => file.as_file(),
        }
    }

    /// Moves the file to its destination, replacing any file there.
    pub(super) fn persist(self, destination: &Path) -> io::Result<()> {
        match self {
            #[cfg(target_os = "linux")]
            Self::Unnamed(file) => link(&file, destination),
            Self::Named(file) => file.persist(destination).map(drop).map_err(|error| error.error),
        }
    }
}

impl Write for Temporary {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.as_file().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.as_file().flush()
    }
}

impl Seek for Temporary {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.as_file().seek(to)
    }
}

fn folder_of(destination: &Path) -> &Path {
    destination.parent().unwrap_or(Path::new("."))
}

/// An unnamed file in a folder; `None` if the file system does not support this or anything else fails.
#[cfg(target_os = "linux")]
fn unnamed(folder: &Path) -> Option<File> {
    use rustix::fs::{Mode, OFlags, open};
    let flags = OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC;
    // As for any new file, the umask applies.
    let file = File::from(open(folder, flags, Mode::from_raw_mode(0o666)).ok()?);
    // Naming the file later requires this folder, which a container may lack.
    Path::new(&by_descriptor(&file)).exists().then_some(file)
}

#[cfg(target_os = "linux")]
fn by_descriptor(file: &File) -> String {
    use std::os::fd::AsRawFd;
    format!("/proc/self/fd/{}", file.as_raw_fd())
}

/// Gives an unnamed file its name. An existing file cannot be replaced in one step, so in that case the file gets a
/// hidden name first; only a kill between the two calls could leave it behind.
#[cfg(target_os = "linux")]
fn link(file: &File, destination: &Path) -> io::Result<()> {
    use rustix::fs::{AtFlags, CWD, linkat};
    let link_to = |path: &Path| -> io::Result<()> {
        Ok(linkat(CWD, by_descriptor(file), CWD, path, AtFlags::SYMLINK_FOLLOW)?)
    };
    match link_to(destination) {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
            // A free name, found by creating a file with it.
            let hidden = named(destination)?.into_temp_path();
            fs::remove_file(&hidden)?;
            link_to(&hidden)?;
            hidden.persist(destination).map_err(|error| error.error)
        }
        result => result,
    }
}

/// The start of the hidden names of a destination.
fn prefix(destination: &Path) -> String {
    let name = destination.file_name().unwrap_or_default().to_string_lossy();
    format!(".{}.", name.chars().take(NAME_CHARACTERS).collect::<String>())
}

fn named(destination: &Path) -> io::Result<NamedTempFile> {
    let prefix = prefix(destination);
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(SUFFIX);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // As for any new file, the umask applies. By default only the owner could read temporary files.
        builder.permissions(Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder_of(destination))
}

/// Removes old hidden files of a destination. Files that cannot be read or removed are left.
fn remove_stale(destination: &Path, now: SystemTime) {
    let prefix = prefix(destination);
    let Ok(entries) = fs::read_dir(folder_of(destination)) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let is_ours = name.to_str().is_some_and(|name| name.starts_with(&prefix) && name.ends_with(SUFFIX));
        let age = || now.duration_since(entry.metadata().ok()?.modified().ok()?).ok();
        if is_ours && age().is_some_and(|age| age > STALE) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("the folder is there");
        let mut names: Vec<String> =
            entries.map(|entry| entry.expect("an entry").file_name().into_string().expect("ASCII")).collect();
        names.sort();
        names
    }

    #[test]
    fn both_kinds_replace_an_older_file_or_create_a_new_one() {
        for create in [Temporary::create, Temporary::create_named] {
            let folder = tempfile::tempdir().expect("a temporary folder");
            let destination = folder.path().join("map.exr");
            for content in ["first", "second"] {
                let mut file = create(&destination).expect("a writable folder");
                file.write_all(content.as_bytes()).expect("space");
                file.persist(&destination).expect("a writable folder");
                assert_eq!(fs::read_to_string(&destination).expect("the file"), content);
                assert_eq!(names(folder.path()), ["map.exr"]);
            }
        }
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn an_unnamed_file_is_never_seen() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        // Some file systems do not support unnamed files; they use hidden files, which the next test covers.
        let Some(mut file) = unnamed(folder.path()) else { return };
        file.write_all(b"half of it").expect("space");
        assert!(names(folder.path()).is_empty());
    }

    #[test]
    fn hidden_files_of_the_same_destination_are_removed_when_they_are_old() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let destination = folder.path().join("map.exr");
        for name in [".map.exr.Ab12Cd.tmp", ".map.exr", ".other.exr.Ab12Cd.tmp", "map.exr.tmp"] {
            fs::write(folder.path().join(name), "").expect("space");
        }
        let before = names(folder.path());
        remove_stale(&destination, SystemTime::now());
        assert_eq!(names(folder.path()), before, "a young file may belong to a program that runs");
        remove_stale(&destination, SystemTime::now() + 2 * STALE);
        assert_eq!(names(folder.path()), [".map.exr", ".other.exr.Ab12Cd.tmp", "map.exr.tmp"]);
    }
}
