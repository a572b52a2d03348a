//! Normals that a mesh does not have, and poses of a mesh that deforms.

mod common;

use std::collections::HashMap;

use common::{hits, unorthonormality};
use glam::{DVec3, Vec3};
use roughcast_scene::{Hit, Mesh, MeshFault, NormalKind, NormalSource, Ray, Shape, Torus, TriangleMesh};

/// Rounding of normals to single floats, and of the positions that they are computed from.
const SINGLE: f64 = 3e-7;
/// Rounding of products of unit vectors.
const ORTHONORMAL: f64 = 1e-12;

/// A cube from -1 to 1 whose eight vertices are shared by its faces, without normals. Its texture coordinates are not those
/// of an unwrapped cube, but every triangle has an area in them.
fn cube() -> TriangleMesh {
    let corner = |i: u32| [i & 1, i >> 1 & 1, i >> 2 & 1].map(|bit| 2.0 * bit as f32 - 1.0);
    let positions: Vec<[f32; 3]> = (0..8).map(corner).collect();
    // The four corners of each face, counter-clockwise as seen from outside.
    let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let indices = faces.iter().flat_map(|&[a, b, c, d]| [a, b, c, a, c, d]).collect();
    let uvs = positions.iter().map(|&[x, y, z]| [0.5 * x + 0.2 * z, 0.5 * y - 0.3 * z]).collect();
    TriangleMesh { positions, uv_sets: vec![uvs], indices, ..Default::default() }
}

fn mesh_with(part: TriangleMesh, source: NormalSource) -> Shape {
    Shape::Mesh(Mesh::with_normals(vec![part], source).expect("a mesh").into())
}

/// The largest difference between the normals that shade a shape and those of its triangles.
fn away_from_flat(shape: &Shape) -> f64 {
    let hits = hits(shape, 2_000);
    assert!(hits.len() > 300, "{}", hits.len());
    hits.iter().map(|(_, hit)| (hit.frame.normal() - hit.geometric_normal).length()).fold(0.0, f64::max)
}

fn triangles(shape: &Shape) -> &TriangleMesh {
    let Shape::Mesh(mesh) = shape else { panic!("not a mesh") };
    mesh.triangles()
}

#[test]
fn a_cube_without_normals_is_flat_or_smooth_as_asked() {
    let flat = mesh_with(cube(), NormalSource::GivenOr(NormalKind::Flat));
    assert!(away_from_flat(&flat) < SINGLE, "{}", away_from_flat(&flat));
    // Each face of a cube has one normal, and the map on it one frame: four vertices a face, not six.
    let normals_only = TriangleMesh { uv_sets: Vec::new(), ..cube() };
    let bare = mesh_with(normals_only, NormalSource::GivenOr(NormalKind::Flat));
    let faces: HashMap<_, usize> =
        triangles(&bare).normals.iter().fold(HashMap::new(), |mut faces, normal| {
            *faces.entry(normal.map(|x| x as i32)).or_default() += 1;
            faces
        });
    assert!(faces.len() == 6 && faces.values().all(|&vertices| vertices >= 4), "{faces:?}");

    let smooth = mesh_with(cube(), NormalSource::GivenOr(NormalKind::Smooth));
    assert_eq!(triangles(&smooth), Mesh::new(vec![cube()]).expect("a mesh").triangles());
    for (p, n) in triangles(&smooth).positions.iter().zip(&triangles(&smooth).normals) {
        let diagonal = Vec3::from(*p).normalize();
        // The triangles at a corner cut its three faces unequally.
        assert!(Vec3::from(*n).dot(diagonal) > 0.9, "{n:?} at {p:?}");
    }
    // The comparison can fail.
    assert!(away_from_flat(&smooth) > 0.5);
}

#[test]
fn splitting_keeps_the_surface_and_its_texture() {
    let [flat, smooth] =
        [NormalKind::Flat, NormalKind::Smooth].map(|kind| mesh_with(cube(), NormalSource::GivenOr(kind)));
    for (ray, hit) in hits(&smooth, 2_000) {
        let other = flat.hit(&ray).expect("the same surface");
        assert_eq!((other.position, other.uv(0)), (hit.position, hit.uv(0)));
        assert_eq!((other.dpdu(0), other.dpdv(0)), (hit.dpdu(0), hit.dpdv(0)));
        assert!(unorthonormality(&other) < ORTHONORMAL);
        check_tangent(&other);
        assert_eq!((other.dnds, other.dndt), (DVec3::ZERO, DVec3::ZERO), "a facet has no curvature");
    }
}

