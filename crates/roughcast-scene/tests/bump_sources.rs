//! Sources of bumps that need no tangents: heights on the screen, noise, projections, sums, and curvature.

mod common;

use std::sync::Arc;

use common::hits as hits_of;
use glam::{DAffine3, DVec2, DVec3};
use roughcast::noise::{Noise, NoiseKind, OctaveFilter};
use roughcast::shading::{GeometricFilter, Shading, ShadingOptions};
use roughcast::surface_gradient::{perturbed_normal, surface_gradient, surface_gradient_of_volume};
use roughcast::{Covariance, Distribution, Image, Kind, NormalRange, Samples, Slope, SourceOptions, Wrap};
use roughcast_scene::render::{Method, Truth, unwatched};
use roughcast_scene::{
    BakedTextures, Combined, Curved, Decal, Detail, DetailPoint, Filter, HeightDerivative, HeightDetail,
    HeightMap, Hit, Mesh, NoiseDetail, ObjectNormalDetail, ObjectNormalMap, Perturbation, Placement, Plane,
    Ray, Resolved, Sampler, Shape, SlopeDetail, SlopeMap, Sphere, Strengthened, TangentSource, Torus,
    Triplanar, UvSets, View, VolumeDerivative, isosurface, pattern,
};

/// Slopes are single floats of the size of one.
const SINGLE: f64 = 2e-6;

fn shapes() -> Vec<Shape> {
    let mesh = Mesh::new(vec![isosurface(16)]).expect("a mesh");
    vec![
        Shape::Plane(Plane::default()),
        Shape::Sphere(Sphere),
        Shape::Torus(Torus::default()),
        Shape::Mesh(Arc::new(mesh)),
    ]
}

fn hits(shape: &Shape) -> Vec<Hit<'_>> {
    hits_of(shape, 200).into_iter().map(|(_, hit)| hit).collect()
}

fn noise() -> Noise {
    Noise::default().with_octaves(3).with_frequency(2.0).with_amplitude(0.1)
}

fn options() -> ShadingOptions {
    ShadingOptions::default()
}

fn difference(a: Slope, b: Slope) -> f64 {
    f64::from((a.x - b.x).hypot(a.y - b.y))
}

fn world_normal(hit: &Hit<'_>, slope: Slope) -> DVec3 {
    hit.frame.world_from_tangent(DVec3::new(f64::from(slope.x), f64::from(slope.y), 1.0)).normalize()
}

