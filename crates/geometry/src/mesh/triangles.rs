//! The one triangulation of a mesh's polygons.

use std::cell::Cell;

use glam::DVec3;

use super::Mesh;
use crate::normals::newell;
use crate::parallel::{self, fill_runs, zeroed};
use crate::{GeometryError, Monitor, Unmonitored};

/// How often ear clipping looks at a corner of one face before it gives up: a
/// second or two, hundreds of times what faces that people draw need.
const MOST_LOOKS: u64 = 1 << 28;

/// Triangles of all faces, and where each face's triangles start.
#[derive(Debug, Clone, PartialEq)]
pub struct Triangles {
    /// Corner numbers (indices into [`crate::Topology::corners`]) of each triangle.
    pub corners: Vec<[u32; 3]>,
    /// The face each triangle belongs to; ascending.
    pub faces: Vec<u32>,
}

impl Mesh {
    /// The surface of the mesh as triangles: of each face the fan from its
    /// first corner, or ear clipping where that fan is not simple.
    ///
    /// A non-planar polygon has no one surface; this is the one that distances,
    /// areas, intersections and file writers of this crate all mean. A face of
    /// n corners gives n - 2 triangles. Cost: O(corners) on
    /// all threads, and O(n²) for a
    /// concave face of n corners, up to 2²⁸ looks at corners: the rest of a face
    /// that takes more, one of tens of thousands of corners, is a fan.
    pub fn triangles(&self) -> Triangles {
        self.triangles_with(&Unmonitored)
            .expect("only a monitor stops this")
    }

    /// [`Mesh::triangles`], for an operation that may be stopped.
    ///
    /// # Errors
    /// [`GeometryError::Cancelled`] when `monitor` asks to stop.
    pub fn triangles_with(&self, monitor: &dyn Monitor) -> Result<Triangles, GeometryError> {
        // A face of n corners gives n - 2 triangles, so all of them know their places.
        let offsets = self.topology().offsets().iter().zip(0u32..);
        let starts: Vec<u32> = offsets.map(|(offset, face)| offset - 2 * face).collect();
        let count = starts.last().map_or(0, |&end| end as usize);
        let mut corners = zeroed(count);
        fill_runs(
            &mut corners,
            &starts,
            monitor,
            Vec::new,
            |ears, face, run| self.cut(face, ears, run),
        )?;
        let mut faces = zeroed(count);
        fill_runs(
            &mut faces,
            &starts,
            monitor,
            || (),
            |(), face, run| {
                run.fill(face as u32);
            },
        )?;
        Ok(Triangles { corners, faces })
    }

    /// Whether [`Mesh::triangles`] cuts every face into the fan from its first
    /// corner, so that the triangles follow from the topology alone. Cost:
    /// O(corners) on all threads, a fraction of what cutting takes.
    pub fn is_cut_into_fans(&self) -> bool {
        let topology = self.topology();
        if topology.corner_count() == 3 * topology.face_count() {
            return true;
        }
        // One offset more than faces, and the last one begins none.
        let faces = &topology.offsets()[1..];
        parallel::all(faces, |first, ends| {
            (first..first + ends.len()).all(|face| self.is_fan(face))
        })
    }

    fn is_fan(&self, face: usize) -> bool {
        let vertices = self.face(face);
        let place = |k: usize| self.positions()[vertices[k] as usize];
        vertices.len() == 3 || is_simple_fan(vertices.len(), place)
    }

    /// The triangles of one face.
    fn cut(&self, face: usize, ears: &mut Vec<[u32; 3]>, out: &mut [[u32; 3]]) {
        let start = self.topology().corner_range(face).start as u32;
        if self.is_fan(face) {
            for (triangle, k) in out.iter_mut().zip(start + 1..) {
                *triangle = [start, k, k + 1];
            }
        } else {
            let vertices = self.face(face);
            let place = |k: usize| self.positions()[vertices[k] as usize];
            clip_ears(vertices.len(), place, ears);
            for (triangle, ear) in out.iter_mut().zip(ears) {
                *triangle = ear.map(|k| start + k);
            }
        }
    }

    /// Calls `take` with the face and the corners of each triangle of `faces`, in
    /// the order of [`Mesh::triangles`], which it does without memory for all.
    pub fn for_triangles(
        &self,
        faces: impl IntoIterator<Item = usize>,
        mut take: impl FnMut(usize, [u32; 3]),
    ) {
        let (mut ears, mut run) = (Vec::new(), Vec::new());
        for face in faces {
            run.clear();
            run.resize(self.face(face).len() - 2, [0; 3]);
            self.cut(face, &mut ears, &mut run);
            run.iter().for_each(|&triangle| take(face, triangle));
        }
    }