/// MikkTSpace's tangent points along growing u. Nothing is averaged, since the cube's texture coordinates are linear in
/// space, and so the triangles of a face agree.
fn check_tangent(hit: &Hit<'_>) {
    /// Rounding of MikkTSpace, which computes in single floats.
    const TANGENT: f64 = 1e-6;
    let wanted = hit.dpdu(0).normalize();
    assert!((hit.frame.tangent() - wanted).length() < TANGENT, "{} {wanted}", hit.frame.tangent());
}

#[test]
fn computed_normals_replace_given_ones_and_their_tangents() {
    let torus = Shape::Torus(Torus::default()).triangles(12);
    let given = mesh_with(torus.clone(), NormalSource::GivenOr(NormalKind::Flat));
    assert_eq!(triangles(&given).indices.len(), torus.indices.len());
    assert_eq!(triangles(&given).normals.len(), torus.normals.len(), "nothing was missing");
    assert!(away_from_flat(&given) > 0.1);
    let flat = mesh_with(torus.clone(), NormalSource::Computed(NormalKind::Flat));
    assert!(away_from_flat(&flat) < SINGLE, "{}", away_from_flat(&flat));
    let bare = TriangleMesh { normals: Vec::new(), tangents: Vec::new(), ..torus.clone() };
    let smooth = mesh_with(torus.clone(), NormalSource::Computed(NormalKind::Smooth));
    assert_eq!(triangles(&smooth), triangles(&mesh_with(bare.clone(), NormalSource::default())));

    // Tangents without normals are ignored where facets are wanted.
    let odd = TriangleMesh { tangents: vec![[0.6, 0.8, 0.0, -1.0]; bare.positions.len()], ..bare.clone() };
    let facets = |part| mesh_with(part, NormalSource::GivenOr(NormalKind::Flat));
    assert_eq!(triangles(&facets(odd)), triangles(&facets(bare)));
}

#[test]
fn given_normals_decide_the_outer_side_of_computed_ones() {
    let mut inside_out = Shape::Torus(Torus::default()).triangles(12);
    inside_out.normals.iter_mut().flatten().for_each(|x| *x = -*x);
    let flat = mesh_with(inside_out, NormalSource::Computed(NormalKind::Flat));
    let outside = hits(&flat, 500);
    assert!(outside.iter().any(|(_, hit)| hit.side == roughcast_scene::Side::Back));
    for triangle in triangles(&flat).indices.chunks_exact(3) {
        let normal = Vec3::from(triangles(&flat).normals[triangle[0] as usize]);
        let [a, b, c] = [0, 1, 2].map(|i| Vec3::from(triangles(&flat).positions[triangle[i] as usize]));
        assert!((b - a).cross(c - a).dot(normal) > 0.0, "the winding and the normal disagree");
    }
}

#[test]
fn only_vertices_without_normals_become_flat() {
    let whole = Shape::Torus(Torus::default()).triangles(8);
    let bare = TriangleMesh { normals: Vec::new(), ..cube() };
    let mesh = Mesh::with_normals(vec![whole.clone(), bare], NormalSource::GivenOr(NormalKind::Flat));
    let mesh = mesh.expect("a mesh");
    let given = whole.positions.len();
    for (got, wanted) in mesh.triangles().normals[..given].iter().zip(&whole.normals) {
        assert!((Vec3::from(*got) - Vec3::from(*wanted)).length() < SINGLE as f32);
    }
    for normal in &mesh.triangles().normals[given..] {
        let longest = Vec3::from(*normal).abs().max_element();
        assert!((longest - 1.0).abs() < SINGLE as f32, "not a face of the cube: {normal:?}");
    }
}

/// A torus at rest and the positions and normals of a pose twice as high.
fn stretched() -> (Mesh, Vec<[f32; 3]>, Vec<[f32; 3]>) {
    let rest = Mesh::new(vec![Shape::Torus(Torus::default()).triangles(24)]).expect("a mesh");
    let vertices = rest.triangles();
    let positions = vertices.positions.iter().map(|&[x, y, z]| [x, 2.0 * y, z]).collect();
    let normals = vertices.normals.iter().map(|&[x, y, z]| [x, 0.5 * y, z]).collect();
    (rest, positions, normals)
}

