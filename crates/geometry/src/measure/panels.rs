//! What a fabricator needs to know of each panel.

use glam::DVec3;

use super::blank::{Moments, blank};
use super::planarity;
use crate::array::{BASE_FACE, COMPONENT, PANEL};
use crate::intersect::components;
use crate::mesh::{AttributeValues, Domain};
use crate::surface::{Border, Surface};
use crate::{GeometryError, Mesh, Monitor};

/// One component of an array, measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Its id, from face attribute [`PANEL`]; its number where there is none.
    pub id: i64,
    /// The base face it lies on, if the mesh says so.
    pub base_face: Option<i64>,
    /// Which component it is a copy of, if the mesh says so.
    pub component: Option<i64>,
    /// How many faces it has.
    pub faces: usize,
    /// Extent along x, y and z, in metres.
    pub size: DVec3,
    /// Length, width and depth of the smallest sheet it can be cut from, in metres:
    /// in the plane that fits its surface best the rectangle of least area, and
    /// across it the depth.
    pub blank: [f64; 3],
    /// Area of its faces in m².
    pub area: f64,
    /// Enclosed volume in m³; `None` unless its faces close it.
    pub volume: Option<f64>,
    /// Largest distance of a face's corner to the face's best plane, in metres.
    pub planarity: f64,
    /// Least, mean and largest distance of its vertices to the base, in metres.
    pub thickness: Option<[f64; 3]>,
}

/// How thickness is measured in [`panels`].
#[derive(Debug, Clone, Copy)]
pub struct PanelBase<'a> {
    /// The base surface.
    pub surface: &'a Surface,
    /// How distances beyond its border are measured.
    pub border: Border,
    /// Vertices at most this far from it are left out; negative for none.
    pub ignore_below: f64,
}

/// What is gathered of one panel.
#[derive(Clone, Copy)]
struct Gathered {
    first: usize,
    faces: usize,
    low: DVec3,
    high: DVec3,
    moments: Moments,
    area: f64,
    volume: f64,
    planarity: f64,
    least: f64,
    most: f64,
    sum: f64,
    count: usize,
}

impl Gathered {
    fn new(first: usize) -> Self {
        Self {
            first,
            faces: 0,
            low: DVec3::INFINITY,
            high: DVec3::NEG_INFINITY,
            moments: Moments::default(),
            area: 0.0,
            volume: 0.0,
            planarity: 0.0,
            least: f64::INFINITY,
            most: 0.0,
            sum: 0.0,
            count: 0,
        }
    }

    fn add_distance(&mut self, distance: f64) {
        self.least = self.least.min(distance);
        self.most = self.most.max(distance);
        self.sum += distance;
        self.count += 1;
    }
}

/// The panels of an array in the order of their first faces: those of face
/// attribute [`PANEL`], or the connected pieces of a mesh without.
///
/// Thickness is that of each panel's vertices over `base`, where one is given.
/// Cost: O(corners · log corners), and with a base O(vertices · log triangles).
///
/// # Errors
/// [`GeometryError::Cancelled`].
pub fn panels(
    mesh: &Mesh,
    base: Option<&PanelBase<'_>>,
    monitor: &dyn Monitor,
) -> Result<Vec<Panel>, GeometryError> {
    let (of_face, count) = components(mesh, monitor)?;
    let mut gathered: Vec<Gathered> = Vec::with_capacity(count);
    for (face, &panel) in of_face.iter().enumerate() {
        if panel as usize == gathered.len() {
            gathered.push(Gathered::new(face));
        }
        gathered[panel as usize].faces += 1;
    }
    gather_shapes(mesh, &of_face, &mut gathered);
    let planarity = planarity(mesh, monitor)?;
    for (&panel, face) in of_face.iter().zip(&planarity) {
        let panel = &mut gathered[panel as usize];
        panel.planarity = panel.planarity.max(face.plane);
    }
    let uses = vertices_of_panels(mesh, &of_face);
    if let Some(base) = base {
        gather_distances(mesh, &uses, base, &mut gathered, monitor)?;
    }
    let blanks = blanks(mesh, &uses, &gathered);
    let open = open_panels(mesh, &of_face, count);
    let integer =
        |name: &str, face: usize| match mesh.attribute(name, Domain::Face).map(|a| a.values()) {
            Some(AttributeValues::Integer(values)) => Some(values[face]),
            _ => None,
        };
    let panel = |(number, of): (usize, &Gathered)| Panel {
        id: integer(PANEL, of.first).unwrap_or(number as i64),
        base_face: integer(BASE_FACE, of.first),
        component: integer(COMPONENT, of.first),
        faces: of.faces,
        size: of.high - of.low,
        blank: blanks[number],
        area: of.area,
        volume: (!open[number]).then_some(of.volume),
        planarity: of.planarity,
        thickness: (of.count > 0).then(|| [of.least, of.sum / of.count as f64, of.most]),
    };
    Ok(gathered.iter().enumerate().map(panel).collect())
}

