//! Directions and the side of the faces round their vertex (§5).

use glam::DVec3;

use crate::math::unit_or_zero;
use crate::normals::{NormalWeights, face_normals, vertex_normals};
use crate::{Directions, GeometryError, Mesh, Monitor, parallel};

/// Least cosine to any adjacent face that keeping the side leaves, where the
/// faces allow it: 0.6 degrees above the face.
const LEAST: f64 = 0.01;

/// Steps towards the middle of a cone; its least cosine is then within a few
/// percent of the best.
const STEPS: usize = 64;

/// Vertices and faces where directions turn the thickness inside out.
#[derive(Debug, Clone, PartialEq)]
pub struct Inverted {
    /// Vertices whose direction D has D · face normal <= 0 for a face round
    /// them, ascending.
    pub vertices: Vec<u32>,
    /// Those faces, ascending.
    pub faces: Vec<u32>,
    /// The smallest D^ · face normal of all vertices and the faces round them; 1
    /// where there is nothing to look at.
    pub least_cosine: f64,
}

/// Finds inverted thickness (§5): directions that leave an adjacent face
/// behind them or lie in it.
///
/// Vectors of length zero and faces without normal are passed over; of
/// compensated directions both sides are looked at. Cost: O(corners).
///
/// # Errors
/// [`GeometryError::OtherTopology`], [`GeometryError::Cancelled`].
pub fn inverted(
    mesh: &Mesh,
    directions: &Directions,
    monitor: &dyn Monitor,
) -> Result<Inverted, GeometryError> {
    directions.check(mesh)?;
    let normals = face_normals(mesh, monitor)?;
    let symmetric = directions.is_symmetric();
    let cosine = |vector: DVec3, face: usize| match unit_or_zero(vector) {
        DVec3::ZERO => 1.0,
        _ if normals[face] == DVec3::ZERO => 1.0,
        unit => unit.dot(normals[face]),
    };
    let least = |vertex: u32, face: usize| {
        let outward = cosine(directions.outward()[vertex as usize], face);
        if symmetric {
            outward
        } else {
            outward.min(cosine(directions.inward()[vertex as usize], face))
        }
    };
    let cosines = parallel::map(mesh.face_count(), monitor, |face| {
        let corners = mesh.face(face).iter();
        corners.fold(1.0f64, |cosine, &vertex| cosine.min(least(vertex, face)))
    })?;
    let faces: Vec<u32> = (0..cosines.len() as u32)
        .filter(|&face| cosines[face as usize] <= 0.0)
        .collect();
    let corners = faces.iter().flat_map(|&face| {
        let vertices = mesh.face(face as usize).iter().copied();
        vertices.filter(move |&vertex| least(vertex, face as usize) <= 0.0)
    });
    let mut vertices: Vec<u32> = corners.collect();
    vertices.sort_unstable();
    vertices.dedup();
    Ok(Inverted {
        vertices,
        faces,
        least_cosine: cosines.into_iter().fold(1.0, f64::min),
    })
}

/// Turns each direction round that points against its vertex normal.
pub(super) fn flip(
    mesh: &Mesh,
    field: &mut [DVec3],
    monitor: &dyn Monitor,
) -> Result<(), GeometryError> {
    let normals = vertex_normals(mesh, NormalWeights::Angle, true, monitor)?;
    for (vector, normal) in field.iter_mut().zip(normals) {
        if vector.dot(normal) < 0.0 {
            *vector = -*vector;
        }
    }
    Ok(())
}

/// The cone of directions in front of all faces, at each vertex.
pub(super) struct Cones<'a> {
    mesh: &'a Mesh,
    normals: Vec<DVec3>,
    /// A direction well inside the cone, and the least cosine kept; zero where
    /// there is no cone.
    middles: Vec<(DVec3, f64)>,
}

