//! Frames of slopes on sheared, stretched and mirrored surfaces, compared with the displaced surfaces themselves.

mod common;

use std::sync::Arc;

use common::{Numbers, hits};
use glam::{DVec2, DVec3};
use roughcast::shading::{Material, Shading, ShadingOptions};
use roughcast::{Bake, BakeOptions, Moments, SampleType, Slope};
use roughcast_scene::render::{Method, unwatched};
use roughcast_scene::{
    BakedTextures, Camera, Filter, Hit, Light, Mesh, Picture, Placement, Plane, Ray, Sampler, Scene, Shape,
    SlopeFrame, Sphere, Torus, TriangleMesh, UvPoint, UvSets, pattern,
};

/// Slopes and matrices are single floats: a few roundings of values up to a few units.
const SINGLE: f64 = 2e-6;

/// The size of these tests' texture, and the height of one texel of its heights.
const TEXELS: (usize, usize) = (64, 32);
const WORLD_HEIGHT: f64 = 0.04;

/// Heights in texels over texels (x right, y up), and the slope there: minus the gradient.
fn height(at: DVec2) -> f64 {
    1.5 * (0.3 * at.x + 0.2 * at.y + 0.4).sin() + 0.4 * (0.15 * at.x - 0.5 * at.y).cos()
}

fn stored_slope(at: DVec2) -> Slope {
    let (a, b) = ((0.3 * at.x + 0.2 * at.y + 0.4).cos(), (0.15 * at.x - 0.5 * at.y).sin());
    let gradient = DVec2::new(1.5 * 0.3 * a - 0.4 * 0.15 * b, 1.5 * 0.2 * a + 0.4 * 0.5 * b);
    Slope { x: -gradient.x as f32, y: -gradient.y as f32 }
}

fn texel_of(uv: DVec2) -> DVec2 {
    DVec2::new(TEXELS.0 as f64 * uv.x, -(TEXELS.1 as f64) * uv.y)
}

/// A parallelogram with a corner at `origin` and sides `along_a` and `along_b`, and with two affine sets of texture
/// coordinates: `uv = offset + columns * (a, b)`.
#[derive(Clone, Copy, Debug)]
struct Quad {
    origin: DVec3,
    along_a: DVec3,
    along_b: DVec3,
    uv_sets: [[DVec2; 3]; 2],
}

impl Quad {
    /// The unit square in the plane z = 0, with the map upright in one set and turned, sheared and stretched in the
    /// other.
    fn square() -> Self {
        Self {
            origin: DVec3::ZERO,
            along_a: DVec3::X,
            along_b: DVec3::Y,
            uv_sets: [
                [DVec2::Y, DVec2::X, DVec2::NEG_Y],
                [DVec2::new(0.3, 0.1), DVec2::new(0.7, -0.4), DVec2::new(0.9, 1.3)],
            ],
        }
    }

    fn sheared() -> Self {
        let along_b = DVec3::new(0.9, 1.1, -0.5);
        Self {
            origin: DVec3::new(0.1, -0.3, 0.2),
            along_a: DVec3::new(1.7, 0.2, 0.4),
            along_b,
            ..Self::square()
        }
    }

    /// The quad with u growing in the opposite direction.
    fn mirrored(self) -> Self {
        let mirror = |[offset, a, b]: [DVec2; 3]| {
            let flip = DVec2::new(-1.0, 1.0);
            [offset * flip + DVec2::X, a * flip, b * flip]
        };
        Self { uv_sets: self.uv_sets.map(mirror), ..self }
    }

    /// The quad's mirror image in the plane x = 0.
    fn reflected(self) -> Self {
        let Self { origin, along_a, along_b, .. } = self;
        Self { origin: reflect(origin), along_a: reflect(along_a), along_b: reflect(along_b), ..self }
    }

    fn normal(&self) -> DVec3 {
        let normal = self.along_a.cross(self.along_b).normalize();
        // Towards +z, which the reflection preserves.
        normal * normal.z.signum()
    }

    fn point(&self, at: DVec2) -> DVec3 {
        self.origin + self.along_a * at.x + self.along_b * at.y
    }

    fn uv(&self, set: usize, at: DVec2) -> DVec2 {
        let [offset, a, b] = self.uv_sets[set];
        offset + a * at.x + b * at.y
    }