#[test]
fn a_pose_has_the_surface_and_the_texture_of_a_new_mesh() {
    let (rest, positions, normals) = stretched();
    let part = TriangleMesh {
        positions: positions.clone(),
        normals: normals.clone(),
        tangents: Vec::new(),
        ..rest.triangles().clone()
    };
    let new = Shape::Mesh(Mesh::new(vec![part]).expect("a mesh").into());
    let pose = rest.deformed(positions, normals).expect("a pose");
    assert_eq!((pose.triangle_count(), pose.uv_set_count()), (rest.triangle_count(), 1));
    assert_eq!(pose.triangles().indices, rest.triangles().indices);
    let pose = Shape::Mesh(pose.into());
    let mut turned = 0.0_f64;
    for (ray, hit) in hits(&new, 2_000) {
        let other = pose.hit(&ray).expect("the same surface");
        assert_eq!(
            (other.position, other.frame.normal(), other.side),
            (hit.position, hit.frame.normal(), hit.side)
        );
        assert_eq!((other.dnds, other.dndt, other.uv(0)), (hit.dnds, hit.dndt, hit.uv(0)));
        assert!(unorthonormality(&other) < ORTHONORMAL);
        turned = turned.max((other.frame.tangent() - hit.frame.tangent()).length());
    }
    assert_eq!(pose.bounds(), new.bounds());
    // A stretch along y hardly turns the torus' own tangents, which lie in the plane.
    assert!(turned < 0.2, "{turned}");
}

#[test]
fn tangents_of_a_pose_are_those_at_rest_made_perpendicular() {
    let (rest, positions, normals) = stretched();
    let pose = rest.deformed(positions, normals).expect("a pose");
    let (rest, pose) = (rest.triangles(), pose.triangles());
    for (i, &[x, y, z, w]) in pose.tangents.iter().enumerate() {
        let (tangent, normal) = (Vec3::new(x, y, z), Vec3::from(pose.normals[i]));
        assert!(
            tangent.dot(normal).abs() < SINGLE as f32 && tangent.is_normalized() && normal.is_normalized()
        );
        let [x, y, z, old_w] = rest.tangents[i];
        let wanted = Vec3::new(x, y, z).reject_from_normalized(normal).normalize();
        assert!((tangent - wanted).length() < 1e-6 && w == old_w);
    }
}

#[test]
fn a_pose_that_flattens_triangles_has_no_nan() {
    let (rest, _, normals) = stretched();
    let flat = rest.triangles().positions.iter().map(|&[x, _, z]| [x, 0.0, z]).collect();
    let pose = Shape::Mesh(rest.deformed(flat, normals).expect("a pose").into());
    let mut count = 0;
    for (_, hit) in hits(&pose, 2_000) {
        let all = [hit.position, hit.geometric_normal, hit.frame.tangent(), hit.frame.normal(), hit.dpdu(0)];
        assert!(all.iter().all(|vector| vector.is_finite()), "{hit:?}");
        count += 1;
    }
    assert!(count > 100, "{count}");
    // All vertices of a triangle on a line: a ray through it sees nothing, or a finite frame.
    let line = rest.triangles().positions.iter().map(|&[x, _, _]| [x, 0.0, 0.0]).collect();
    let pose = rest.deformed(line, vec![[0.0; 3]; rest.triangles().positions.len()]).expect("a pose");
    let ray = Ray { origin: DVec3::new(0.9, 1.0, 0.0), direction: DVec3::NEG_Y };
    assert!(
        pose.hit(&ray).is_none_or(|hit| hit.frame.normal().is_finite() && hit.geometric_normal.is_finite())
    );
}

#[test]
fn impossible_poses_are_refused() {
    let (rest, positions, normals) = stretched();
    assert!(rest.deformed(positions.clone(), normals.clone()).is_ok());
    let vertices = positions.len();
    let fault = |edit: fn(&mut Vec<[f32; 3]>, &mut Vec<[f32; 3]>)| {
        let (mut positions, mut normals) = (positions.clone(), normals.clone());
        edit(&mut positions, &mut normals);
        rest.deformed(positions, normals).expect_err("not a pose")
    };
    let count = |what, count| MeshFault::PoseCount { what, count, vertices };
    assert_eq!(fault(|p, _| p.truncate(p.len() - 1)), count("positions", vertices - 1));
    assert_eq!(fault(|_, n| n.clear()), count("normals", 0));
    let invalid = |what, vertex| MeshFault::PoseNotFinite { what, vertex };
    assert_eq!(fault(|p, _| p[3][1] = f32::NAN), invalid("positions", 3));
    assert_eq!(fault(|_, n| n[5] = [f32::INFINITY; 3]), invalid("normals", 5));
    assert!(matches!(fault(|p, _| p.fill([1.0; 3])), MeshFault::Size { .. }));
    assert!(matches!(fault(|p, _| p[0] = [1e20, 0.0, 0.0]), MeshFault::Size { .. }));
}