    /// The vertices of each triangle of [`Mesh::triangles`].
    pub fn triangle_vertices(&self, triangles: &Triangles) -> Vec<[u32; 3]> {
        let corners = self.topology().corners();
        triangles
            .corners
            .iter()
            .map(|triangle| triangle.map(|c| corners[c as usize]))
            .collect()
    }
}

fn normal_of(count: usize, place: impl Fn(usize) -> DVec3) -> DVec3 {
    newell((0..count).map(place))
}

/// Whether no triangle of the fan from corner 0 turns against the polygon's normal.
fn is_simple_fan(count: usize, place: impl Fn(usize) -> DVec3) -> bool {
    if count == 4 {
        // Most polygons: what the normal is the sum of is what is compared with it.
        let arm = |k: usize| place(k) - place(0);
        let (first, second) = (arm(1).cross(arm(2)), arm(2).cross(arm(3)));
        let normal = first + second;
        return first.dot(normal) >= 0.0 && second.dot(normal) >= 0.0;
    }
    let normal = normal_of(count, &place);
    (1..count - 1).all(|k| {
        let cross = (place(k) - place(0)).cross(place(k + 1) - place(0));
        cross.dot(normal) >= 0.0
    })
}

/// Ear clipping in the plane of the polygon's Newell normal; `ears` receives
/// corner triples. Always yields `count - 2` triangles: when rounding or a
/// self-crossing outline leaves no ear, the corner with the largest turn is cut,
/// and what is left after [`MOST_LOOKS`] becomes a fan.
fn clip_ears(count: usize, place: impl Fn(usize) -> DVec3, ears: &mut Vec<[u32; 3]>) {
    let normal = normal_of(count, &place);
    ears.clear();
    let mut ring: Vec<u32> = (0..count as u32).collect();
    let at = |corner: u32| place(corner as usize);
    let turn = |a: u32, b: u32, c: u32| (at(b) - at(a)).cross(at(c) - at(b)).dot(normal);
    let looks = Cell::new(0u64);
    while ring.len() > 3 && looks.get() < MOST_LOOKS {
        let n = ring.len();
        let triple = |k: usize| (ring[(k + n - 1) % n], ring[k], ring[(k + 1) % n]);
        let is_ear = |&k: &usize| {
            let (a, b, c) = triple(k);
            looks.set(looks.get() + 1);
            looks.get() < MOST_LOOKS
                && turn(a, b, c) > 0.0
                && ring
                    .iter()
                    .filter(|&&p| p != a && p != b && p != c)
                    .all(|&p| {
                        looks.set(looks.get() + 1);
                        // Outside or on the border of the candidate triangle.
                        turn(a, b, p) <= 0.0 || turn(b, c, p) <= 0.0 || turn(c, a, p) <= 0.0
                    })
        };
        let widest = || {
            let by_turn = |&i: &usize, &j: &usize| {
                let (a, b) = (triple(i), triple(j));
                turn(a.0, a.1, a.2).total_cmp(&turn(b.0, b.1, b.2))
            };
            (0..n).max_by(by_turn).unwrap_or(0)
        };
        // Corner 0 is tried last, so that fans from it are kept where possible.
        let k = (1..n).chain([0]).find(is_ear).unwrap_or_else(widest);
        let (a, b, c) = triple(k);
        ears.push([a, b, c]);
        ring.remove(k);
    }
    ears.extend((1..ring.len() - 1).map(|k| [ring[0], ring[k], ring[k + 1]]));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square and a quad beside it whose second corner lies at (x, x).
    fn squares(x: f64) -> Mesh {
        let at = |x: f64, y: f64| [x, y, 0.0];
        let mut places = vec![at(-1.0, 0.0), at(-1.0, 1.0)];
        places.extend([at(0.0, 0.0), at(1.0, 0.0), at(x, x), at(0.0, 1.0)]);
        let faces: [&[u32]; 2] = [&[0, 2, 5, 1], &[3, 4, 5, 2]];
        Mesh::from_faces(places, &faces).unwrap()
    }

    #[test]
    fn a_mesh_is_cut_into_fans_exactly_if_all_its_faces_are() {
        for x in [1.0, 0.6, 0.5, 0.4, 0.1, -0.5] {
            let mesh = squares(x);
            let starts = mesh.topology().offsets();
            let fans = (0..2).flat_map(|face| {
                let start = starts[face];
                (start + 1..starts[face + 1] - 1).map(move |k| [start, k, k + 1])
            });
            let is_fans = mesh.triangles().corners == fans.collect::<Vec<_>>();
            assert_eq!(mesh.is_cut_into_fans(), is_fans, "{x}");
        }
        assert!(squares(1.0).is_cut_into_fans() && !squares(0.4).is_cut_into_fans());
    }
}