    fn mesh(&self) -> Shape {
        let corners = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE];
        let mesh = TriangleMesh {
            positions: corners.map(|at| self.point(at).as_vec3().into()).into(),
            normals: vec![self.normal().as_vec3().into(); 4],
            uv_sets: (0..2).map(|set| corners.map(|at| self.uv(set, at).as_vec2().into()).into()).collect(),
            indices: vec![0, 1, 2, 2, 1, 3],
            ..Default::default()
        };
        Shape::Mesh(Arc::new(Mesh::new(vec![mesh]).expect("a mesh")))
    }

    /// The hit on the mesh from its front or from behind.
    fn hit<'a>(&self, mesh: &'a Shape, at: DVec2, from: f64) -> Hit<'a> {
        let origin = self.point(at) + self.normal() * from;
        let ray = Ray { origin, direction: -self.normal() * from.signum() };
        mesh.hit(&ray).expect("the quad")
    }

    /// The normal of the surface displaced by the heights of a texture on a set, by central differences.
    fn displaced_normal(&self, set: usize, at: DVec2) -> DVec3 {
        // The error is its square times third derivatives of 64^3 * 0.3^3 * 0.04.
        const STEP: f64 = 1e-6;
        let displaced =
            |at: DVec2| self.point(at) + self.normal() * WORLD_HEIGHT * height(texel_of(self.uv(set, at)));
        let along = |axis: DVec2| displaced(at + axis * STEP) - displaced(at - axis * STEP);
        let normal = along(DVec2::X).cross(along(DVec2::Y)).normalize();
        normal * normal.dot(self.normal()).signum()
    }
}

fn reflect(v: DVec3) -> DVec3 {
    v * DVec3::new(-1.0, 1.0, 1.0)
}

/// On the first set, with this world height per texel.
fn of_height(texels: (usize, usize), repeats: f64, height: f64) -> SlopeFrame {
    SlopeFrame::new(texels, repeats, Placement::default().with_world_height_per_texel(height))
}

fn frame(set: usize) -> SlopeFrame {
    SlopeFrame::new(
        TEXELS,
        1.0,
        Placement::default().with_uv_set(set).with_world_height_per_texel(WORLD_HEIGHT),
    )
}

/// The normal that a slope gives in the frame of a hit, in world space.
fn world_normal(hit: &Hit<'_>, slope: Slope) -> DVec3 {
    hit.frame.world_from_tangent(DVec3::new(f64::from(slope.x), f64::from(slope.y), 1.0)).normalize()
}

fn quads() -> [Quad; 6] {
    let (square, sheared) = (Quad::square(), Quad::sheared());
    [
        square,
        sheared,
        square.mirrored(),
        sheared.mirrored(),
        sheared.reflected(),
        sheared.mirrored().reflected(),
    ]
}

/// Points away from the corners, and from the edge that the triangles share.
fn points() -> [DVec2; 4] {
    [(0.2, 0.3), (0.55, 0.25), (0.8, 0.7), (0.35, 0.9)].map(|(a, b)| DVec2::new(a, b))
}

#[test]
fn slopes_of_a_texture_give_the_normal_of_the_displaced_surface() {
    let mut ignored_stretch = 0.0_f64;
    for quad in quads() {
        for (at, set) in points().into_iter().flat_map(|at| [(at, 0), (at, 1)]) {
            let wanted = quad.displaced_normal(set, at);
            for from in [1.0, -1.0] {
                let mesh = quad.mesh();
                let hit = quad.hit(&mesh, at, from);
                let stored = stored_slope(texel_of(hit.uv(set)));
                let normal = world_normal(&hit, stored.transformed(frame(set).matrix(&hit)));
                // A bump from the front is a dent from behind.
                assert!(
                    (normal - wanted * from).length() < SINGLE,
                    "{quad:?} {set} {from}: {normal} {wanted}"
                );
                ignored_stretch = ignored_stretch.max((world_normal(&hit, stored) - wanted * from).length());
            }
        }
    }
    // The comparison can fail: it does without the frame.
    assert!(ignored_stretch > 0.1, "{ignored_stretch}");
}

