//! A mesh that deforms: normal mapping with the tangents of the rest pose, with a frame from derivatives, and with
//! tangents computed again for every pose. Not a figure of a paper.

use std::sync::Arc;

use anyhow::Result;
use glam::DVec3;
use roughcast_scene::{
    Detail, DetailPoint, Mesh, Picture, Placement, Ray, Scene, Shape, SlopeDetail, SlopeMap, TangentSource,
    TriangleMesh, pattern, repeats,
};
use serde_json::{Map, Value, json};

use super::bumps::{Angles, angles, exact_normal, panels, picture, scene};
use super::deformation::{Deformation, Pipe};
use super::given::{Heights, heights_or, textured_mesh};
use super::{Args, Figure};

const SIZE: (u32, u32) = (320, 320);
/// The shape fills the picture.
const ZOOM: f64 = 1.0;
const TEXELS_PER_PIXEL: f64 = 0.8;
/// How much of the whole deformation each pose has.
const POSES: [f64; 3] = [0.0, 0.5, 1.0];

/// The largest mean angle of normals by derivatives to those of the exact frame of the pipe, in degrees: what its triangles,
/// 96 around it, differ from the smooth surface. Measured: 0.044 on raised squares, 0.062 on bricks.
const NEAR: f64 = 0.1;
/// How many times farther off normals with the tangents of the rest pose must be where the pipe is deformed. Measured: at
/// least 200.
const STALE: f64 = 50.0;

/// A mesh at rest, with MikkTSpace's tangents, and the map on it.
struct Subject {
    rest: Mesh,
    /// The formula of the mesh, unless it is from a file.
    formula: Option<Pipe>,
    heights: Heights,
    /// How often the map repeats: at rest a pixel spans [`TEXELS_PER_PIXEL`].
    repeats: f64,
    name: String,
}

impl Subject {
    /// The mesh and the map of the arguments, or a pipe with raised squares.
    fn new(args: &Args) -> Result<Self> {
        let heights = heights_or(args, || {
            let squares = pattern::raised_checker(128, 8, 4.0, 0.5);
            (squares, "raised squares of 128x128".to_owned())
        })?;
        let (given, formula, name) = match textured_mesh(args)? {
            Some((mesh, name)) => (mesh.triangles().clone(), None, name),
            None => (Pipe.triangles(), Some(Pipe), "a pipe".to_owned()),
        };
        let rest = with_new_tangents(given)?;
        let shown = scene(Shape::Mesh(Arc::new(rest.clone())), ZOOM);
        let texels = (heights.image.width(), heights.image.height());
        // A fractional number would show at the seam.
        let repeats = repeats(&shown.shape, &shown.camera, texels, SIZE, TEXELS_PER_PIXEL).round().max(1.0);
        let name = format!("{} on {name}", heights.name);
        Ok(Self { rest, formula, heights, repeats, name })
    }

    /// A pose at this fraction of the deformation.
    fn pose(&self, fraction: f64) -> Result<Pose> {
        let deformation = match self.formula {
            Some(_) => Deformation::of_pipe(fraction),
            None => Deformation::twist(self.rest.bounds(), fraction),
        };
        let deformed = deformation.mesh(&self.rest)?;
        let renewed = Arc::new(with_new_tangents(deformed.triangles().clone())?);
        let scene = Scene { repeats: self.repeats, ..scene(Shape::Mesh(Arc::new(deformed)), ZOOM) };
        let renewed = Scene { shape: Arc::new(Shape::Mesh(renewed)), ..scene.clone() };
        Ok(Pose { fraction, deformation, formula: self.formula, scene, renewed })
    }
}

/// The same triangles with MikkTSpace's tangents.
fn with_new_tangents(triangles: TriangleMesh) -> Result<Mesh> {
    Ok(Mesh::new(vec![TriangleMesh { tangents: Vec::new(), ..triangles }])?)
}

