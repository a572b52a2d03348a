//! Shapes in the GPU's memory.

use roughcast_scene::{Shape, TriangleMesh};
use wgpu::util::DeviceExt;

use crate::{Gpu, GpuError};

/// Floats per vertex: position, normal, tangent with handedness, texture coordinates.
const FLOATS_A_VERTEX: usize = 3 + 3 + 4 + 2;

/// The vertex layout that the shaders read.
pub(super) const VERTEX_LAYOUT: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
    array_stride: (FLOATS_A_VERTEX * size_of::<f32>()) as u64,
    step_mode: wgpu::VertexStepMode::Vertex,
    attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32x2],
};

/// The triangles of a shape. Cheap to clone: the buffers are shared.
#[derive(Clone, Debug)]
pub struct Geometry {
    pub(super) vertices: wgpu::Buffer,
    pub(super) indices: wgpu::Buffer,
    pub(super) index_count: u32,
}

impl Geometry {
    /// Uploads a shape. For `detail`, see [`Shape::triangles`]; meshes are used unchanged.
    ///
    /// # Errors
    /// [`GpuError::BufferTooLarge`], [`GpuError::OutOfMemory`].
    pub async fn new(gpu: &Gpu, shape: &Shape, detail: u32) -> Result<Self, GpuError> {
        Self::of_uv_set(gpu, shape, detail, 0).await
    }

    /// Uploads a shape with one of its sets of texture coordinates; a missing set is zero everywhere. Tangents are those of
    /// the first set: place bumps on another one by derivatives.
    ///
    /// # Errors
    /// As [`Geometry::new`].
    pub async fn of_uv_set(gpu: &Gpu, shape: &Shape, detail: u32, uv_set: usize) -> Result<Self, GpuError> {
        let mesh = shape.triangles(detail);
        let vertices = vertices_of(&mesh, uv_set);
        let (vertices, indices): (&[u8], &[u8]) =
            (bytemuck::cast_slice(&vertices), bytemuck::cast_slice(&mesh.indices));
        Ok(Self {
            vertices: upload(gpu, "the vertices of a shape", vertices, wgpu::BufferUsages::VERTEX).await?,
            indices: upload(gpu, "the triangles of a shape", indices, wgpu::BufferUsages::INDEX).await?,
            index_count: mesh.indices.len() as u32,
        })
    }
}

fn vertices_of(mesh: &TriangleMesh, uv_set: usize) -> Vec<f32> {
    let mut vertices = Vec::with_capacity(mesh.positions.len() * FLOATS_A_VERTEX);
    for i in 0..mesh.positions.len() {
        vertices.extend(mesh.positions[i]);
        vertices.extend(mesh.normals[i]);
        vertices.extend(mesh.tangents[i]);
        vertices.extend(mesh.uv_sets.get(uv_set).map_or([0.0; 2], |set| set[i]));
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