#[test]
fn on_curved_shapes_slopes_give_the_normal_of_the_displaced_surface() {
    // Curvature has no effect where the height is zero; the heights of this test are zero at the hit, and linear.
    const STEP: f64 = 1e-6;
    // Second derivatives of the shapes, at most 40, times the step.
    const CURVATURE: f64 = 1e-4;
    let slope = Slope { x: 0.4, y: -0.3 };
    for shape in [Shape::Sphere(Sphere), Shape::Torus(Torus::default())] {
        let mut compared = 0;
        for (_, hit) in hits(&shape, 2_000) {
            let side = hit.frame.normal().dot(hit.dpdv(0).cross(hit.dpdu(0))).signum();
            if hit.dpdu(0).length() < 1.0 {
                continue;
            }
            // The surface to first order, displaced along its front normal by heights of this slope.
            let front = hit.frame.normal() * side;
            let change = |d: DVec2| {
                let texels = texel_of(d);
                let height = -f64::from(slope.x) * texels.x - f64::from(slope.y) * texels.y;
                hit.dpdu(0) * d.x + hit.dpdv(0) * d.y + front * (WORLD_HEIGHT * height)
            };
            let displaced = change(DVec2::Y * STEP).cross(change(DVec2::X * STEP)).normalize() * side;
            let normal = world_normal(&hit, slope.transformed(frame(0).matrix(&hit)));
            assert!((normal - displaced).length() < CURVATURE, "{}: {normal} {displaced}", hit.uv(0));
            compared += 1;
        }
        assert!(compared > 200, "{compared}");
    }
}

#[test]
fn moments_transform_like_their_slopes() {
    /// Tolerance for second moments of slopes up to ten.
    const ROUNDING: f32 = 1e-4;
    let mut numbers = Numbers(17);
    let slopes: Vec<Slope> = (0..64)
        .map(|_| Slope { x: numbers.unit() as f32 - 0.3, y: 0.7 * numbers.unit() as f32 - 0.5 })
        .collect();
    let mean = |slopes: &[Slope]| {
        let sum = slopes.iter().fold(Moments::default(), |sum, slope| sum + Moments::of_slope(*slope));
        sum * (1.0 / slopes.len() as f32)
    };
    for quad in quads() {
        for set in [0, 1] {
            let matrix = frame(set).matrix(&quad.hit(&quad.mesh(), points()[0], 1.0));
            let one_by_one: Vec<Slope> = slopes.iter().map(|slope| slope.transformed(matrix)).collect();
            let (a, b) = (mean(&one_by_one), mean(&slopes).transformed(matrix));
            for (a, b) in
                [(a.mean.x, b.mean.x), (a.mean.y, b.mean.y), (a.xx, b.xx), (a.yy, b.yy), (a.xy, b.xy)]
            {
                assert!((a - b).abs() < ROUNDING, "{quad:?} {set}: {a} {b}");
            }
        }
    }
}

fn distance(a: [[f32; 2]; 2], b: [[f32; 2]; 2]) -> f64 {
    let differences = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| f64::from((a - b).abs()));
    differences.fold(0.0, f64::max)
}

#[test]
fn square_texels_with_matching_height_keep_their_slopes() {
    const IDENTITY: [[f32; 2]; 2] = [[1.0, 0.0], [0.0, 1.0]];
    let [quad, mirrored_quad] = [Quad::square(), Quad::square().mirrored()];
    let [mesh, mirrored_mesh] = [quad.mesh(), mirrored_quad.mesh()];
    let square = quad.hit(&mesh, points()[0], 1.0);
    let mirrored = mirrored_quad.hit(&mirrored_mesh, points()[0], 1.0);
    let plane = Shape::Plane(Plane::new(2.5).unwrap());
    let on_plane = plane.hit(&Ray { origin: DVec3::new(0.3, 2.0, 0.1), direction: DVec3::NEG_Y }).unwrap();
    for (hit, width) in [(square, 1.0), (mirrored, 1.0), (on_plane, 5.0)] {
        for repeats in [1.0, 3.0] {
            let lies = of_height((64, 64), repeats, width / (64.0 * repeats));
            assert!(distance(lies.matrix(&hit), IDENTITY) < SINGLE, "{:?}", lies.matrix(&hit));
        }
        // Without a height it is the identity for any stretch.
        assert_eq!(SlopeFrame::new((64, 7), 2.5, Placement::default()).matrix(&hit), IDENTITY);
        // Twice as high is twice as steep; half as many rows along v are half as steep along it.
        let lies = of_height((64, 32), 1.0, 2.0 * width / 64.0);
        assert!(distance(lies.matrix(&hit), [[2.0, 0.0], [0.0, 1.0]]) < SINGLE);
    }
}