impl<'a> Cones<'a> {
    pub(super) fn new(mesh: &'a Mesh, monitor: &dyn Monitor) -> Result<Self, GeometryError> {
        let normals = face_normals(mesh, monitor)?;
        let middles = parallel::map(mesh.vertex_count(), monitor, |vertex| {
            let (middle, least) = middle(around(mesh, &normals, vertex));
            if least > 0.0 {
                (middle, LEAST.min(0.5 * least))
            } else {
                (DVec3::ZERO, 0.0)
            }
        })?;
        Ok(Self {
            mesh,
            normals,
            middles,
        })
    }

    /// `wanted`, drawn towards the middle of the cone just far enough to be in it,
    /// as long as before. Where faces leave no cone it stays as it is.
    pub(super) fn limit(&self, vertex: usize, wanted: DVec3) -> DVec3 {
        let length = wanted.length();
        // Unit vectors are taken as they are, so that no pass changes them.
        if (length - 1.0).abs() <= 1e-12 {
            self.limit_unit(vertex, wanted)
        } else {
            self.limit_unit(vertex, unit_or_zero(wanted)) * length
        }
    }

    fn limit_unit(&self, vertex: usize, wanted: DVec3) -> DVec3 {
        let (middle, least) = self.middles[vertex];
        if middle == DVec3::ZERO || wanted == DVec3::ZERO {
            return wanted;
        }
        let mut share = 1.0f64;
        for normal in around(self.mesh, &self.normals, vertex) {
            let (inside, outside) = (middle.dot(normal), wanted.dot(normal));
            if outside < least {
                share = share.min((inside - least) / (inside - outside));
            }
        }
        if share < 1.0 {
            // Shorter than one before it is normalised, so cosines only grow.
            unit_or_zero(middle * (1.0 - share) + wanted * share)
        } else {
            wanted
        }
    }

    pub(super) fn limit_all(
        &self,
        mut field: Vec<DVec3>,
        monitor: &dyn Monitor,
    ) -> Result<Vec<DVec3>, GeometryError> {
        parallel::fill(&mut field, monitor, |vertex, vector| {
            *vector = self.limit(vertex, *vector);
        })?;
        Ok(field)
    }
}

/// Unit normals of the faces round a vertex, those without area left out.
fn around<'a>(
    mesh: &'a Mesh,
    normals: &'a [DVec3],
    vertex: usize,
) -> impl Iterator<Item = DVec3> + Clone + 'a {
    let adjacency = mesh.topology().adjacency();
    let corners = adjacency.vertex_corners(vertex).iter();
    corners
        .map(|&corner| normals[adjacency.corner_faces()[corner as usize] as usize])
        .filter(|&normal| normal != DVec3::ZERO)
}

/// A direction nearly as far in front of every face as possible, and its least
/// cosine, at most 0 where no direction is in front of all.
///
/// The middle of the smallest ball round the normals, by Bădoiu and Clarkson's
/// steps (2003) towards the farthest.
fn middle(normals: impl Iterator<Item = DVec3> + Clone) -> (DVec3, f64) {
    let sum = normals
        .clone()
        .fold(DVec3::ZERO, |sum, normal| sum + normal);
    let count = normals.clone().count();
    if count == 0 {
        return (DVec3::ZERO, 0.0);
    }
    let least = |v: DVec3| {
        normals
            .clone()
            .map(|n| n.dot(v))
            .fold(f64::INFINITY, f64::min)
    };
    let mut centre = sum / count as f64;
    let mut best = (unit_or_zero(centre), least(unit_or_zero(centre)));
    for step in 0..STEPS {
        let mut farthest = (-1.0, DVec3::ZERO);
        for normal in normals.clone() {
            let squared = (normal - centre).length_squared();
            if squared > farthest.0 {
                farthest = (squared, normal);
            }
        }
        centre += (farthest.1 - centre) / (step as f64 + 2.0);
        let unit = unit_or_zero(centre);
        let cosine = least(unit);
        if cosine > best.1 {
            best = (unit, cosine);
        }
    }
    best
}