/// A deformed mesh.
struct Pose {
    fraction: f64,
    deformation: Deformation,
    formula: Option<Pipe>,
    /// With the tangents of the rest pose.
    scene: Scene,
    /// With tangents computed again.
    renewed: Scene,
}

/// The map by the tangents of the mesh, and by derivatives.
struct Bumps {
    tangents: SlopeDetail,
    derivatives: SlopeDetail,
}

impl Bumps {
    fn new(heights: &Heights) -> Result<Self> {
        let slopes = SlopeMap::of(&heights.image, &heights.source)?;
        let by = |source| {
            let placement = Placement::default().with_tangent_source(source);
            SlopeDetail::new(slopes.clone(), heights.source.wrap).placed(placement)
        };
        Ok(Self { tangents: by(TangentSource::Mesh), derivatives: by(TangentSource::Derivatives) })
    }
}

/// Angles in a pose between normals by three frames and those of a reference.
struct Deviations {
    stale: Angles,
    derivatives: Angles,
    renewed: Angles,
}

/// What is measured in a pose.
struct Measured {
    to_renewed: Deviations,
    /// With the frame of the formula as the reference, if there is one.
    to_exact: Option<Deviations>,
    /// The angle by which the bumps tilt the normal.
    tilt: Angles,
}

impl Pose {
    fn measured(&self, bumps: &Bumps) -> Measured {
        let renewed = |at: &DetailPoint<'_>| self.renewed_normal(&bumps.tangents, at);
        let exact = |at: &DetailPoint<'_>, pipe: Pipe| {
            let hit = pipe.exact_hit(at.hit(), &self.deformation);
            exact_normal(&bumps.derivatives, &DetailPoint::new(&hit, at.repeats()))
        };
        Measured {
            to_renewed: self.angles_to(bumps, &renewed),
            to_exact: self.formula.map(|pipe| self.angles_to(bumps, &|at: &DetailPoint<'_>| exact(at, pipe))),
            tilt: angles(&self.scene, SIZE, |at| [at.hit().frame.normal(), renewed(at)]),
        }
    }

    fn angles_to(&self, bumps: &Bumps, reference: &dyn Fn(&DetailPoint<'_>) -> DVec3) -> Deviations {
        let by =
            |detail: &SlopeDetail| angles(&self.scene, SIZE, |at| [exact_normal(detail, at), reference(at)]);
        Deviations {
            stale: by(&bumps.tangents),
            derivatives: by(&bumps.derivatives),
            renewed: angles(&self.scene, SIZE, |at| {
                [self.renewed_normal(&bumps.tangents, at), reference(at)]
            }),
        }
    }

    /// The normal at the same point of the mesh with new tangents.
    fn renewed_normal(&self, detail: &dyn Detail, at: &DetailPoint<'_>) -> DVec3 {
        let eye = self.renewed.camera.eye;
        let ray = Ray { origin: eye, direction: (at.hit().position - eye).normalize() };
        // By rounding the ray may miss a silhouette.
        let hit = self.renewed.shape.hit(&ray).unwrap_or(*at.hit());
        exact_normal(detail, &DetailPoint::new(&hit, at.repeats()))
    }

    fn pictures(&self, bumps: &Bumps) -> Result<Vec<(Picture, String)>> {
        let percent = 100.0 * self.fraction;
        let derivatives = picture(&self.scene, &bumps.derivatives, SIZE)?;
        if self.fraction == 0.0 {
            return Ok(vec![(derivatives, "at rest".to_owned())]);
        }
        Ok(vec![
            (picture(&self.scene, &bumps.tangents, SIZE)?, format!("{percent} %, tangents of the rest pose")),
            (derivatives, format!("{percent} %, derivatives, no tangents")),
            (picture(&self.renewed, &bumps.tangents, SIZE)?, format!("{percent} %, new tangents")),
        ])
    }
}

impl Measured {
    /// Adds the mean angles of a pose to the numbers of the figure.
    fn add_to(&self, numbers: &mut Map<String, Value>, fraction: f64) {
        let mut add = |what: &str, angles: &Angles| {
            let name = format!("deformed by {} %: mean angle of {what}, degrees", 100.0 * fraction);
            numbers.insert(name, json!(angles.mean));
        };
        if let Some(to_exact) = &self.to_exact {
            add("derivatives to exact", &to_exact.derivatives);
            add("tangents of the rest pose to exact", &to_exact.stale);
            add("new tangents to exact", &to_exact.renewed);
        }
        add("derivatives to new tangents", &self.to_renewed.derivatives);
        add("tangents of the rest pose to new tangents", &self.to_renewed.stale);
        add("the bumps themselves", &self.tilt);
    }

    /// Whether a pose supports the claim.
    fn holds(&self, fraction: f64) -> bool {
        let is_rest = fraction == 0.0;
        match &self.to_exact {
            Some(Deviations { stale, derivatives, .. }) => {
                derivatives.mean <= NEAR && (is_rest || stale.mean >= STALE * derivatives.mean)
            }
            None => is_rest || self.to_renewed.stale.mean > self.to_renewed.derivatives.mean,
        }
    }
}

pub fn make(args: &Args) -> Result<Figure> {
    let subject = Subject::new(args)?;
    let bumps = Bumps::new(&subject.heights)?;
    let (mut numbers, mut pictures, mut holds) = (Map::new(), Vec::new(), true);
    for fraction in POSES {
        let pose = subject.pose(fraction)?;
        let measured = pose.measured(&bumps);
        measured.add_to(&mut numbers, fraction);
        holds &= measured.holds(fraction);
        pictures.extend(pose.pictures(&bumps)?);
    }
    let claim = match subject.formula {
        Some(_) => format!(
            "in every pose normals by derivatives, without tangents, are on average within {NEAR}° of those of the exact frame; with the tangents \
             of the rest pose they are at least {STALE} times farther off"
        ),
        None => "in every pose normals by derivatives, without tangents, are on average nearer to those with MikkTSpace's tangents of that \
                 pose than normals with the tangents of the rest pose are"
            .to_owned(),
    };
    Ok(Figure {
        title: "a mesh that deforms",
        claim,
        numbers,
        holds,
        making: format!(
            "{}, {}, by its positions and normals alone. New tangents are those of MikkTSpace, computed for the pose. {}x{} pixels, \
             {TEXELS_PER_PIXEL} texels a pixel.",
            subject.name,
            Deformation::about(subject.formula.is_some()),
            SIZE.0,
            SIZE.1
        ),
        panels: panels(pictures),
        charts: Vec::new(),
        table: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn angles(mean: f64) -> Angles {
        Angles { mean, largest: mean }
    }

    fn deviations(derivatives: f64, stale: f64) -> Deviations {
        Deviations { stale: angles(stale), derivatives: angles(derivatives), renewed: angles(0.0) }
    }

    #[test]
    fn the_claim_fails_where_it_should() {
        let measured = |to_renewed, to_exact| Measured { to_renewed, to_exact, tilt: angles(10.0) };
        let of_pipe =
            |derivatives, stale| measured(deviations(1.0, 5.0), Some(deviations(derivatives, stale)));
        assert!(of_pipe(0.5 * NEAR, 5.0).holds(1.0));
        assert!(!of_pipe(2.0 * NEAR, 100.0).holds(1.0), "not exact");
        assert!(!of_pipe(2.0 * NEAR, 100.0).holds(0.0), "not exact at rest");
        assert!(!of_pipe(0.5 * NEAR, 0.4 * STALE * NEAR).holds(1.0), "stale tangents are as good");
        assert!(of_pipe(0.5 * NEAR, 0.0).holds(0.0), "at rest they are right");
        assert!(measured(deviations(1.0, 2.0), None).holds(1.0));
        assert!(!measured(deviations(2.0, 1.0), None).holds(1.0));
    }
}