#[test]
fn degenerate_parametrizations_are_flat() {
    const FLAT: [[f32; 2]; 2] = [[0.0; 2]; 2];
    let mesh = Quad::sheared().mesh();
    let hit = Quad::sheared().hit(&mesh, points()[0], 1.0);
    let point = hit.uv_sets.get(0);
    let [no_derivatives, unknown, huge, line] = [
        UvPoint { ds: DVec2::ZERO, dt: DVec2::ZERO, ..point },
        UvPoint { ds: DVec2::NAN, ..point },
        UvPoint { ds: DVec2::splat(1e200), ..point },
        UvPoint { ds: DVec2::new(0.5, 0.0), dt: DVec2::ZERO, ..point },
    ]
    .map(|point| [point]);
    let with = |points| Hit { uv_sets: UvSets::of_points(points), ..hit };
    for flat in [
        Hit { uv_sets: UvSets::default(), ..hit },
        with(&no_derivatives),
        Hit { dpds: DVec3::ZERO, ..hit },
        Hit { dpdt: hit.dpds * 2.0, ..hit },
        with(&unknown),
        with(&huge),
    ] {
        assert_eq!(frame(0).matrix(&flat), FLAT, "{flat:?}");
    }
    for height in [0.0, f64::NAN, f64::INFINITY] {
        assert_eq!(distance(of_height(TEXELS, 1.0, height).matrix(&hit), FLAT), 0.0);
    }
    // Texture coordinates on a line are valid: heights change along it, and the slope is that of the surface.
    let line = with(&line);
    let slope = Slope { x: 0.4, y: 9.0 }.transformed(frame(0).matrix(&line));
    let rise =
        -world_normal(&line, slope).dot(line.dpds) / world_normal(&line, slope).dot(line.frame.normal());
    let wanted = -0.4 * 0.5 * TEXELS.0 as f64 * WORLD_HEIGHT;
    assert!((rise - wanted).abs() < SINGLE, "{rise} {wanted}");
    // The pole of a sphere.
    let pole = Shape::Sphere(Sphere).hit(&Ray { origin: DVec3::Y * 3.0, direction: DVec3::NEG_Y }).unwrap();
    assert!(frame(0).matrix(&pole).iter().flatten().all(|entry| entry.is_finite()));
}

#[test]
fn every_set_has_its_own_derivatives_and_footprint() {
    /// Rounding of positions in single floats.
    const ROUNDING: f64 = 1e-6;
    let quad = Quad::sheared();
    let mesh = quad.mesh();
    let hit = quad.hit(&mesh, points()[1], 1.0);
    assert_eq!(hit.uv_sets.len(), 2);
    let aside = |offset: DVec3| {
        let origin = hit.position + quad.normal();
        Ray { origin, direction: (offset - quad.normal()).normalize() }
    };
    // A pixel that spans a tenth of each side.
    let (dx, dy) = (aside(quad.along_a * 0.1), aside(quad.along_b * 0.1));
    for (set, [_, a, b]) in quad.uv_sets.into_iter().enumerate() {
        assert!((hit.uv(set) - quad.uv(set, points()[1])).length() < ROUNDING);
        // The chain rule: moving along a side of the quad changes the coordinates by what that side spans in them.
        let span = |uv: DVec2| hit.dpdu(set) * uv.x + hit.dpdv(set) * uv.y;
        assert!((span(a) - quad.along_a).length() < ROUNDING, "{set}");
        assert!((span(b) - quad.along_b).length() < ROUNDING, "{set}");
        let footprint = hit.footprint(set, &dx, &dy);
        assert!((footprint.dx - a * 0.1).length() < ROUNDING, "{set}: {footprint:?}");
        assert!((footprint.dy - b * 0.1).length() < ROUNDING, "{set}: {footprint:?}");
    }
    assert_eq!(
        (hit.uv(2), hit.dpdu(2), hit.footprint(2, &dx, &dy).dx),
        (DVec2::ZERO, DVec3::ZERO, DVec2::ZERO)
    );
}

