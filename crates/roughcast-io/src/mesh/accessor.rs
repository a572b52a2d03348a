//! Numbers in the buffers of a glTF file: glTF 2.0, sections 3.6.1 and 3.6.2. Every access is checked against the sizes
//! stated in the file and the bytes that exist.

use std::collections::HashMap;
use std::path::Path;

use gltf::Accessor;
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::{Buffer, Source};
use roughcast_scene::MAX_VERTICES;

use super::uri::{data_uri, relative_path};
use super::{MAX_FILE_BYTES, MeshFileFault, read_file};

/// The buffers of a file, each read on first use.
pub(super) struct Buffers<'a> {
    /// The folder of the file.
    folder: &'a Path,
    /// The binary chunk of a .glb.
    chunk: Option<&'a [u8]>,
    read: HashMap<usize, Vec<u8>>,
    total: usize,
}

impl<'a> Buffers<'a> {
    pub fn new(folder: &'a Path, chunk: Option<&'a [u8]>) -> Self {
        Self { folder, chunk, read: HashMap::new(), total: 0 }
    }

    fn bytes(&mut self, buffer: &Buffer) -> Result<&[u8], MeshFileFault> {
        match buffer.source() {
            Source::Bin => self.chunk.ok_or_else(|| malformed("it has no binary chunk")),
            Source::Uri(uri) => {
                if !self.read.contains_key(&buffer.index()) {
                    let bytes = self.fetch(uri)?;
                    self.total += bytes.len();
                    if self.total > MAX_FILE_BYTES {
                        return Err(MeshFileFault::TooLarge {
                            what: "bytes of buffers",
                            limit: MAX_FILE_BYTES,
                        });
                    }
                    self.read.insert(buffer.index(), bytes);
                }
                Ok(&self.read[&buffer.index()])
            }
        }
    }

    fn fetch(&self, uri: &str) -> Result<Vec<u8>, MeshFileFault> {
        if let Some(decoded) = data_uri(uri) {
            return decoded.map_err(malformed);
        }
        let path = relative_path(uri).ok_or_else(|| {
            let shown: String = uri.chars().take(80).collect();
            MeshFileFault::Unsupported(format!(
                "a buffer outside of the file's folder ('{}')",
                shown.escape_debug()
            ))
        })?;
        read_file(&self.folder.join(path)).map_err(|fault| match fault {
            MeshFileFault::Io(error) => MeshFileFault::Buffer { uri: uri.to_owned(), error },
            other => other,
        })
    }

    /// Reads an accessor of N floats per element, or of normalised integers, which glTF allows for texture coordinates.
    pub fn floats<const N: usize>(&mut self, accessor: &Accessor) -> Result<Vec<[f32; N]>, MeshFileFault> {
        let fits = matches!(
            (accessor.dimensions(), N),
            (Dimensions::Vec2, 2) | (Dimensions::Vec3, 3) | (Dimensions::Vec4, 4)
        );
        if !fits {
            return Err(malformed(format!(
                "accessor {} should hold vectors of {N} numbers",
                accessor.index()
            )));
        }
        let component: fn(&[u8]) -> f32 = match (accessor.data_type(), accessor.normalized()) {
            (DataType::F32, _) => |b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]),
            (DataType::U8, true) => |b| f32::from(b[0]) / 255.0,
            (DataType::U16, true) => |b| f32::from(u16::from_le_bytes([b[0], b[1]])) / 65535.0,
            (other, _) => {
                return Err(MeshFileFault::Unsupported(format!("a vertex attribute stored as {other:?}")));
            }
        };
        let size = accessor.data_type().size();
        let elements = self.elements(accessor)?;
        Ok(elements.map(|e| std::array::from_fn(|i| component(&e[i * size..][..size]))).collect())
    }

    /// Reads an accessor of indices.
    pub fn indices(&mut self, accessor: &Accessor) -> Result<Vec<u32>, MeshFileFault> {
        let index: fn(&[u8]) -> u32 = match (accessor.data_type(), accessor.dimensions()) {
            (DataType::U8, Dimensions::Scalar) => |b| u32::from(b[0]),
            (DataType::U16, Dimensions::Scalar) => |b| u32::from(u16::from_le_bytes([b[0], b[1]])),
            (DataType::U32, Dimensions::Scalar) => |b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]),
            _ => return Err(malformed(format!("accessor {} should hold indices", accessor.index()))),
        };
        Ok(self.elements(accessor)?.map(index).collect())
    }

    /// The bytes of each element.
    fn elements(&mut self, accessor: &Accessor) -> Result<impl Iterator<Item = &[u8]>, MeshFileFault> {
        let (number, count, size) = (accessor.index(), accessor.count(), accessor.size());
        if accessor.sparse().is_some() {
            return Err(MeshFileFault::Unsupported("a sparse accessor".to_owned()));
        }
        if count > MAX_VERTICES {
            return Err(MeshFileFault::TooLarge { what: "vertices", limit: MAX_VERTICES });
        }
        let view = accessor.view().ok_or_else(|| malformed(format!("accessor {number} has no data")))?;
        let stride = view.stride().unwrap_or(size);
        if stride < size {
            return Err(malformed(format!("the elements of accessor {number} overlap")));
        }
        let outside = || malformed(format!("accessor {number} reaches beyond the end of its buffer"));
        let bytes = self.bytes(&view.buffer())?;
        let viewed = view.offset().checked_add(view.length()).and_then(|end| bytes.get(view.offset()..end));
        let own = viewed.and_then(|bytes| bytes.get(accessor.offset()..)).ok_or_else(outside)?;
        // The last element may be shorter than the stride.
        let needed = match count {
            0 => Some(0),
            _ => (count - 1).checked_mul(stride).and_then(|n| n.checked_add(size)),
        };
        let own = needed.and_then(|needed| own.get(..needed)).ok_or_else(outside)?;
        Ok(own.chunks(stride).map(move |element| &element[..size]))
    }
}

/// The file breaks the rules of glTF.
pub(super) fn malformed(fault: impl Into<String>) -> MeshFileFault {
    MeshFileFault::Malformed { format: "glTF", fault: fault.into() }
}
