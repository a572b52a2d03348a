//! The texture coordinates at a point of a surface.

use glam::{DVec2, DVec3, Vec2};

/// One set of texture coordinates at a point of a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct UvPoint {
    /// The coordinates.
    pub uv: DVec2,
    /// Their derivative with respect to the surface's parameter s.
    pub ds: DVec2,
    /// Their derivative with respect to the surface's parameter t.
    pub dt: DVec2,
}

/// All sets of texture coordinates at a point of a surface. Sets are computed on demand, because most sources of bumps
/// use only one and hits are copied often.
#[derive(Clone, Copy, Debug)]
pub struct UvSets<'a>(Source<'a>);

#[derive(Clone, Copy, Debug)]
enum Source<'a> {
    Parameters(DVec2),
    Points(&'a [UvPoint]),
    Triangle(TrianglePoint<'a>),
}

/// A point of a triangle. The parameters s and t run along the edges from its first corner to the second and to the
/// third.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TrianglePoint<'a> {
    /// Sets of texture coordinates, each with one entry per vertex of the mesh.
    pub sets: &'a [Vec<[f32; 2]>],
    /// The vertices of the triangle.
    pub corners: [u32; 3],
    /// Barycentric coordinates, one per corner; they sum to one.
    pub weights: DVec3,
}

impl Default for UvSets<'_> {
    /// No sets.
    fn default() -> Self {
        Self::of_points(&[])
    }
}

impl PartialEq for UvSets<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.iter().eq(other.iter())
    }
}

impl<'a> UvSets<'a> {
    /// A single set that equals the surface's parameters s and t.
    #[inline]
    pub fn of_parameters(st: DVec2) -> Self {
        Self(Source::Parameters(st))
    }

    /// Sets that are already known.
    #[inline]
    pub fn of_points(points: &'a [UvPoint]) -> Self {
        Self(Source::Points(points))
    }

    #[inline]
    pub(crate) fn of_triangle(point: TrianglePoint<'a>) -> Self {
        Self(Source::Triangle(point))
    }

    /// The number of sets.
    pub fn len(&self) -> usize {
        match self.0 {
            Source::Parameters(_) => 1,
            Source::Points(points) => points.len(),
            Source::Triangle(point) => point.sets.len(),
        }
    }

    /// Whether there are no texture coordinates.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The set with this index; a missing set is zero everywhere.
    #[inline]
    pub fn get(&self, set: usize) -> UvPoint {
        match self.0 {
            Source::Parameters(uv) if set == 0 => UvPoint { uv, ds: DVec2::X, dt: DVec2::Y },
            Source::Parameters(_) => UvPoint::default(),
            Source::Points(points) => points.get(set).copied().unwrap_or_default(),
            Source::Triangle(point) => point.get(set),
        }
    }

    /// All sets in their order.
    pub fn iter(&self) -> impl Iterator<Item = UvPoint> {
        (0..self.len()).map(|set| self.get(set))
    }
}

impl TrianglePoint<'_> {
    fn get(&self, set: usize) -> UvPoint {
        let Some(set) = self.sets.get(set) else { return UvPoint::default() };
        let [a, b, c] = self.corners.map(|k| Vec2::from(set[k as usize]).as_dvec2());
        let (ds, dt) = edges_with_area([b - a, c - a]);
        UvPoint { uv: a * self.weights.x + b * self.weights.y + c * self.weights.z, ds, dt }
    }
}

/// Minimum texture-space area of a triangle, as a fraction of the product of its sides. Smaller triangles do not
/// determine the directions of u and v, because single floats cannot resolve them.
const MIN_UV_SINE: f64 = 1e-7;

/// Two edges of a triangle in texture coordinates; zero if they span no area.
fn edges_with_area([ds, dt]: [DVec2; 2]) -> (DVec2, DVec2) {
    let has_area = ds.perp_dot(dt).abs() > MIN_UV_SINE * ds.length() * dt.length();
    if has_area { (ds, dt) } else { (DVec2::ZERO, DVec2::ZERO) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(u: f64) -> UvPoint {
        UvPoint { uv: DVec2::splat(u), ds: DVec2::X, dt: DVec2::Y }
    }

    #[test]
    fn missing_sets_are_zero() {
        let points = [point(1.0), point(2.0)];
        let sets = UvSets::of_points(&points);
        assert_eq!((sets.len(), sets.get(1), sets.get(2)), (2, point(2.0), UvPoint::default()));
        let parameters = UvSets::of_parameters(DVec2::splat(3.0));
        assert_eq!(
            (parameters.len(), parameters.get(0), parameters.get(1)),
            (1, point(3.0), UvPoint::default())
        );
        assert!(UvSets::default().is_empty());
    }

    #[test]
    fn a_triangle_interpolates_each_of_its_sets() {
        let set = vec![[0.0, 1.0], [9.0, 9.0], [1.0, 1.0], [0.0, 3.0]];
        let line = vec![[0.0, 0.0], [9.0, 9.0], [1.0, 1.0], [2.0, 2.0]];
        let (corners, weights) = ([0, 2, 3], DVec3::new(0.25, 0.5, 0.25));
        let sets = [set, line];
        let sets = UvSets::of_triangle(TrianglePoint { sets: &sets, corners, weights });
        let along = |x: f64, y: f64| DVec2::new(x, y);
        assert_eq!(sets.get(0), UvPoint { uv: along(0.5, 1.5), ds: along(1.0, 0.0), dt: along(0.0, 2.0) });
        // Without an area there are coordinates, but no derivatives.
        assert_eq!(sets.get(1), UvPoint { uv: along(1.0, 1.0), ds: DVec2::ZERO, dt: DVec2::ZERO });
        assert_eq!((sets.len(), sets.get(2)), (2, UvPoint::default()));
    }

    #[test]
    fn equal_sets_are_equal_however_they_are_stored() {
        let (points, others) = ([point(3.0)], [point(4.0)]);
        let parameters = UvSets::of_parameters(DVec2::splat(3.0));
        assert_eq!(parameters, UvSets::of_points(&points));
        assert_ne!(parameters, UvSets::of_points(&others));
        assert_ne!(parameters, UvSets::default());
    }
}
