//! A mesh that deforms from frame to frame without new tangents.

use std::sync::Arc;

use glam::DVec3;
use roughcast::SampleType;
use roughcast::shading::Shading;
use roughcast_gpu::GpuError;
use roughcast_gpu::render::{Geometry, GpuDetail, RenderTarget, Renderer, render};
use roughcast_scene::{BakedTextures, Mesh, Placement, Shape, TangentSource, Torus, TriangleMesh, View};

use super::common::drawn::by_cpu;
use super::common::gpu;
use super::common::scenes::{SIZE, maps, scene};
use super::{OTHERS, PLACED, compared, draw, sampler};

/// The torus at rest, and twisted about the y axis and stretched by an amount.
fn pose(rest: &TriangleMesh, amount: f64) -> TriangleMesh {
    let twisted = |p: DVec3| {
        let (sin, cos) = (amount * p.x).sin_cos();
        DVec3::new(p.x * (1.0 + 0.3 * amount), cos * p.y - sin * p.z, sin * p.y + cos * p.z)
    };
    let mut mesh = rest.clone();
    for (position, normal) in mesh.positions.iter_mut().zip(&mut mesh.normals) {
        const STEP: f64 = 1e-4;
        let (p, n) = (DVec3::from(position.map(f64::from)), DVec3::from(normal.map(f64::from)));
        let [s, t] = [n.any_orthonormal_vector(), n.cross(n.any_orthonormal_vector())]
            .map(|v| (twisted(p + STEP * v) - twisted(p - STEP * v)) / (2.0 * STEP));
        *position = twisted(p).as_vec3().to_array();
        *normal = s.cross(t).normalize().as_vec3().to_array();
    }
    mesh
}

#[test]
fn bumps_follow_a_deforming_mesh_whose_tangents_stay_behind() {
    let arrays = maps(Shading::Lean, SampleType::F16);
    let textures = BakedTextures::of_model(Shading::Lean, &arrays).expect("its own textures");
    let placement = Placement::default().with_tangent_source(TangentSource::Derivatives);
    let rest = Shape::Torus(Torus::default()).triangles(128);
    let gpu = gpu();
    pollster::block_on(async {
        let shape = Shape::Mesh(Arc::new(Mesh::new(vec![rest.clone()]).expect("a mesh")));
        let detail = GpuDetail::of_model(&gpu, Shading::Lean, &arrays).await?;
        let mut renderer = Renderer::new(&gpu, RenderTarget::Parts).await?;
        let geometry = Geometry::new(&gpu, &shape, 0).await?;
        // The vertices as the mesh keeps them, in its order.
        let Shape::Mesh(mesh) = &shape else { panic!("a mesh") };
        let uploaded = mesh.triangles().clone();
        let mut without = renderer.prepare(&geometry, &detail.clone().placed(placement), &draw()).await?;
        let mut stale = renderer.prepare(&geometry, &detail, &draw()).await?;
        for amount in [0.0, 0.8, 1.5] {
            let pose = pose(&uploaded, amount);
            geometry.deform(&gpu, &pose)?;
            let posed = Mesh::new(vec![pose]).expect("a mesh");
            let mut scene = scene(Shape::Mesh(Arc::new(posed)), View::Mid);
            scene.repeats = 6.0;
            let here = by_cpu(&scene, Shading::Lean, &textures.sampled(sampler()).placed(placement));
            let there = render(&renderer, &mut without, &scene, SIZE).await?;
            let same = compared(&here, &there);
            assert!(same.mean < PLACED && same.covered > 1000, "{amount}: {same:?}");
            // With the tangents of the rest pose, bumps are turned.
            let stale = render(&renderer, &mut stale, &scene, SIZE).await?;
            let turned = compared(&here, &stale).mean;
            assert!(amount == 0.0 || turned > OTHERS * PLACED, "{amount}: {turned}");
        }
        Ok::<(), GpuError>(())
    })
    .expect("pictures");
}

#[test]
fn a_pose_of_another_mesh_is_refused() {
    let gpu = gpu();
    pollster::block_on(async {
        let torus = Shape::Torus(Torus::default());
        let geometry = Geometry::new(&gpu, &torus, 16).await.expect("it is small");
        let finer = torus.triangles(17);
        let wanted = torus.triangles(16).positions.len() as u64;
        let got = finer.positions.len() as u64;
        assert_eq!(geometry.deform(&gpu, &finer), Err(GpuError::OtherVertices { wanted, got }));
        assert_eq!(geometry.deform(&gpu, &torus.triangles(16)), Ok(()));
    });
}
