//! Triangle meshes from files: Wavefront OBJ and glTF 2.0, with their materials and all sets of texture coordinates.
//!
//! [`read_mesh`] keeps the file's parts separate; [`load_mesh`] merges them into one [`Mesh`] to render.
//!
//! ```no_run
//! use roughcast_io::mesh::read_mesh;
//!
//! let file = read_mesh("chair.gltf")?;
//! for primitive in &file.primitives {
//!     let material = primitive.material.map(|index| &file.materials[index]);
//!     println!("{:?}: {:?}", primitive.name, material.and_then(|m| m.normal_texture.as_ref()));
//! }
//! let mesh = file.into_mesh()?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod accessor;
mod error;
mod gltf;
mod gltf_material;
mod material;
mod obj;
mod uri;

use std::io::Read;
use std::path::Path;

use roughcast_scene::{Mesh, MeshFault, NormalKind, NormalSource, TriangleMesh};

pub use error::{MeshFileError, MeshFileFault};
pub use material::{AlphaMode, MeshImage, MeshMaterial, MeshTexture};

/// Maximum size of a file in bytes, and of all buffers of a glTF file.
pub const MAX_FILE_BYTES: usize = 1 << 29;
/// Maximum number of sets of texture coordinates read for a primitive: they may share one buffer, so the file size does
/// not bound them.
pub const MAX_FILE_UV_SETS: usize = 8;

roughcast::named_enum! {
    /// Which normals of a mesh file are used.
    #[derive(Default)]
    #[non_exhaustive]
    pub enum FileNormals: "normals of a mesh" {
        /// Those in the file. Where there are none, what its format prescribes: see [`MeshFile::missing_normals`].
        #[default]
        File = "file",
        /// Smooth ones, computed instead of those in the file: [`NormalKind::Smooth`].
        Smooth = "smooth",
        /// Flat ones, computed instead of those in the file: [`NormalKind::Flat`].
        Flat = "flat",
    }
}

/// The contents of a mesh file.
#[derive(Debug, Default)]
#[non_exhaustive]
pub struct MeshFile {
    /// The parts, each with one material.
    pub primitives: Vec<Primitive>,
    /// The materials, in the order of the file.
    pub materials: Vec<MeshMaterial>,
    /// Sets of texture coordinates after the first that the file declares but that cannot be used.
    pub skipped_uv_sets: Vec<SkippedUvSet>,
    /// The normals of primitives that have none in the file. Flat for glTF, which prescribes it (glTF 2.0, section
    /// 3.7.2.1). Smooth for OBJ: scans and classic models come without normals and are meant to look round, and the
    /// file's smoothing groups (`s`) are not read.
    pub missing_normals: NormalKind,
}

/// A part of a mesh file: triangles that share a material.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Primitive {
    /// The name of the glTF node that shows it, or of the OBJ object or group.
    pub name: Option<String>,
    /// Its material: an index of [`MeshFile::materials`]. `None` for the default material.
    pub material: Option<usize>,
    /// Its vertices and triangles in world space: the transforms of glTF's nodes are applied. Attributes missing from
    /// the file are empty.
    pub triangles: TriangleMesh,
}

/// A set of texture coordinates that was left out.
#[derive(Debug)]
#[non_exhaustive]
pub struct SkippedUvSet {
    /// An index of [`MeshFile::primitives`].
    pub primitive: usize,
    /// The number of the set in the file.
    pub set: usize,
    /// What is wrong with it.
    pub fault: MeshFileFault,
}

impl MeshFile {
    /// Merges all primitives into one mesh and computes missing normals and tangents:
    /// [`MeshFile::into_mesh_with_normals`] with those of the file.
    ///
    /// # Errors
    /// The fault in the numbers of the file, which the reader does not check.
    pub fn into_mesh(self) -> Result<Mesh, MeshFault> {
        self.into_mesh_with_normals(FileNormals::File)
    }

    /// Merges all primitives into one mesh with these normals, and computes missing tangents; see
    /// [`Mesh::with_normals`].
    ///
    /// # Errors
    /// The fault in the numbers of the file, which the reader does not check.
    pub fn into_mesh_with_normals(self, normals: FileNormals) -> Result<Mesh, MeshFault> {
        let source = match normals {
            FileNormals::File => NormalSource::GivenOr(self.missing_normals),
            FileNormals::Smooth => NormalSource::Computed(NormalKind::Smooth),
            FileNormals::Flat => NormalSource::Computed(NormalKind::Flat),
        };
        let parts = self.primitives.into_iter().map(|primitive| primitive.triangles).collect();
        Mesh::with_normals(parts, source)
    }
}

/// Reads a mesh file: Wavefront OBJ (`.obj`) or glTF 2.0 (`.gltf`, `.glb`).
///
/// From glTF it reads all triangles of the default scene, placed by its nodes, but no skins, morph targets,
/// animations or extensions. From OBJ it reads polygons, cut into triangles, but no lines and points, and no `.mtl`
/// files: a material is a name. It reads no images. It keeps the tangents of a file as they are. Some exporters write
/// them with the bitangent along growing v, against the convention of [`TriangleMesh`]; maps for such a mesh have green
/// down.
///
/// # Errors
/// [`MeshFileError`], one line with the path.
pub fn read_mesh(path: impl AsRef<Path>) -> Result<MeshFile, MeshFileError> {
    let path = path.as_ref();
    contents(path).map_err(|fault| MeshFileError { path: path.to_owned(), fault })
}

/// Reads a mesh file as one mesh: [`read_mesh`] and [`MeshFile::into_mesh`].
///
/// # Errors
/// [`MeshFileError`], one line with the path.
pub fn load_mesh(path: impl AsRef<Path>) -> Result<Mesh, MeshFileError> {
    load_mesh_with_normals(path, FileNormals::File)
}

/// Reads a mesh file as one mesh with these normals: [`read_mesh`] and [`MeshFile::into_mesh_with_normals`].
///
/// # Errors
/// [`MeshFileError`], one line with the path.
pub fn load_mesh_with_normals(path: impl AsRef<Path>, normals: FileNormals) -> Result<Mesh, MeshFileError> {
    let path = path.as_ref();
    let mesh = contents(path).and_then(|file| Ok(file.into_mesh_with_normals(normals)?));
    mesh.map_err(|fault| MeshFileError { path: path.to_owned(), fault })
}

fn contents(path: &Path) -> Result<MeshFile, MeshFileFault> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    match extension.as_str() {
        "obj" => obj::read(&read_file(path)?),
        "gltf" | "glb" => gltf::read(&read_file(path)?, path.parent().unwrap_or(Path::new(""))),
        _ => Err(MeshFileFault::UnknownExtension),
    }
}

/// The bytes of a file, or an error before more bytes than the limit are in memory.
fn read_file(path: &Path) -> Result<Vec<u8>, MeshFileFault> {
    let too_large = MeshFileFault::TooLarge { what: "bytes", limit: MAX_FILE_BYTES };
    let file = std::fs::File::open(path)?;
    if file.metadata()?.len() > MAX_FILE_BYTES as u64 {
        return Err(too_large);
    }
    // Pipes and devices do not report their length.
    let mut bytes = Vec::new();
    file.take(MAX_FILE_BYTES as u64 + 1).read_to_end(&mut bytes)?;
    if bytes.len() > MAX_FILE_BYTES { Err(too_large) } else { Ok(bytes) }
}
