//! Meshes: every real file, their frames, and shapes made of triangles compared with their formulas.

mod common;

use common::{hits, unorthonormality};
use glam::{DVec2, DVec3, Vec3};
use roughcast_io::mesh::load_mesh;
use roughcast_scene::{Hit, Mesh, MeshFault, Ray, Shape, Sphere, Torus, TriangleMesh};
use roughcast_testdata::{available, files_in, find};

/// Every model: file, triangles after applying its nodes, whether it has texture coordinates, whether it has tangents.
const FILES: &[(&str, usize, bool, bool)] = &[
    ("AnisotropyRotationTest.glb", 13876, true, true),
    ("BoomBox/boombox.glb", 6036, true, false),
    ("ClearCoatTest.glb", 37116, true, true),
    ("NormalTangentTest.glb", 7774, true, false),
    ("TwoSidedPlane.glb", 2, true, true),
    ("meshes/bunny_decimated_bgfx.obj", 13654, false, false),
    ("meshes/cube_bgfx.obj", 12, true, false),
    ("meshes/teapot_keijiro.obj", 3218, true, false),
    ("plastic_chair/plastic_monobloc_chair_01_1k.gltf", 3356, true, false),
    ("portal.glb", 2890, true, true),
];

/// Files whose tangents have the opposite handedness to their texture coordinates: bitangents point along growing v.
/// They are used unchanged, since glTF lets the file decide; they also show that the comparisons below can fail.
const OTHER_HANDED: &[&str] = &["TwoSidedPlane.glb", "portal.glb"];

/// Rounding of products of unit vectors.
const ORTHONORMAL: f64 = 1e-12;

fn model(name: &str) -> Mesh {
    load_mesh(find(&format!("models/{name}"))).unwrap_or_else(|error| panic!("{error}"))
}

/// The models whose files exist.
fn files() -> Vec<(&'static str, usize, bool, bool)> {
    FILES.iter().copied().filter(|row| available(&format!("models/{}", row.0)).is_some()).collect()
}

fn shape(mesh: Mesh) -> Shape {
    Shape::Mesh(mesh.into())
}

#[test]
fn the_table_names_every_model() {
    let is_model = |path: &String| ["obj", "gltf", "glb"].iter().any(|ending| path.ends_with(ending));
    let mut found = files_in("models");
    found.retain(is_model);
    assert_eq!(found, files().iter().map(|f| format!("models/{}", f.0)).collect::<Vec<_>>());
}

#[test]
fn every_model_loads_and_is_hit() {
    for &(name, stated, has_uv, _) in &files() {
        let mesh = model(name);
        let count = mesh.triangle_count();
        // Triangles without an area are dropped.
        assert!(count <= stated && count as f64 > 0.9 * stated as f64, "{name}: {count} of {stated}");
        assert_eq!(mesh.has_texture_coordinates(), has_uv, "{name}");
        check_vertices(name, mesh.triangles());
        let shape = shape(mesh);
        let hits = hits(&shape, 4_000);
        assert!(hits.len() > 80, "{name}: {} hits", hits.len());
        for (ray, hit) in &hits {
            assert!(unorthonormality(hit) < ORTHONORMAL, "{name}");
            assert!(hit.geometric_normal.dot(ray.direction) <= 0.0, "{name}");
            let on_ray = ray.origin + ray.direction * hit.distance;
            assert!(on_ray.distance(hit.position) < 1e-12 * hit.distance, "{name}");
            assert!(hit.dpdu(0).is_finite() && hit.dpdv(0).is_finite() && hit.uv(0).is_finite());
            if !has_uv {
                assert_eq!((hit.uv(0), hit.dpdu(0), hit.dpdv(0)), (DVec2::ZERO, DVec3::ZERO, DVec3::ZERO));
            }
        }
    }
}

