//! A twist and a bend of space, and a pipe to deform by them.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use anyhow::Result;
use glam::{DMat3, DVec2, DVec3, Vec3};
use roughcast_scene::{Bounds, Frame, Hit, Mesh, Side, TriangleMesh, UvSets};

/// Radius of the pipe, and its length in turns around it.
const RADIUS: f64 = 0.35;
const TURNS: f64 = 1.6;
/// Squares around the pipe and along it.
const GRID: [u32; 2] = [96, 160];
/// Angles by which the top of the pipe is turned about its axis and bent over, in radians.
const TWIST: f64 = PI;
const BEND: f64 = 2.0 * PI / 3.0;
/// The angle by which the top of a given mesh is turned. Meshes are wider than the pipe, so it shears their texture more.
const TWIST_OF_MESH: f64 = FRAC_PI_2;

/// A twist about a vertical axis, followed by a bend of that axis to an arc. The foot of the axis stays where it is.
pub struct Deformation {
    foot: DVec3,
    /// The part of the axis that is twisted and bent by the whole angles.
    length: f64,
    /// Angles in radians over the length.
    twist: f64,
    bend: f64,
}

impl Deformation {
    /// The pipe, twisted and bent by this fraction of the whole angles.
    pub fn of_pipe(fraction: f64) -> Self {
        let length = TAU * RADIUS * TURNS;
        Self { foot: DVec3::ZERO, length, twist: fraction * TWIST, bend: fraction * BEND }
    }

    /// A mesh within these bounds, twisted about the vertical axis through its middle by this fraction of the whole
    /// angle. It is not bent: a wide mesh would overlap.
    pub fn twist(bounds: Bounds, fraction: f64) -> Self {
        let foot = bounds.centre - bounds.radius * DVec3::Y;
        Self { foot, length: 2.0 * bounds.radius, twist: fraction * TWIST_OF_MESH, bend: 0.0 }
    }

    /// What the whole deformation does, for the report.
    pub fn about(is_pipe: bool) -> String {
        if is_pipe {
            format!("twisted by up to {:.0}° and bent by up to {:.0}°", TWIST.to_degrees(), BEND.to_degrees())
        } else {
            format!("twisted by up to {:.0}° about the vertical axis", TWIST_OF_MESH.to_degrees())
        }
    }

    /// The position of a point that is at `p` at rest.
    fn moved(&self, p: DVec3) -> DVec3 {
        let p = p - self.foot;
        let along = p.y / self.length;
        let (sin, cos) = (self.twist * along).sin_cos();
        let twisted = DVec3::new(cos * p.x + sin * p.z, p.y, cos * p.z - sin * p.x);
        if self.bend == 0.0 {
            return self.foot + twisted;
        }
        let radius = self.length / self.bend;
        let (sin, cos) = (self.bend * along).sin_cos();
        let inwards = radius - twisted.x;
        self.foot + DVec3::new(radius - inwards * cos, inwards * sin, twisted.z)
    }

    /// The derivatives of [`Deformation::moved`].
    fn jacobian(&self, p: DVec3) -> DMat3 {
        // Central differences: the error of the square of the step equals that of rounding.
        let step = 1e-5 * self.length;
        let along = |axis: DVec3| (self.moved(p + axis * step) - self.moved(p - axis * step)) / (2.0 * step);
        DMat3::from_cols(along(DVec3::X), along(DVec3::Y), along(DVec3::Z))
    }

    /// The mesh in this pose, with the tangents of the given one.
    pub fn mesh(&self, rest: &Mesh) -> Result<Mesh> {
        let vertices = rest.triangles();
        let moved = |p: &[f32; 3]| self.moved(Vec3::from(*p).as_dvec3()).as_vec3().into();
        let turned = |(p, n): (&[f32; 3], &[f32; 3])| {
            let normal_from_rest = self.jacobian(Vec3::from(*p).as_dvec3()).inverse().transpose();
            (normal_from_rest * Vec3::from(*n).as_dvec3()).normalize().as_vec3().into()
        };
        let positions = vertices.positions.iter().map(moved).collect();
        let normals = vertices.positions.iter().zip(&vertices.normals).map(turned).collect();
        Ok(rest.deformed(positions, normals)?)
    }
}

/// An open pipe about the y axis that stands on the origin. Its texture coordinates are lengths in units of its
/// circumference, so that the texture is not stretched.
#[derive(Clone, Copy)]
pub struct Pipe;

impl Pipe {
    fn point(uv: DVec2) -> DVec3 {
        let (sin, cos) = (TAU * uv.x).sin_cos();
        // v grows downwards.
        DVec3::new(RADIUS * sin, TAU * RADIUS * (TURNS - uv.y), RADIUS * cos)
    }

    fn normal(uv: DVec2) -> DVec3 {
        let (sin, cos) = (TAU * uv.x).sin_cos();
        DVec3::new(sin, 0.0, cos)
    }

