//! Files that appear either complete or not at all.
//!
//! A file is written without a name, or under a hidden name in the destination's folder (see [`temporary`]), and is
//! moved to its destination when it is complete. If anything fails before that, an existing file stays unchanged.
//!
//! The file is not synced to the disk. A bake lost to a power cut can be repeated, and waiting for hundreds of
//! megabytes to reach the disk takes longer than the bake. This protects against a program or a disk that fails
//! half-way.

mod temporary;

use std::fs::{self, Metadata, Permissions};
use std::io::{self, BufWriter, ErrorKind, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use temporary::Temporary;

/// Maximum number of chained symbolic links followed, as on Linux.
const MAX_LINKS: usize = 40;

/// A file to write to. [`AtomicFile::commit`] moves it to its destination; if dropped before that, it is deleted.
#[derive(Debug)]
pub struct AtomicFile {
    destination: PathBuf,
    file: BufWriter<Temporary>,
    /// Permissions of the file to be replaced.
    permissions: Option<Permissions>,
}

impl AtomicFile {
    /// Opens a temporary file for `destination`, in the same folder. An existing file stays until the commit, and the
    /// new file gets its permissions; otherwise the permissions are those of any new file. Symbolic links are followed.
    ///
    /// # Errors
    /// If the folder is missing or cannot be written to, and if the destination is a folder, a device or
    /// write-protected. The message names the fault and the remedy; the kind is that of the cause.
    pub fn create(destination: &Path) -> io::Result<Self> {
        let old = fs::metadata(destination).ok();
        if let Some(old) = &old {
            check_replaceable(old)?;
        }
        let destination = resolved(destination)?;
        let file = Temporary::create(&destination).map_err(|error| explain(error, destination.parent()))?;
        let permissions = old.map(|old| old.permissions());
        Ok(Self { file: BufWriter::new(file), permissions, destination })
    }

    /// Moves the file to its destination, replacing any file there.
    ///
    /// # Errors
    /// If the last bytes cannot be written or the file cannot be renamed. The destination is then unchanged.
    pub fn commit(self) -> io::Result<()> {
        self.complete()?.rename()
    }

    /// Everything that can fail for lack of space.
    fn complete(self) -> io::Result<Complete> {
        let file = self.file.into_inner().map_err(io::IntoInnerError::into_error)?;
        if let Some(permissions) = self.permissions {
            file.as_file().set_permissions(permissions)?;
        }
        Ok(Complete { destination: self.destination, file })
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for AtomicFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

/// A completely written file.
struct Complete {
    destination: PathBuf,
    file: Temporary,
}

impl Complete {
    fn rename(self) -> io::Result<()> {
        self.file.persist(&self.destination)
    }
}

/// Several files that belong together: none is moved to its destination until all are written.
#[derive(Debug, Default)]
pub struct AtomicSet {
    files: Vec<AtomicFile>,
}

impl AtomicSet {
    /// An empty set.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a file that has been written completely.
    ///
    /// # Errors
    /// If another file of the set already has the same destination: one of the two would be lost.
    pub fn push(&mut self, file: AtomicFile) -> io::Result<()> {
        if self.files.iter().any(|other| other.destination == file.destination) {
            let message = "two of the files to write have this name: give each a name of its own";
            return Err(io::Error::new(ErrorKind::AlreadyExists, message));
        }
        self.files.push(file);
        Ok(())
    }

    /// Moves all files to their destinations.
    ///
    /// # Errors
    /// If the last bytes of any file cannot be written, all destinations are unchanged. If a file cannot be renamed,
    /// which happens only if its folder has changed in the meantime, the files added before it are in place, but it and
    /// the later ones are not. The message starts with the name of the file.
    pub fn commit(self) -> io::Result<()> {
        let named = |destination: &Path, error: io::Error| {
            io::Error::new(error.kind(), format!("{}: {error}", destination.display()))
        };
        let mut complete = Vec::with_capacity(self.files.len());
        for file in self.files {
            let destination = file.destination.clone();
            complete.push(file.complete().map_err(|error| named(&destination, error))?);
        }
        for file in complete {
            let destination = file.destination.clone();
            file.rename().map_err(|error| named(&destination, error))?;
        }
        Ok(())
    }
}

/// Refuses devices and write-protected files, which renaming would silently replace.
fn check_replaceable(old: &Metadata) -> io::Result<()> {
    let (kind, message) = if old.is_dir() {
        (ErrorKind::IsADirectory, "it is a folder: add a file name")
    } else if !old.is_file() {
        (ErrorKind::InvalidInput, "it is not a regular file: give the name of a file")
    } else if old.permissions().readonly() {
        (ErrorKind::PermissionDenied, "it is write-protected: allow writing to it, or give another name")
    } else {
        return Ok(());
    };
    Err(io::Error::new(kind, message))
}

/// The canonical path of a file, so that different spellings compare equal.
fn resolved(destination: &Path) -> io::Result<PathBuf> {
    if let Ok(existing) = fs::canonicalize(destination) {
        return Ok(existing);
    }
    let destination = &linked(destination)?;
    let Some(name) = destination.file_name() else {
        return Err(io::Error::new(ErrorKind::InvalidInput, "the path names no file: add a file name"));
    };
    let folder = match destination.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let folder = fs::canonicalize(folder).map_err(|error| explain(error, Some(folder)))?;
    Ok(folder.join(name))
}

/// The target of a chain of symbolic links, whether it exists or not. The result is not a link itself.
fn linked(destination: &Path) -> io::Result<PathBuf> {
    let mut path = destination.to_owned();
    for _ in 0..MAX_LINKS {
        match fs::read_link(&path) {
            // A relative target is relative to the folder of the link.
            Ok(target) => path = path.parent().unwrap_or(Path::new("")).join(target),
            Err(_) => return Ok(path),
        }
    }
    Err(io::Error::new(
        ErrorKind::InvalidInput,
        "its symbolic links lead in a circle: give the name of a file",
    ))
}

/// Says what is wrong with the folder.
fn explain(error: io::Error, folder: Option<&Path>) -> io::Error {
    let path = folder.unwrap_or(Path::new("."));
    let folder = path.display();
    let message = match error.kind() {
        ErrorKind::NotFound if path.is_dir() => {
            format!("the folder {folder} takes no new files: write elsewhere")
        }
        ErrorKind::NotFound => format!("the folder {folder} does not exist: create it first"),
        ErrorKind::NotADirectory => format!("{folder} is not a folder: give another path"),
        ErrorKind::PermissionDenied => {
            format!("the folder {folder} cannot be written to: allow it, or write elsewhere")
        }
        ErrorKind::ReadOnlyFilesystem => {
            format!("the folder {folder} is on a read-only disk: write elsewhere")
        }
        _ => return error,
    };
    io::Error::new(error.kind(), message)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> tempfile::TempDir {
        tempfile::tempdir().expect("a temporary folder")
    }

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("the folder is there");
        let name = |entry: io::Result<fs::DirEntry>| {
            entry.expect("an entry").file_name().into_string().expect("ASCII")
        };
        let mut names: Vec<String> = entries.map(name).collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_appears_only_at_the_commit() {
        let folder = folder();
        let path = folder.path().join("map.exr");
        let mut file = AtomicFile::create(&path).expect("a writable folder");
        file.write_all(b"0123456789").expect("space");
        file.seek(SeekFrom::Start(2)).expect("a file");
        file.write_all(b"ab").expect("space");
        file.flush().expect("space");
        assert!(!path.exists());
        file.commit().expect("a writable folder");
        assert_eq!(names(folder.path()), ["map.exr"]);
        assert_eq!(fs::read(&path).expect("the file"), b"01ab456789");
    }

    #[test]
    fn an_old_file_survives_a_write_that_fails() {
        let folder = folder();
        let path = folder.path().join("map.exr");
        fs::write(&path, "old").expect("space");
        let write = || -> io::Result<()> {
            let mut file = AtomicFile::create(&path)?;
            file.write_all(b"half of the n")?;
            file.flush()?;
            Err(io::Error::new(ErrorKind::StorageFull, "the disk is full"))
        };
        assert!(write().is_err());
        assert_eq!(fs::read(&path).expect("the file"), b"old");
        assert_eq!(names(folder.path()), ["map.exr"]);
        let mut file = AtomicFile::create(&path).expect("a writable folder");
        file.write_all(b"new").expect("space");
        file.commit().expect("a writable folder");
        assert_eq!(fs::read(&path).expect("the file"), b"new");
    }

    #[test]
    fn long_names_leave_room_for_the_temporary_ones() {
        let folder = folder();
        let path = folder.path().join("ä".repeat(127));
        AtomicFile::create(&path).expect("a name that fits").commit().expect("a name that fits");
        assert_eq!(names(folder.path()).len(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn permissions_are_those_of_any_file_or_of_the_one_before() {
        use std::os::unix::fs::PermissionsExt;
        let folder = folder();
        let mode = |path: &Path| fs::metadata(path).expect("the file").permissions().mode() & 0o777;
        let (plain, ours) = (folder.path().join("plain"), folder.path().join("ours"));
        fs::write(&plain, "").expect("space");
        AtomicFile::create(&ours).expect("a writable folder").commit().expect("a writable folder");
        assert_eq!(mode(&ours), mode(&plain));
        fs::set_permissions(&ours, Permissions::from_mode(0o640)).expect("our file");
        AtomicFile::create(&ours).expect("a writable folder").commit().expect("a writable folder");
        assert_eq!(mode(&ours), 0o640);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_followed() {
        let folder = folder();
        let (target, link) = (folder.path().join("target"), folder.path().join("link"));
        fs::write(&target, "old").expect("space");
        std::os::unix::fs::symlink(&target, &link).expect("a link");
        let mut file = AtomicFile::create(&link).expect("a writable folder");
        file.write_all(b"new").expect("space");
        file.commit().expect("a writable folder");
        assert_eq!(fs::read(&target).expect("the file"), b"new");
        assert!(fs::symlink_metadata(&link).expect("the link").is_symlink());
    }

    #[cfg(unix)]
    #[test]
    fn a_dangling_link_is_followed_to_its_target() {
        use std::os::unix::fs::symlink;
        let folder = folder();
        fs::create_dir(folder.path().join("below")).expect("space");
        let (first, second) = (folder.path().join("first"), folder.path().join("second"));
        symlink("second", &first).expect("a link");
        symlink("below/target", &second).expect("a link");
        let mut file = AtomicFile::create(&first).expect("a writable folder");
        file.write_all(b"new").expect("space");
        file.commit().expect("a writable folder");
        assert_eq!(fs::read(folder.path().join("below/target")).expect("the file"), b"new");
        assert!(fs::symlink_metadata(&first).expect("the link").is_symlink());
        // A link into a missing folder, and a cycle of links.
        symlink("missing/target", folder.path().join("nowhere")).expect("a link");
        symlink("circle", folder.path().join("circle")).expect("a link");
        let refusal =
            |name| AtomicFile::create(&folder.path().join(name)).expect_err("a bad link").to_string();
        assert!(refusal("nowhere").contains("create it first"));
        assert!(refusal("circle").contains("in a circle"));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_read_only_folder_is_not_reported_as_missing() {
        let message =
            AtomicFile::create(Path::new("/proc/map.exr")).expect_err("no new files there").to_string();
        assert!(message.contains("/proc takes no new files"), "{message}");
    }

    #[test]
    fn bad_destinations_are_refused_with_advice() {
        let folder = folder();
        let refusal = |path: &Path| AtomicFile::create(path).expect_err("a bad destination").to_string();
        assert!(refusal(folder.path()).contains("it is a folder"));
        assert!(refusal(&folder.path().join("missing/map.exr")).contains("create it first"));
        assert!(refusal(&folder.path().join("..")).contains("add a file name"));
        assert!(refusal(Path::new("")).contains("add a file name"));
        let file = folder.path().join("file");
        fs::write(&file, "old").expect("space");
        assert!(refusal(&file.join("map.exr")).contains("is not a folder"));
        let mut permissions = fs::metadata(&file).expect("the file").permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&file, permissions).expect("our file");
        assert!(refusal(&file).contains("write-protected"));
        #[cfg(unix)]
        assert!(refusal(Path::new("/dev/null")).contains("not a regular file"));
        assert_eq!(names(folder.path()), ["file"]);
    }

    #[test]
    fn a_set_is_committed_together() {
        let folder = folder();
        let mut set = AtomicSet::new();
        for name in ["a", "b"] {
            let mut file = AtomicFile::create(&folder.path().join(name)).expect("a writable folder");
            file.write_all(name.as_bytes()).expect("space");
            set.push(file).expect("another name");
        }
        assert!(!folder.path().join("a").exists() && !folder.path().join("b").exists());
        // The same file by another path.
        let detour = folder.path().join("..").join(folder.path().file_name().expect("it has a name"));
        let again = AtomicFile::create(&detour.join("a")).expect("a writable folder");
        assert!(set.push(again).expect_err("the same name").to_string().contains("a name of its own"));
        set.commit().expect("a writable folder");
        assert_eq!(names(folder.path()), ["a", "b"]);
        assert_eq!(fs::read(folder.path().join("b")).expect("the file"), b"b");
    }

    #[test]
    fn a_dropped_set_leaves_nothing() {
        let folder = folder();
        fs::write(folder.path().join("a"), "old").expect("space");
        let mut set = AtomicSet::new();
        for name in ["a", "b"] {
            set.push(AtomicFile::create(&folder.path().join(name)).expect("a writable folder"))
                .expect("another name");
        }
        drop(set);
        assert_eq!(names(folder.path()), ["a"]);
        assert_eq!(fs::read(folder.path().join("a")).expect("the file"), b"old");
    }

    /// The second destination becomes a folder while the files are being written.
    #[test]
    fn a_rename_that_fails_names_its_file() {
        let folder = folder();
        let mut set = AtomicSet::new();
        for name in ["a", "b"] {
            set.push(AtomicFile::create(&folder.path().join(name)).expect("a writable folder"))
                .expect("another name");
        }
        fs::create_dir(folder.path().join("b")).expect("space");
        let message = set.commit().expect_err("a folder is in the way").to_string();
        assert!(message.contains('b'), "{message}");
        assert_eq!(names(folder.path()), ["a", "b"]);
    }
}