fn check_vertices(name: &str, mesh: &TriangleMesh) {
    let vertices = mesh.positions.len();
    assert!(
        mesh.normals.len() == vertices
            && mesh.tangents.len() == vertices
            && mesh.uv_sets.iter().all(|set| set.len() == vertices)
    );
    assert!(mesh.indices.iter().all(|&i| (i as usize) < vertices), "{name}");
    for (&normal, &[x, y, z, w]) in mesh.normals.iter().zip(&mesh.tangents) {
        let (normal, tangent) = (Vec3::from(normal), Vec3::new(x, y, z));
        assert!((normal.length() - 1.0).abs() < 1e-6 && (tangent.length() - 1.0).abs() < 1e-6, "{name}");
        assert!(normal.dot(tangent).abs() < 1e-6 && w.abs() == 1.0, "{name}");
    }
}

/// The fraction of the hits whose tangent and bitangent point towards growing u and falling v; from behind, away from
/// them.
fn agreement_with_uv(hits: &[(Ray, Hit<'_>)]) -> f64 {
    let mapped: Vec<_> = hits.iter().filter(|(_, h)| h.dpdu(0) != DVec3::ZERO).collect();
    let agreeing = mapped.iter().filter(|(_, h)| {
        h.dpdu(0).dot(h.frame.tangent()).signum() == -h.dpdv(0).dot(h.frame.bitangent()).signum()
    });
    agreeing.count() as f64 / mapped.len() as f64
}

#[test]
fn frames_follow_the_texture_coordinates() {
    for &(name, ..) in files().iter().filter(|f| f.2) {
        // MikkTSpace averages over vertices, so at folds of a map a few points may have the opposite orientation.
        let agreement = agreement_with_uv(&hits(&shape(model(name)), 4_000));
        println!("{name}: {agreement}");
        assert!(
            if OTHER_HANDED.contains(&name) { agreement == 0.0 } else { agreement > 0.98 },
            "{name}: {agreement}"
        );
    }
}

#[test]
fn tangents_of_files_agree_with_mikktspace() {
    for &(name, ..) in files().iter().filter(|f| f.3) {
        let given = model(name);
        let bare = TriangleMesh { tangents: Vec::new(), ..given.triangles().clone() };
        let made = shape(Mesh::new(vec![bare]).unwrap());
        let given = shape(given);
        let (mut agreeing, mut all) = (0, 0);
        for (ray, hit) in hits(&given, 4_000) {
            let other = made.hit(&ray).unwrap();
            assert_eq!(other.position, hit.position);
            let same = |a: DVec3, b: DVec3| a.dot(b) > 0.99;
            all += 1;
            agreeing += usize::from(
                same(other.frame.tangent(), hit.frame.tangent())
                    && same(other.frame.bitangent(), hit.frame.bitangent()),
            );
        }
        // Exporters may round, weld or split vertices differently.
        let share = f64::from(agreeing as u32) / f64::from(all);
        println!("{name}: {share}");
        assert!(if OTHER_HANDED.contains(&name) { share < 0.2 } else { share > 0.95 }, "{name}: {share}");
    }
}

#[test]
fn a_tessellated_shape_matches_its_formula() {
    for analytic in [Shape::Sphere(Sphere), Shape::Torus(Torus::default())] {
        let full = analytic.triangles(96);
        let bare = TriangleMesh { normals: Vec::new(), tangents: Vec::new(), ..full.clone() };
        for (what, mesh) in [("given", full), ("computed", bare)] {
            let mesh = shape(Mesh::new(vec![mesh]).unwrap());
            let (mut compared, mut worst_normal, mut worst_tangent) = (0, 0.0_f64, 0.0_f64);
            for (ray, hit) in hits(&analytic, 4_000) {
                let cosine = -hit.geometric_normal.dot(ray.direction);
                // Silhouettes differ, MikkTSpace's tangents turn quickly around poles, and u jumps at the seam.
                let seam = hit.uv(0).x.min(1.0 - hit.uv(0).x) < 0.02;
                if cosine < 0.3 || hit.dpdu(0).length() < 1.0 || seam {
                    continue;
                }
                let other = mesh.hit(&ray).unwrap();
                // Chords of 1/192 turn lie 1.3e-4 of the radius below the arc, those of 1/96 turn 5.4e-4: together
                // 4e-4 on the torus, and more along an inclined ray.
                assert!((other.distance - hit.distance).abs() < 2e-3, "{what}");
                assert!((other.uv(0) - hit.uv(0)).length() < 2e-3, "{what}: {} {}", other.uv(0), hit.uv(0));
                // Differences over a triangle: the second derivatives, at most 2 pi^2, times the triangle's size of
                // 1/96.
                assert!(
                    (other.dpdu(0) - hit.dpdu(0)).length() < 0.25,
                    "{what}: {} {}",
                    other.dpdu(0),
                    hit.dpdu(0)
                );
                assert!(
                    (other.dpdv(0) - hit.dpdv(0)).length() < 0.25,
                    "{what}: {} {}",
                    other.dpdv(0),
                    hit.dpdv(0)
                );
                worst_normal = worst_normal.max((other.frame.normal() - hit.frame.normal()).length());
                worst_tangent = worst_tangent.max((other.frame.tangent() - hit.frame.tangent()).length());
                assert!((other.frame.bitangent() - hit.frame.bitangent()).length() < 0.05);
                compared += 1;
            }
            assert!(compared > 500, "{what}: {compared}");
            assert!(worst_normal < 0.01 && worst_tangent < 0.05, "{what}: {worst_normal} {worst_tangent}");
        }
    }
}

/// A unit square in the plane z = 0 that faces +z, with the map either as seen from there or mirrored.
fn square(uvs: [[f32; 2]; 4]) -> TriangleMesh {
    TriangleMesh {
        positions: vec![[0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
        uv_sets: vec![uvs.into()],
        indices: vec![0, 2, 1, 1, 2, 3],
        ..Default::default()
    }
}

const UPRIGHT: [[f32; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
const MIRRORED: [[f32; 2]; 4] = [[1.0, 0.0], [0.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

fn front() -> Ray {
    Ray { origin: DVec3::new(0.25, 0.75, 2.0), direction: DVec3::NEG_Z }
}

#[test]
fn handedness_follows_gltf() {
    for (uvs, tangent, w, u) in [(UPRIGHT, DVec3::X, 1.0, 0.25), (MIRRORED, DVec3::NEG_X, -1.0, 0.75)] {
        let mesh = Mesh::new(vec![square(uvs)]).unwrap();
        assert!(mesh.triangles().tangents.iter().all(|t| t[3] == w));
        let hit = mesh.hit(&front()).unwrap();
        assert_eq!(hit.uv(0), DVec2::new(u, 0.25));
        assert!((hit.frame.tangent() - tangent).length() < ORTHONORMAL);
        assert!((hit.frame.bitangent() - DVec3::Y).length() < ORTHONORMAL, "falling v is up");
        assert!((hit.frame.normal() - DVec3::Z).length() < ORTHONORMAL);
        assert_eq!((hit.dpdu(0), hit.dpdv(0)), (tangent, DVec3::NEG_Y));
        // From behind all axes are reversed.
        let back = Ray { origin: DVec3::new(0.25, 0.75, -2.0), direction: DVec3::Z };
        let behind = mesh.hit(&back).unwrap();
        assert_eq!(behind.frame.normal(), -hit.frame.normal());
        assert_eq!(behind.frame.tangent(), -hit.frame.tangent());
        assert_eq!(behind.frame.bitangent(), -hit.frame.bitangent());
        assert_eq!(behind.uv(0), hit.uv(0));
    }
}

#[test]
fn the_normals_of_the_file_determine_the_outer_side() {
    let mut inside_out = square(UPRIGHT);
    inside_out.normals = vec![[0.0, 0.0, -1.0]; 4];
    let mesh = Mesh::new(vec![inside_out]).unwrap();
    // Reversed, so that a rasteriser's front faces agree with the normals.
    assert_eq!(mesh.triangles().indices, [0, 1, 2, 1, 3, 2]);
    // Seen from the other side, the map is mirrored.
    assert!(mesh.triangles().tangents.iter().all(|t| t[3] == -1.0));
}

#[test]
fn repeated_triangles_are_dropped_and_backs_are_kept() {
    let mut part = square(UPRIGHT);
    part.indices.extend([2, 1, 0, 2, 3, 1, 0, 1, 2]);
    let mesh = Mesh::new(vec![part]).unwrap();
    assert_eq!(mesh.triangles().indices.len(), 9);
}

#[test]
fn triangles_in_one_place_take_no_more_time() {
    // Different triangles with equal boxes, which a hierarchy splits badly: a faulty hierarchy would take minutes.
    let count = 50_000_u32;
    let aside = |i: u32| i as f32 / count as f32;
    let mut positions = vec![[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]];
    positions.extend((0..count).map(|i| [aside(i), 0.5, 0.5]));
    let tangents = vec![[1.0, 0.0, 0.0, 1.0]; positions.len()];
    let indices = (0..count).flat_map(|i| [0, 1, i + 2]).collect();
    let mesh = Mesh::new(vec![TriangleMesh { positions, tangents, indices, ..Default::default() }]).unwrap();
    // The triangle whose corner is at 0.5 degenerates to a line.
    assert_eq!(mesh.triangle_count(), 49_999);
}

#[test]
fn a_part_without_texture_coordinates_leaves_the_mesh_without() {
    let bare = TriangleMesh { uv_sets: Vec::new(), ..square(UPRIGHT) };
    let mesh = Mesh::new(vec![square(UPRIGHT), bare]).unwrap();
    assert!(!mesh.has_texture_coordinates());
    let hit = mesh.hit(&front()).unwrap();
    assert_eq!((hit.uv(0), hit.dpdu(0), hit.dpdv(0)), (DVec2::ZERO, DVec3::ZERO, DVec3::ZERO));
    assert!(unorthonormality(&hit) < ORTHONORMAL);
}

#[test]
fn constant_texture_coordinates_have_no_footprint() {
    let mesh = Mesh::new(vec![square([[0.5, 0.5]; 4])]).unwrap();
    let hit = mesh.hit(&front()).unwrap();
    assert_eq!((hit.dpdu(0), hit.dpdv(0)), (DVec3::ZERO, DVec3::ZERO));
    assert!(unorthonormality(&hit) < ORTHONORMAL);
    let aside = Ray { direction: DVec3::new(0.1, 0.0, -1.0).normalize(), ..front() };
    assert_eq!(hit.footprint(0, &aside, &aside).dx, DVec2::ZERO);
}

#[test]
fn impossible_parts_are_refused() {
    let whole = TriangleMesh {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        indices: vec![0, 1, 2],
        ..Default::default()
    };
    assert!(Mesh::new(vec![whole.clone()]).is_ok());
    let broken = |edit: fn(&mut TriangleMesh)| {
        let mut part = whole.clone();
        edit(&mut part);
        Mesh::new(vec![part]).unwrap_err()
    };
    assert!(matches!(Mesh::new(vec![]), Err(MeshFault::NoTriangles)));
    assert!(matches!(broken(|p| p.indices.clear()), MeshFault::NoTriangles));
    assert!(matches!(broken(|p| p.indices.push(0)), MeshFault::Count { .. }));
    assert!(matches!(broken(|p| p.indices[2] = 3), MeshFault::IndexOutOfRange { index: 3, vertices: 3 }));
    assert!(matches!(broken(|p| p.normals.push([0.0; 3])), MeshFault::Count { .. }));
    assert!(matches!(
        broken(|p| p.uv_sets = vec![vec![[f32::NAN; 2]; 3]]),
        MeshFault::NotFinite { vertex: 0, .. }
    ));
    assert!(matches!(broken(|p| p.positions[1] = [1e20, 0.0, 0.0]), MeshFault::Size { .. }));
}