    /// Derivatives of the point with respect to u and v.
    fn derivatives(uv: DVec2) -> [DVec3; 2] {
        let (sin, cos) = (TAU * uv.x).sin_cos();
        let circumference = TAU * RADIUS;
        [DVec3::new(circumference * cos, 0.0, -circumference * sin), DVec3::new(0.0, -circumference, 0.0)]
    }

    /// The pipe as triangles, without tangents.
    pub fn triangles(self) -> TriangleMesh {
        let [across, down] = GRID;
        let uvs: Vec<DVec2> = (0..=down)
            .flat_map(|j| (0..=across).map(move |i| (i, j)))
            .map(|(i, j)| {
                DVec2::new(f64::from(i) / f64::from(across), TURNS * f64::from(j) / f64::from(down))
            })
            .collect();
        let squares = (0..down).flat_map(|j| (0..across).map(move |i| j * (across + 1) + i));
        let triangles = squares.flat_map(|top_left| {
            let below = top_left + across + 1;
            [top_left, below, top_left + 1, top_left + 1, below, below + 1]
        });
        TriangleMesh {
            positions: uvs.iter().map(|uv| Self::point(*uv).as_vec3().into()).collect(),
            normals: uvs.iter().map(|uv| Self::normal(*uv).as_vec3().into()).collect(),
            tangents: Vec::new(),
            uv_sets: vec![uvs.iter().map(|uv| uv.as_vec2().into()).collect()],
            indices: triangles.collect(),
        }
    }

    /// A hit of the deformed triangles, with the frame and the derivatives of the smooth surface at its texture
    /// coordinates.
    pub fn exact_hit(self, hit: &Hit<'_>, deformation: &Deformation) -> Hit<'static> {
        let uv = hit.uv(0);
        let jacobian = deformation.jacobian(Self::point(uv));
        let [dpds, dpdt] = Self::derivatives(uv).map(|along| jacobian * along);
        // v grows downwards.
        let (normal, tangent) = (dpdt.cross(dpds).normalize(), dpds.normalize());
        let front = Frame::orthonormal(tangent, normal.cross(tangent), normal);
        let frame = match hit.side {
            Side::Front => front,
            Side::Back => front.reversed(),
        };
        Hit {
            distance: hit.distance,
            position: hit.position,
            geometric_normal: frame.normal(),
            frame,
            side: hit.side,
            dpds,
            dpdt,
            // Not used by slopes.
            dnds: DVec3::ZERO,
            dndt: DVec3::ZERO,
            uv_sets: UvSets::of_parameters(uv),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pipe_keeps_its_foot_and_its_length_and_its_top_bends() {
        /// Sums of single numbers of the size of one.
        const ROUNDING: f64 = 1e-12;
        let length = TAU * RADIUS * TURNS;
        for fraction in [0.0, 0.5, 1.0] {
            let deformation = Deformation::of_pipe(fraction);
            let on_axis = |along: f64| deformation.moved(DVec3::Y * (along * length));
            assert!(on_axis(0.0).length() < ROUNDING);
            let steps = 1000;
            let step = |i: u32| on_axis(f64::from(i) / f64::from(steps));
            let sum: f64 = (0..steps).map(|i| step(i).distance(step(i + 1))).sum();
            // Chords of an arc of 120 degrees in a thousand parts.
            assert!((sum / length - 1.0).abs() < 1e-6, "{sum} {length}");
            let top = deformation.jacobian(DVec3::Y * length) * DVec3::Y;
            assert!((top.angle_between(DVec3::Y) - fraction * BEND).abs() < 1e-6, "{top}");
        }
        let rest = Deformation::of_pipe(0.0);
        let p = DVec3::new(0.3, 1.7, -0.2);
        assert!((rest.moved(p) - p).length() < ROUNDING);
    }

    #[test]
    fn the_pipe_has_the_frame_of_its_formula() {
        let mesh = Mesh::new(vec![Pipe.triangles()]).expect("a mesh");
        let [across, down] = GRID;
        assert_eq!(mesh.triangle_count() as u32, 2 * across * down);
        for (uv, normal) in mesh.triangles().uv_sets[0].iter().zip(&mesh.triangles().normals) {
            let uv = DVec2::from(uv.map(f64::from));
            let [du, dv] = Pipe::derivatives(uv);
            let step = 1e-6;
            let along = |d: DVec2| (Pipe::point(uv + d) - Pipe::point(uv - d)) / (2.0 * step);
            // Central differences of single-float texture coordinates.
            assert!(
                (along(DVec2::X * step) - du).length() < 1e-6
                    && (along(DVec2::Y * step) - dv).length() < 1e-6
            );
            assert!((dv.cross(du).normalize() - Pipe::normal(uv)).length() < 1e-9);
            assert!((Pipe::normal(uv) - Vec3::from(*normal).as_dvec3()).length() < 1e-6);
        }
    }
}