/// The hits of a grid of pixels, as seen with a pixel of this size relative to the picture's.
fn for_each_pixel(shape: &Shape, pixel: f64, mut call: impl FnMut(&DetailPoint<'_>)) {
    let camera = View::Mid.camera(shape);
    let size = (24, 24);
    let rays = camera.pixel_rays(size.0, size.1);
    let mut count = 0;
    for (x, y) in (0..size.1).flat_map(|y| (0..size.0).map(move |x| (x, y))) {
        let (left, top) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
        let Some(hit) = shape.hit(&rays.ray(left, top)) else { continue };
        let (right, below) = (rays.ray(left + pixel, top), rays.ray(left, top + pixel));
        call(&DetailPoint::under_pixel(&hit, 3.0, (x, y), &right, &below));
        count += 1;
    }
    assert!(count > 50, "{count}");
}

#[test]
fn noise_tilts_the_normal_by_its_surface_gradient_from_both_sides() {
    let detail = NoiseDetail::new(noise());
    for shape in shapes() {
        for hit in hits(&shape) {
            let normal = hit.frame.normal();
            let gradient = surface_gradient_of_volume(normal, noise().sample(hit.position).gradient);
            // Heights are along the front's normal.
            let side = if hit.side == roughcast_scene::Side::Front { 1.0 } else { -1.0 };
            let wanted = perturbed_normal(normal, gradient * side);
            let got = world_normal(&hit, detail.slope(&DetailPoint::new(&hit, 1.0)));
            assert!((got - wanted).length() < SINGLE, "{shape:?}: {got} {wanted}");
            // A point has the same slope as a distribution without a spread.
            let seen = detail.distribution(&DetailPoint::new(&hit, 1.0), &options());
            assert!((world_normal(&hit, seen.whole().mean) - wanted).length() < SINGLE);
            assert_eq!(seen.whole().covariance, Covariance::default());
        }
    }
}

#[test]
fn derivatives_on_the_screen_approach_the_gradient_as_pixels_shrink() {
    // On shapes whose own normals are those of the surface; differences are of first order, central ones of second.
    for shape in [Shape::Plane(Plane::default()), Shape::Sphere(Sphere), Shape::Torus(Torus::default())] {
        let exact = NoiseDetail::new(noise());
        let error = |derivative, pixel: f64| {
            let detail = NoiseDetail { derivative, ..exact };
            let mut largest = 0.0_f64;
            for_each_pixel(&shape, pixel, |at| {
                let seen = detail.distribution(at, &options()).whole().mean;
                largest = largest.max(difference(seen, exact.slope(at)));
            });
            largest
        };
        for (derivative, order) in
            [(VolumeDerivative::Fine, 1), (VolumeDerivative::Forward, 1), (VolumeDerivative::Central, 2)]
        {
            let (coarse, fine) = (error(derivative, 1e-2), error(derivative, 1e-3));
            // A tenth of the pixel leaves a tenth or a hundredth of the error, and the rounding of single floats.
            let left = 0.2 * 0.2_f64.powi(order - 1) * coarse + SINGLE;
            assert!(fine < left, "{shape:?}, {derivative}: {coarse} {fine}");
        }
        assert!(error(VolumeDerivative::Numeric, 1.0) < 2e-3, "{shape:?}");
    }
}

#[test]
fn perlins_perturbation_and_facets_differ_from_the_surface_gradient() {
    let shape = Shape::Sphere(Sphere);
    let exact = NoiseDetail::new(noise());
    for perturbation in [Perturbation::Perlin, Perturbation::Facets] {
        let detail = NoiseDetail { perturbation, derivative: VolumeDerivative::Forward, ..exact };
        let (mut largest, mut smallest) = (0.0_f64, f64::INFINITY);
        for_each_pixel(&shape, 1e-3, |at| {
            let apart = difference(detail.distribution(at, &options()).whole().mean, exact.slope(at));
            (largest, smallest) = (largest.max(apart), smallest.min(apart));
        });
        match perturbation {
            Perturbation::Perlin => assert!(largest > 0.05, "{largest}"),
            // The facets of a sphere are its tangent planes.
            _ => assert!(largest < 0.01, "{largest}"),
        }
    }
}

/// Waves of a few texels, and how to read them.
fn waves(size: usize) -> (Image, SourceOptions) {
    let texel = |i: usize| {
        let (x, y) = ((i % size) as f64 + 0.5, (i / size) as f64 + 0.5);
        let k = std::f64::consts::TAU / size as f64;
        ((2.0 * k * x).sin() + (3.0 * k * y + k * x).cos()) as f32 / size as f32
    };
    let image =
        Image::new(size, size, 1, Samples::F32((0..size * size).map(texel).collect())).expect("a square");
    (image, SourceOptions::default().with_kind(Kind::Height).with_height_scale(1.0))
}

#[test]
fn heights_on_the_screen_approach_their_exact_slopes() {
    let (image, source) = waves(64);
    let heights = HeightMap::of(&image, &source).expect("a height map");
    for shape in [Shape::Plane(Plane::default()), Shape::Sphere(Sphere), Shape::Torus(Torus::default())] {
        for placement in [Placement::default(), Placement::default().with_world_height_per_texel(0.01)] {
            for derivative in HeightDerivative::ALL {
                let detail =
                    HeightDetail { derivative: *derivative, placement, ..HeightDetail::new(heights.clone()) };
                let (mut sum, mut count, mut steepest) = (0.0, 0, 0.0_f64);
                for_each_pixel(&shape, 1e-4, |at| {
                    let exact = detail.slope(at);
                    sum += difference(detail.distribution(at, &options()).whole().mean, exact);
                    steepest = steepest.max(f64::from(exact.x.hypot(exact.y)));
                    count += 1;
                });
                // Where a step crosses the middle of a texel, the slope of the bilinear surface jumps.
                let mean = sum / f64::from(count);
                assert!(
                    mean < 2e-3 * steepest && steepest > 0.05,
                    "{shape:?}, {derivative}: {mean} {steepest}"
                );
            }
        }
    }
}

#[test]
fn frames_of_a_known_world_height_agree_on_a_sphere() {
    // Heights, slopes with tangents, and slopes without: all of the same size on the unit sphere.
    let (image, source) = waves(64);
    let placement = Placement::default().with_world_height_per_texel(0.02);
    let heights = HeightMap::of(&image, &source).expect("a height map");
    let bicubic =
        HeightDetail { derivative: HeightDerivative::Bicubic, placement, ..HeightDetail::new(heights) };
    let slopes = SlopeMap::of(&image, &source).expect("a height map");
    let of = |tangents| {
        SlopeDetail::new(slopes.clone(), Wrap::Repeat).placed(placement.with_tangent_source(tangents))
    };
    let (mesh, screen) = (of(TangentSource::Mesh), of(TangentSource::Derivatives));
    let mut steepest = 0.0_f64;
    for_each_pixel(&Shape::Sphere(Sphere), 1.0, |at| {
        let (a, b, c) = (mesh.slope(at), screen.slope(at), bicubic.slope(at));
        assert!(difference(a, b) < SINGLE);
        steepest = steepest.max(f64::from(a.x.hypot(a.y)));
        // Sobel, and a B-spline, smooth waves of 21 texels by a few percent.
        assert!(difference(a, c) < 0.05 * (0.2 + f64::from(a.x.hypot(a.y))), "{a:?} {c:?}");
    });
    assert!(steepest > 0.2, "{steepest}");
}

#[test]
fn without_a_size_the_frame_of_derivatives_is_that_of_the_mesh_where_nothing_is_sheared() {
    let slopes = SlopeMap::of(&waves(64).0, &waves(64).1).expect("a height map");
    let of = |tangents| {
        SlopeDetail::new(slopes.clone(), Wrap::Repeat)
            .placed(Placement::default().with_tangent_source(tangents))
    };
    let (mesh, screen) = (of(TangentSource::Mesh), of(TangentSource::Derivatives));
    let plane = Shape::Plane(Plane::default());
    for_each_pixel(&plane, 1.0, |at| {
        assert!(difference(mesh.slope(at), screen.slope(at)) < SINGLE);
    });
}

#[test]
fn sums_add_slopes_and_moments_and_strengths_scale_them() {
    let (one, other) =
        (NoiseDetail::new(noise()), NoiseDetail::new(noise().with_seed(99).with_kind(NoiseKind::Turbulence)));
    let sum = Combined::new(vec![
        Strengthened { detail: &one, strength: 0.5 },
        Strengthened { detail: &other, strength: -2.0 },
    ]);
    for_each_pixel(&Shape::Sphere(Sphere), 1.0, |at| {
        let slope = one.slope(at) * 0.5 + other.slope(at) * -2.0;
        assert!(difference(sum.slope(at), slope) < SINGLE);
        let [a, b, both] =
            [&one as &dyn Detail, &other, &sum].map(|detail| detail.distribution(at, &options()).whole());
        assert!(difference(both.mean, a.mean * 0.5 + b.mean * -2.0) < SINGLE);
        let apart = both.covariance - (a.covariance * 0.25 + b.covariance * 4.0);
        assert!(f64::from(apart.trace().abs()) < SINGLE, "{apart:?}");
    });
    let nothing = Combined::new(Vec::new());
    for_each_pixel(&Shape::Sphere(Sphere), 1.0, |at| {
        assert_eq!(nothing.distribution(at, &options()), Distribution::of_slope(Slope::default()));
    });
}

/// A height map of a formula over positions on a plane, one texel for a 64th of a unit.
fn projected_source() -> (SlopeDetail, Placement) {
    let (image, source) = waves(64);
    let placement = Placement::default()
        .with_tangent_source(TangentSource::Derivatives)
        .with_world_height_per_texel(1.0 / 64.0);
    let slopes = SlopeMap::of(&image, &source).expect("a height map");
    (SlopeDetail::new(slopes, Wrap::Repeat).placed(placement), placement)
}

#[test]
fn a_triplanar_projection_is_that_of_the_axis_where_the_surface_faces_it() {
    let (source, placement) = projected_source();
    let triplanar = Triplanar::new(&source);
    // The plane, whose texture coordinates grow with x and z.
    let plane = Shape::Plane(Plane::new(0.5).expect("a size"));
    let ordinary = SlopeDetail { placement, ..source.clone() };
    let mut steepest = 0.0_f64;
    for hit in hits(&plane) {
        if hit.side == roughcast_scene::Side::Back {
            continue;
        }
        let at = DetailPoint::new(&hit, 1.0);
        // Its coordinates start at the corner, projections at the origin: half a unit apart, which is a whole number of
        // texels.
        let shifted = hit.uv(0) - 0.5;
        let points = [roughcast_scene::UvPoint { uv: shifted, ..hit.uv_sets.get(0) }];
        let moved = Hit { uv_sets: UvSets::of_points(&points), ..hit };
        let (a, b) = (triplanar.slope(&at), ordinary.slope(&DetailPoint::new(&moved, 1.0)));
        assert!(difference(a, b) < SINGLE, "{a:?} {b:?}");
        steepest = steepest.max(f64::from(a.x.hypot(a.y)));
    }
    assert!(steepest > 0.1, "{steepest}");
}

#[test]
fn projections_need_neither_tangents_nor_texture_coordinates() {
    let (source, _) = projected_source();
    let triplanar = Triplanar::new(&source);
    let mesh = Shape::Mesh(Arc::new(Mesh::new(vec![isosurface(16)]).expect("a mesh")));
    let (mut bumpy, mut count) = (0, 0);
    for_each_pixel(&mesh, 1.0, |at| {
        let seen = triplanar.distribution(at, &options());
        let whole = seen.whole();
        assert!(whole.mean.x.is_finite() && whole.covariance.trace() >= 0.0, "{whole:?}");
        assert!(seen.normal().length() <= 1.0 + 1e-5);
        bumpy += u32::from(whole.mean.x.hypot(whole.mean.y) > 0.02);
        count += 1;
    });
    assert!(2 * bumpy > count, "{bumpy} of {count}");
}

#[test]
fn a_decal_displaces_the_surface_inside_its_box_alone() {
    let (source, _) = projected_source();
    // A box of half a unit a side over the plane, whose z axis is world y; its depth is two.
    let box_from_world = DAffine3::from_scale_rotation_translation(
        DVec3::new(0.5, 0.5, 2.0),
        glam::DQuat::from_rotation_x(-std::f64::consts::FRAC_PI_2),
        DVec3::new(0.1, 0.0, -0.2),
    )
    .inverse();
    let decal = Decal { detail: &source, box_from_world };
    let plane = Shape::Plane(Plane::default());
    let (mut inside, mut outside) = (0, 0);
    for_each_pixel(&plane, 1.0, |at| {
        let p = at.hit().position;
        let slope = decal.slope(at);
        let distribution = decal.distribution(at, &options()).whole();
        if (p.x - 0.1).abs() > 0.25 || (p.z + 0.2).abs() > 0.25 {
            assert_eq!(slope, Slope::default());
            assert_eq!(
                (distribution.mean, distribution.covariance),
                (Slope::default(), Covariance::default())
            );
            outside += 1;
            return;
        }
        // The map covers the box once, whatever the scene's repeats.
        let uv = DVec2::new((p.x - 0.1) / 0.5 + 0.5, (p.z + 0.2) / 0.5 + 0.5);
        let stored = source.slopes.at(uv, Wrap::Repeat, source.reconstruction);
        // One unit of u is half a unit of length: slopes are steeper by the texels in a unit of length over 64.
        let scale = 1.0 / 0.5;
        assert!(difference(slope, stored * scale) < 10.0 * SINGLE, "{slope:?} {stored:?}");
        inside += 1;
    });
    assert!(inside > 10 && outside > 10, "{inside} {outside}");
}

#[test]
fn curvature_widens_by_the_normals_under_the_pixel() {
    let nothing = Combined::new(Vec::new());
    let curved = Curved { detail: &nothing, filter: GeometricFilter::default().with_largest_variance(1e9) };
    for_each_pixel(&Shape::Plane(Plane::default()), 1.0, |at| {
        assert_eq!(curved.distribution(at, &options()).whole().covariance, Covariance::default());
    });
    // On the unit sphere normals change as positions do.
    for_each_pixel(&Shape::Sphere(Sphere), 1.0, |at| {
        let [dx, dy] = at.position_footprint();
        let trace = 0.25 * (dx.length_squared() + dy.length_squared());
        let covariance = curved.distribution(at, &options()).whole().covariance;
        assert!((f64::from(covariance.trace()) / trace - 1.0).abs() < 1e-5, "{covariance:?} {trace}");
    });
    // The normals of hits nearby, for shapes with normals of their own.
    for shape in [Shape::Torus(Torus::default()), shapes().remove(3)] {
        for hit in hits(&shape) {
            const STEP: f64 = 1e-6;
            for (along, dn) in [(hit.dpds, hit.dnds), (hit.dpdt, hit.dndt)] {
                let sideways = hit.position + along * STEP;
                let out = hit.geometric_normal * 0.01;
                let Some(near) = shape.hit(&Ray { origin: sideways + out, direction: -hit.geometric_normal })
                else {
                    continue;
                };
                let front = if hit.side == roughcast_scene::Side::Front { 1.0 } else { -1.0 };
                let change = (near.frame.normal() - hit.frame.normal()) * front / STEP;
                // Differences of single floats' normals on meshes; second derivatives.
                assert!((change - dn).length() < 1e-3 * (1.0 + dn.length()), "{shape:?}: {change} {dn}");
            }
        }
    }
}

/// An object-space normal map of the unit sphere with noise, in the sphere's own texture coordinates.
fn object_normals(side: usize) -> ObjectNormalMap {
    let texel = |i: usize| {
        let (u, v) = (((i % side) as f64 + 0.5) / side as f64, ((i / side) as f64 + 0.5) / side as f64);
        let p = on_sphere(u, v);
        let gradient = surface_gradient_of_volume(p, noise().sample(p).gradient);
        perturbed_normal(p, gradient).as_vec3().to_array()
    };
    let samples = Samples::F32((0..side * side).flat_map(texel).collect());
    let image = Image::new(side, side, 3, samples).expect("a square");
    ObjectNormalMap::of(&image, NormalRange::Signed).expect("three channels")
}

#[test]
fn an_object_space_normal_map_is_the_bumps_that_it_was_made_from() {
    let object = ObjectNormalDetail { normals: object_normals(512), sampler: Sampler::default(), uv_set: 0 };
    let exact = NoiseDetail::new(noise());
    let (mut sum, mut steepest, mut count) = (0.0, 0.0_f64, 0);
    for_each_pixel(&Shape::Sphere(Sphere), 1e-3, |at| {
        // The map lies on the sphere once.
        let at = DetailPoint::new(at.hit(), 1.0);
        let wanted = exact.slope(&at);
        sum += difference(object.slope(&at), wanted);
        steepest = steepest.max(f64::from(wanted.x.hypot(wanted.y)));
        count += 1;
    });
    // Linear interpolation between texels a fiftieth of a cell of the finest octave wide. Measured: 2.6e-3.
    assert!(sum / f64::from(count) < 5e-3 && steepest > 0.2, "{sum} {count} {steepest}");
}

/// The point of the unit sphere with these texture coordinates.
fn on_sphere(u: f64, v: f64) -> DVec3 {
    let (longitude, polar) = ((u - 0.5) * std::f64::consts::TAU, v * std::f64::consts::PI);
    DVec3::new(polar.sin() * longitude.sin(), polar.cos(), polar.sin() * longitude.cos())
}

#[test]
fn moments_of_object_space_normals_are_those_of_their_slopes() {
    // A texel of level 3, at whose centre linear interpolation gives its own value, is the mean of 64 texels.
    const SIDE: usize = 256;
    const COVERED: usize = 8;
    /// Slopes are linearised about the mean: the third moments of slopes of up to 0.3 about it, and their effect on the mean.
    const LINEARISED: f32 = 0.1;
    let sampler = Sampler::default().with_level(Some(3.0));
    let object = ObjectNormalDetail { normals: object_normals(SIDE), sampler, uv_set: 0 };
    let sphere = Shape::Sphere(Sphere);
    let mut widest = 0.0_f32;
    for (column, row) in (0..SIDE / COVERED).flat_map(|c| (8..24).map(move |r| (c, r))) {
        let centre = |texel: usize| (texel as f64 + 0.5) * COVERED as f64 / SIDE as f64;
        let p = on_sphere(centre(column), centre(row));
        let hit = sphere.hit(&Ray { origin: 2.0 * p, direction: -p }).expect("the sphere");
        let seen = object.distribution(&DetailPoint::new(&hit, 1.0), &options()).whole();
        let mut sum = roughcast::Moments::default();
        for (i, j) in (0..COVERED).flat_map(|j| (0..COVERED).map(move |i| (i, j))) {
            let place = |texel: usize, i: usize| ((COVERED * texel + i) as f64 + 0.5) / SIDE as f64;
            let q = on_sphere(place(column, i), place(row, j));
            let gradient = surface_gradient_of_volume(q, noise().sample(q).gradient);
            let n = hit.frame.tangent_from_world(perturbed_normal(q, gradient));
            sum = sum + roughcast::Moments::of_slope(Slope { x: (n.x / n.z) as f32, y: (n.y / n.z) as f32 });
        }
        let wanted = sum * (1.0 / (COVERED * COVERED) as f32);
        let covariance = wanted.covariance();
        let spread = covariance.trace().sqrt();
        assert!(difference(seen.mean, wanted.mean) < f64::from(LINEARISED * spread), "{seen:?} {wanted:?}");
        let apart = seen.covariance - covariance;
        let largest = apart.xx.abs().max(apart.yy.abs()).max(apart.xy.abs());
        assert!(largest < 2.0 * LINEARISED * covariance.trace(), "{seen:?} {covariance:?}");
        widest = widest.max(spread);
    }
    assert!(widest > 0.15, "{widest}");
}

/// A bend and a stretch of space.
fn deformed(p: DVec3, time: f64) -> DVec3 {
    let (sin, cos) = (1.5 * time * p.y + 0.4 * time * p.x).sin_cos();
    DVec3::new(cos * p.x - sin * p.z, p.y * (1.0 + time), sin * p.x + cos * p.z)
}

#[test]
fn a_deforming_mesh_needs_no_new_tangents() {
    // The mesh keeps the tangents of its rest pose: only positions and normals are skinned.
    const HEIGHT: f64 = 0.01;
    /// Triangles against the smooth surface, in the length of unit normals.
    const TRIANGLES: f64 = 0.03;
    let slopes = SlopeMap::of(&waves(64).0, &waves(64).1).expect("a height map");
    let detail = |placement| SlopeDetail::new(slopes.clone(), Wrap::Repeat).placed(placement);
    let sized = detail(Placement::default().with_world_height_per_texel(HEIGHT));
    let by_tangents = detail(Placement::default());
    let torus = Torus::default();
    let rest = Mesh::new(vec![Shape::Torus(torus).triangles(96)]).expect("a mesh");
    let at_rest = |u: f64, v: f64| {
        let (around, tube) = ((u - 0.5) * std::f64::consts::TAU, (0.5 - v) * std::f64::consts::TAU);
        let ring = 1.0 + torus.minor() * tube.cos();
        DVec3::new(ring * around.sin(), torus.minor() * tube.sin(), ring * around.cos())
    };
    let mut stale = 0.0_f64;
    for time in [0.0, 0.3, 0.8] {
        let chart = |u: f64, v: f64| deformed(at_rest(u, v), time);
        let derivatives = |u: f64, v: f64| {
            const STEP: f64 = 1e-5;
            let along = |du: f64, dv: f64| (chart(u + du, v + dv) - chart(u - du, v - dv)) / (2.0 * STEP);
            (along(STEP, 0.0), along(0.0, STEP))
        };
        let uvs = || rest.triangles().uv_sets[0].iter().map(|[u, v]| (f64::from(*u), f64::from(*v)));
        let positions = uvs().map(|(u, v)| chart(u, v).as_vec3().into()).collect();
        let normal = |(u, v)| {
            let (du, dv) = derivatives(u, v);
            // v grows downwards.
            dv.cross(du).normalize().as_vec3().into()
        };
        let pose = rest.deformed(positions, uvs().map(normal).collect()).expect("a pose");
        let shape = Shape::Mesh(Arc::new(pose));
        for_each_pixel(&shape, 1.0, |at| {
            let (hit, uv) = (at.hit(), at.hit().uv(0));
            let (du, dv) = derivatives(uv.x, uv.y);
            let normal = dv.cross(du).normalize();
            let repeats = at.repeats();
            let stored = slopes.at(uv * repeats, Wrap::Repeat, sized.reconstruction);
            let height = HEIGHT * 64.0 * repeats;
            let gradient =
                surface_gradient(du, dv, normal, -height * f64::from(stored.x), height * f64::from(stored.y));
            let wanted = perturbed_normal(normal, gradient);
            let got = world_normal(hit, sized.slope(at));
            assert!((got - wanted).length() < TRIANGLES, "{time}: {got} {wanted}");
            stale = stale.max((world_normal(hit, by_tangents.slope(at)) - wanted).length());
        });
    }
    // The comparison can fail: by the tangents of the rest pose the bumps are wrong.
    assert!(stale > 5.0 * TRIANGLES, "{stale}");
}

#[test]
fn degenerate_points_are_flat_and_never_nan() {
    let (image, source) = waves(16);
    let heights = HeightDetail::new(HeightMap::of(&image, &source).expect("a height map"));
    let noise = NoiseDetail::new(noise());
    let screen = NoiseDetail { derivative: VolumeDerivative::Fine, ..noise };
    let (projected, _) = projected_source();
    let triplanar = Triplanar::new(&projected);
    let curved = Curved { detail: &noise, filter: GeometricFilter::default() };
    let details: [&dyn Detail; 5] = [&heights, &noise, &screen, &triplanar, &curved];
    let shape = Shape::Sphere(Sphere);
    let hit = hits(&shape).remove(0);
    let (nan, huge) = (DVec3::NAN, DVec3::splat(1e200));
    let odd = [
        Hit { dpds: DVec3::ZERO, ..hit },
        Hit { dpds: DVec3::ZERO, dpdt: DVec3::ZERO, ..hit },
        Hit { dpdt: hit.dpds * 2.0, ..hit },
        Hit { dpds: nan, ..hit },
        Hit { position: nan, ..hit },
        Hit { position: huge, ..hit },
        Hit { dpds: huge, dpdt: DVec3::new(1e200, 0.0, 0.0), ..hit },
        Hit { dnds: nan, dndt: huge, ..hit },
        Hit { uv_sets: UvSets::default(), ..hit },
    ];
    for (place, hit) in odd.iter().enumerate() {
        for (which, detail) in details.iter().enumerate() {
            let ray = |x: f64| Ray {
                origin: hit.frame.normal() * 4.0,
                direction: DVec3::new(x, 0.1, -1.0).normalize(),
            };
            let at = DetailPoint::under_pixel(hit, 2.0, (1, 1), &ray(0.01), &ray(0.02));
            let (slope, seen) = (detail.slope(&at), detail.distribution(&at, &options()).whole());
            let all = [slope.x, slope.y, seen.mean.x, seen.mean.y, seen.covariance.xx, seen.covariance.yy];
            assert!(all.iter().all(|x| x.is_finite()), "hit {place}, detail {which}: {all:?}");
        }
    }
}

#[test]
fn textures_without_tangents_converge_to_their_ground_truth() {
    // LEAN on the teapot's cousin: a mesh without texture coordinates, projected along three axes.
    const SIZE: (u32, u32) = (64, 64);
    let mesh = Arc::new(Shape::Mesh(Arc::new(Mesh::new(vec![isosurface(24)]).expect("a mesh"))));
    let bumps = pattern::random_bumps(64, 0.3, 2);
    let mut scene = View::Mid.scene(mesh, (64, 64), SIZE, Default::default());
    scene.repeats = 8.0;
    let placement = Placement::default()
        .with_tangent_source(TangentSource::Derivatives)
        .with_world_height_per_texel(1.0 / (8.0 * 64.0));
    let source = bumps.source_options();
    let baked = roughcast::Bake::of(&bumps.heights).source(source).run().expect("bumps can be baked");
    let textures = BakedTextures::of_model(Shading::Lean, &baked.arrays).expect("its textures");
    let lean = textures.sampled(Sampler::default().with_filter(Filter::Anisotropic)).placed(placement);
    let exact = SlopeDetail::new(SlopeMap::of(&bumps.heights, &source).expect("slopes"), Wrap::Repeat)
        .placed(placement);
    let (lean, exact) = (Triplanar::new(&lean), Triplanar::new(&exact));
    let render = |detail: &dyn Detail| {
        let method = Method { shading: Shading::Lean, detail, options: options() };
        method.render(&scene, SIZE, &unwatched).expect("a picture")
    };
    let truth = Truth { shading: Shading::Lean, detail: &exact, options: options(), samples: 256 };
    let truth = truth.render(&scene, SIZE, &unwatched).expect("a picture");
    let rmse = |picture| roughcast_scene::metrics::rmse(picture, &truth).expect("equal sizes");
    let (filtered, resolved) = (rmse(&render(&lean)), rmse(&render(&Resolved(&exact))));
    assert!(filtered < 0.25 * resolved, "{filtered} {resolved}");
}

#[test]
fn octaves_that_fade_are_nearer_to_ground_truth_than_those_that_are_dropped_or_kept() {
    const SIZE: (u32, u32) = (48, 48);
    let mesh = Arc::new(Shape::Mesh(Arc::new(Mesh::new(vec![isosurface(24)]).expect("a mesh"))));
    let scene = View::Mid.scene(mesh, (1, 1), SIZE, Default::default());
    for frequency in [3.0, 12.0, 48.0] {
        let noise =
            Noise::default().with_octaves(6).with_frequency(frequency).with_amplitude(0.12 / frequency);
        let detail = |filter| NoiseDetail { filter, ..NoiseDetail::new(noise) };
        let truth_of = detail(OctaveFilter::Fade);
        let truth = Truth { shading: Shading::Lean, detail: &truth_of, options: options(), samples: 144 };
        let truth = truth.render(&scene, SIZE, &unwatched).expect("a picture");
        let error = |filter| {
            let detail = detail(filter);
            let curved = Curved { detail: &detail, filter: GeometricFilter::default() };
            let method = Method { shading: Shading::Lean, detail: &curved, options: options() };
            let picture = method.render(&scene, SIZE, &unwatched).expect("a picture");
            roughcast_scene::metrics::rmse(&picture, &truth).expect("equal sizes")
        };
        let [fade, drop, keep] = [OctaveFilter::Fade, OctaveFilter::Drop, OctaveFilter::Keep].map(error);
        assert!(fade < 0.6 * drop && fade < 0.6 * keep, "{frequency}: {fade} {drop} {keep}");
    }
}