#[test]
fn a_mirrored_quad_matches_the_reflected_one() {
    for (quad, set) in [(Quad::square(), 0), (Quad::sheared(), 0), (Quad::sheared(), 1)] {
        for at in points() {
            let [mesh, reflected] = [quad.mesh(), quad.reflected().mesh()];
            let (hit, mirrored) = (quad.hit(&mesh, at, 1.0), quad.reflected().hit(&reflected, at, 1.0));
            assert!(hit.frame.tangent().cross(hit.frame.bitangent()).dot(hit.frame.normal()) > 0.0);
            let frame_there = mirrored.frame;
            assert!(frame_there.tangent().cross(frame_there.bitangent()).dot(frame_there.normal()) < 0.0);
            let normal = |hit: &Hit<'_>| {
                let stored = stored_slope(texel_of(hit.uv(set)));
                world_normal(hit, stored.transformed(frame(set).matrix(hit)))
            };
            let (normal, mirrored) = (normal(&hit), normal(&mirrored));
            assert!((reflect(normal) - mirrored).length() < SINGLE, "{normal} {mirrored}");
        }
    }
}

/// A quad with bumps under a light, or the mirror image of the whole scene in the plane x = 0.
fn picture(quad: Quad, mirror: fn(DVec3) -> DVec3) -> Picture {
    const SIZE: (u32, u32) = (96, 64);
    let bumps = pattern::random_bumps(64, 0.15, 5);
    let options =
        BakeOptions::default().with_layout(Shading::Lean.layout()).with_sample_type(SampleType::F32);
    let maps = Bake::of(&bumps.heights).source(bumps.source_options()).options(options).run().unwrap().arrays;
    let textures = BakedTextures::of_model(Shading::Lean, &maps).unwrap();
    let middle = quad.point(DVec2::splat(0.5));
    let eye = middle + mirror(DVec3::new(0.6, -0.4, 1.9));
    let scene = Scene {
        shape: Arc::new(quad.mesh()),
        camera: Camera::new(eye, middle, DVec3::Y, 0.6).unwrap(),
        lights: vec![Light::Directional {
            towards: mirror(DVec3::new(-0.3, 0.4, 1.0)).normalize(),
            irradiance: Light::WHITE,
        }],
        material: Material::default(),
        albedo: None,
        repeats: 2.0,
        background: [0.0; 3],
    };
    let sampler = Sampler::default().with_filter(Filter::Anisotropic);
    let detail = textures.sampled(sampler);
    let method = Method { shading: Shading::Lean, detail: &detail, options: ShadingOptions::default() };
    method.render(&scene, SIZE, &unwatched).unwrap()
}

#[test]
fn the_picture_of_a_mirrored_quad_matches_the_reflected_picture() {
    /// Tolerance for radiance around one: single floats, after a lobe that multiplies their roundings by its exponent.
    const ROUNDING: f32 = 1e-3;
    let quad = Quad::sheared();
    let (plain, mirrored) = (picture(quad, |v| v), picture(quad.reflected(), reflect));
    let (mut compared, mut unequal) = (0, 0);
    for (row, mirrored) in
        plain.radiance().chunks(plain.width()).zip(mirrored.radiance().chunks(plain.width()))
    {
        for (a, b) in row.iter().zip(mirrored.iter().rev()) {
            // A pixel's centre may be so close to an edge that rounding decides.
            let close = a.iter().zip(b).all(|(a, b)| (a - b).abs() < ROUNDING * (1.0 + a.abs()));
            compared += usize::from(a[0] > 0.0);
            unequal += usize::from(!close);
        }
    }
    assert!(compared > 1_000, "{compared}");
    assert!(unequal <= 1, "{unequal} of {compared}");
    // The comparison can fail: without the reflection the pictures differ.
    let same = plain.radiance().iter().zip(mirrored.radiance()).filter(|(a, b)| a == b && a[0] > 0.0).count();
    assert!(same * 10 < compared, "{same} of {compared}");
}
