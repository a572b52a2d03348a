//! Shapes in the GPU's memory.

use roughcast_scene::{Shape, TriangleMesh};
use wgpu::util::DeviceExt;

use super::surface::UvSlot;
use crate::{Gpu, GpuError};

/// Floats per vertex: position, normal, tangent with handedness, two sets of texture coordinates.
const FLOATS_A_VERTEX: usize = 3 + 3 + 4 + 2 + 2;

/// The vertex layout that the shaders read.
pub(super) const VERTEX_LAYOUT: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
    array_stride: (FLOATS_A_VERTEX * size_of::<f32>()) as u64,
    step_mode: wgpu::VertexStepMode::Vertex,
    attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32x2, 4 => Float32x2],
};

/// The triangles of a shape. Cheap to clone: the buffers are shared.
#[derive(Clone, Debug)]
pub struct Geometry {
    pub(super) vertices: wgpu::Buffer,
    pub(super) indices: wgpu::Buffer,
    pub(super) index_count: u32,
    uv_sets: [usize; 2],
}

impl Geometry {
    /// Uploads a shape with its first two sets of texture coordinates. For `detail`, see [`Shape::triangles`]; meshes
    /// are used unchanged.
    ///
    /// # Errors
    /// [`GpuError::BufferTooLarge`], [`GpuError::OutOfMemory`].
    pub async fn new(gpu: &Gpu, shape: &Shape, detail: u32) -> Result<Self, GpuError> {
        Self::of_uv_sets(gpu, shape, detail, [0, 1]).await
    }

    /// Uploads a shape with two of its sets of texture coordinates; a set that it does not have is zero everywhere. The
    /// first of the two is that of a map of colours. Tangents are those of the shape's first set: place bumps on
    /// another one by derivatives.
    ///
    /// # Errors
    /// As [`Geometry::new`].
    pub async fn of_uv_sets(
        gpu: &Gpu,
        shape: &Shape,
        detail: u32,
        uv_sets: [usize; 2],
    ) -> Result<Self, GpuError> {
        let mesh = shape.triangles(detail);
        let vertices = vertices_of(&mesh, uv_sets);
        let (vertices, indices): (&[u8], &[u8]) =
            (bytemuck::cast_slice(&vertices), bytemuck::cast_slice(&mesh.indices));
        let usage = wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST;
        Ok(Self {
            vertices: upload(gpu, "the vertices of a shape", vertices, usage).await?,
            indices: upload(gpu, "the triangles of a shape", indices, wgpu::BufferUsages::INDEX).await?,
            index_count: mesh.indices.len() as u32,
            uv_sets,
        })
    }

    /// Moves the vertices, as a skinned or morphing mesh does every frame: to the positions and normals of a shape with
    /// the same vertices in the same order, for everything that is drawn with this geometry. Its tangents need not be
    /// those of the pose: bumps that are placed by derivatives do not use them.
    ///
    /// # Errors
    /// [`GpuError::OtherVertices`] if the number of vertices is another one. Nothing is then changed.
    pub fn deform(&self, gpu: &Gpu, pose: &TriangleMesh) -> Result<(), GpuError> {
        let vertices = vertices_of(pose, self.uv_sets);
        let vertices: &[u8] = bytemuck::cast_slice(&vertices);
        if vertices.len() as u64 != self.vertices.size() {
            let wanted = self.vertices.size() / VERTEX_LAYOUT.array_stride;
            return Err(GpuError::OtherVertices { wanted, got: pose.positions.len() as u64 });
        }
        gpu.queue().write_buffer(&self.vertices, 0, vertices);
        Ok(())
    }

    /// The place of a set of texture coordinates of the shape.
    pub(super) fn slot_of(&self, uv_set: usize) -> Result<UvSlot, GpuError> {
        match self.uv_sets {
            [first, _] if first == uv_set => Ok(UvSlot::First),
            [_, second] if second == uv_set => Ok(UvSlot::Second),
            uploaded => Err(GpuError::UvSet { wanted: uv_set, uploaded }),
        }
    }
}

/// The vertices as the shader reads them. Missing tangents are arbitrary: a frame is completed from the normal.
fn vertices_of(mesh: &TriangleMesh, uv_sets: [usize; 2]) -> Vec<f32> {
    let mut vertices = Vec::with_capacity(mesh.positions.len() * FLOATS_A_VERTEX);
    for i in 0..mesh.positions.len() {
        vertices.extend(mesh.positions[i]);
        vertices.extend(mesh.normals[i]);
        vertices.extend(mesh.tangents.get(i).unwrap_or(&[0.0, 0.0, 0.0, 1.0]));
        for set in uv_sets {
            vertices.extend(mesh.uv_sets.get(set).map_or([0.0; 2], |set| set[i]));
        }
    }
    vertices
}

/// Creates a buffer with these bytes.
pub(super) async fn upload(
    gpu: &Gpu,
    what: &'static str,
    contents: &[u8],
    usage: wgpu::BufferUsages,
) -> Result<wgpu::Buffer, GpuError> {
    let limit = gpu.limits().max_buffer_size;
    let bytes = contents.len() as u64;
    if bytes > limit {
        return Err(GpuError::BufferTooLarge { what, bytes, limit });
    }
    let descriptor = wgpu::util::BufferInitDescriptor { label: Some(what), contents, usage };
    gpu.checked(what, |device| device.create_buffer_init(&descriptor)).await
}