/// Boxes, areas and volumes; volumes about each panel's first corner, so that
/// panels far from the origin keep their digits.
fn gather_shapes(mesh: &Mesh, of_face: &[u32], gathered: &mut [Gathered]) {
    let positions = mesh.positions();
    let triangles = mesh.triangles();
    let vertices = mesh.triangle_vertices(&triangles);
    for (&face, triangle) in triangles.faces.iter().zip(&vertices) {
        let panel = &mut gathered[of_face[face as usize] as usize];
        let middle = positions[mesh.face(panel.first)[0] as usize];
        let [a, b, c] = triangle.map(|vertex| positions[vertex as usize] - middle);
        let cross = (b - a).cross(c - a);
        panel.area += cross.length() * 0.5;
        panel.moments.add([a, b, c], cross.length() * 0.5);
        panel.volume += a.dot(cross) / 6.0;
        for place in [a, b, c] {
            panel.low = panel.low.min(place);
            panel.high = panel.high.max(place);
        }
    }
}

/// The vertices of each panel, each once: (panel, vertex), ascending.
fn vertices_of_panels(mesh: &Mesh, of_face: &[u32]) -> Vec<(u32, u32)> {
    let mut uses: Vec<(u32, u32)> = Vec::with_capacity(mesh.corner_count());
    for (face, &panel) in of_face.iter().enumerate() {
        uses.extend(mesh.face(face).iter().map(|&vertex| (panel, vertex)));
    }
    uses.sort_unstable();
    uses.dedup();
    uses
}

/// The blank of each panel, measured about its first corner.
fn blanks(mesh: &Mesh, uses: &[(u32, u32)], gathered: &[Gathered]) -> Vec<[f64; 3]> {
    let of_panel = |uses: &[(u32, u32)]| {
        let panel = &gathered[uses[0].0 as usize];
        let middle = mesh.positions()[mesh.face(panel.first)[0] as usize];
        let place = |&(_, vertex): &(u32, u32)| mesh.positions()[vertex as usize] - middle;
        blank(&uses.iter().map(place).collect::<Vec<_>>(), &panel.moments)
    };
    uses.chunk_by(|a, b| a.0 == b.0).map(of_panel).collect()
}

/// Distances of each panel's vertices.
fn gather_distances(
    mesh: &Mesh,
    uses: &[(u32, u32)],
    base: &PanelBase<'_>,
    gathered: &mut [Gathered],
    monitor: &dyn Monitor,
) -> Result<(), GeometryError> {
    let found = base
        .surface
        .distances(mesh.positions(), base.border, monitor)?;
    for &(panel, vertex) in uses {
        let distance = found[vertex as usize].0;
        if distance > base.ignore_below {
            gathered[panel as usize].add_distance(distance);
        }
    }
    Ok(())
}

/// Whether some edge of a panel has not as many faces of it in one sense as in
/// the other, so that nothing is enclosed.
fn open_panels(mesh: &Mesh, of_face: &[u32], count: usize) -> Vec<bool> {
    let mut edges: Vec<(u32, [u32; 2], i32)> = Vec::with_capacity(mesh.corner_count());
    for (face, &panel) in of_face.iter().enumerate() {
        let vertices = mesh.face(face);
        for (k, &a) in vertices.iter().enumerate() {
            let b = vertices[(k + 1) % vertices.len()];
            let sense = if a < b { 1 } else { -1 };
            if a != b {
                edges.push((panel, [a.min(b), a.max(b)], sense));
            }
        }
    }
    edges.sort_unstable();
    let mut open = vec![false; count];
    for run in edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let balance: i32 = run.iter().map(|edge| edge.2).sum();
        open[run[0].0 as usize] |= balance != 0;
    }
    open
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::{cuboid, grid};
    use crate::{Unmonitored, join};

    #[test]
    fn boxes_on_a_floor_have_closed_forms() {
        let floor = grid(4, 4, |x, y| [x, y, 0.0]);
        let far = |mesh: &Mesh, way: DVec3| {
            mesh.with_positions(mesh.positions().iter().map(|&p| p + way).collect())
                .unwrap()
        };
        let one = cuboid(1.0, 2.0, 0.0, 0.5);
        let two = far(&cuboid(1.0, 1.0, 0.25, 0.75), DVec3::new(2.0, 2.0, 0.0));
        let mesh = join(&[&one, &two]).unwrap();
        let surface = Surface::new(&floor, &Unmonitored).unwrap();
        let base = PanelBase {
            surface: &surface,
            border: Border::Clip,
            ignore_below: 0.1,
        };
        let found = panels(&mesh, Some(&base), &Unmonitored).unwrap();
        assert_eq!(found.len(), 2);
        assert_eq!(
            (found[0].id, found[0].faces, found[0].base_face),
            (0, 6, None)
        );
        assert_eq!(found[0].size, DVec3::new(1.0, 2.0, 0.5));
        for (found, expected) in found[0].blank.into_iter().zip([2.0, 1.0, 0.5]) {
            assert!((found - expected).abs() < 1e-14);
        }
        assert!((found[0].area - 7.0).abs() < 1e-14);
        assert!((found[0].volume.unwrap() - 1.0).abs() < 1e-14);
        assert_eq!(found[0].thickness, Some([0.5; 3]));
        assert_eq!(found[1].thickness, Some([0.25, 0.5, 0.75]));
    }

    #[test]
    fn an_open_panel_has_no_volume() {
        let found = panels(&grid(2, 2, |x, y| [x, y, 0.0]), None, &Unmonitored).unwrap();
        assert_eq!(
            (found.len(), found[0].volume, found[0].thickness),
            (1, None, None)
        );
        assert!((found[0].area - 4.0).abs() < 1e-15);
    }
}
