//! Cutting a component at the lines of the unit grid.

use std::collections::HashMap;

use glam::{DVec2, DVec3};

use super::{Beyond, seams};
use crate::mesh::SEAM;
use crate::normals_uv::NORMAL_UV;
use crate::rebuild::with_labels;
use crate::{Attribute, AttributeValues, Domain, GeometryError, Mesh, Topology};

/// Coordinates this close to a cutting line are put on it.
const SNAP: f64 = 1e-9;
/// Most periods a cyclic component may reach across.
const MAX_PERIODS: f64 = 1000.0;
/// Most pieces a component may be cut into.
const MAX_PIECES: u128 = 1 << 26;

/// `mesh`, whose positions are (u, v, w), cut as `x` and `y` say.
pub(super) fn cut(mesh: &Mesh, x: Beyond, y: Beyond) -> Result<Mesh, GeometryError> {
    check_periods(mesh, [x, y])?;
    let mut cutter = Cutter::new(mesh, [x, y]);
    let mut pieces = Vec::new();
    for face in 0..mesh.face_count() {
        let range = mesh.topology().corner_range(face);
        let corners = range.start as u32..range.end as u32;
        let polygon: Vec<_> = corners.zip(mesh.face(face)).map(Node::of).collect();
        for (polygon, u) in cutter.slabs(polygon, 0, x) {
            for (polygon, v) in cutter.slabs(polygon, 1, y) {
                pieces.push(Piece {
                    polygon,
                    cell: [u, v],
                    face: face as u32,
                });
            }
        }
    }
    assemble(mesh, &cutter, &pieces)
}

fn check_periods(mesh: &Mesh, beyond: [Beyond; 2]) -> Result<(), GeometryError> {
    let mut pieces = 0u128;
    for face in 0..mesh.face_count() {
        let places = || {
            mesh.face(face)
                .iter()
                .map(|&v| mesh.positions()[v as usize])
        };
        let mut here = 1u128;
        for (axis, beyond) in beyond.into_iter().enumerate() {
            let farthest = places().fold(0.0f64, |far, p| far.max(p[axis].abs()));
            if beyond != Beyond::Extend && farthest > MAX_PERIODS {
                return Err(GeometryError::OutOfRange {
                    what: "the component's distance from the unit square in periods",
                    value: farthest,
                    requirement: "Clip and Cyclic reach up to 1000; fit it with Bounds first",
                });
            }
            if beyond == Beyond::Cyclic {
                let low = places().fold(f64::INFINITY, |low, p| low.min(p[axis]));
                let high = places().fold(f64::NEG_INFINITY, |high, p| high.max(p[axis]));
                here *= (high.ceil() - low.floor()).max(1.0) as u128;
            }
        }
        pieces += here;
    }
    if pieces > MAX_PIECES {
        return Err(GeometryError::TooMany {
            what: "pieces of the component",
            count: pieces,
            limit: MAX_PIECES,
        });
    }
    Ok(())
}

/// A corner of a polygon being cut: ids of its vertex and its corner recipe, and
/// the component's corner whose edge leaves it, or [`CUT`].
#[derive(Clone, Copy)]
struct Node {
    vertex: u32,
    corner: u32,
    edge: u32,
}

/// Marks an edge that a cut made.
pub(super) const CUT: u32 = u32::MAX;

impl Node {
    fn of((corner, &vertex): (u32, &u32)) -> Self {
        Self {
            vertex,
            corner,
            edge: corner,
        }
    }
}

struct Piece {
    polygon: Vec<Node>,
    /// Whole numbers it has to be moved back by.
    cell: [i64; 2],
    face: u32,
}

/// How elements made by a cut are mixed from those of the component: ids below
/// `given` are the component's own.
struct Recipes {
    given: u32,
    made: Vec<Vec<(u32, f64)>>,
}

impl Recipes {
    fn new(given: usize) -> Self {
        Self {
            given: given as u32,
            made: Vec::new(),
        }
    }

    fn next(&self) -> u32 {
        self.given + self.made.len() as u32
    }

    /// Appends `weight` times the recipe of `id`.
    fn add(&self, id: u32, weight: f64, row: &mut Vec<(u32, f64)>) {
        let own = [(id, 1.0)];
        let parts = match id.checked_sub(self.given) {
            Some(made) => self.made[made as usize].as_slice(),
            None => &own,
        };
        for &(source, share) in parts {
            match row.iter_mut().find(|(other, _)| *other == source) {
                Some((_, sum)) => *sum += share * weight,
                None => row.push((source, share * weight)),
            }
        }
    }

    /// (1 - t) a + t b, as a new id.
    fn mix(&mut self, a: u32, b: u32, t: f64) -> u32 {
        let mut row = Vec::new();
        self.add(a, 1.0 - t, &mut row);
        self.add(b, t, &mut row);
        let id = self.next();
        self.made.push(row);
        id
    }
}

struct Cutter {
    positions: Vec<DVec3>,
    vertices: Recipes,
    corners: Recipes,
    /// Vertices made so far, by the edge, the axis and the line that cut it:
    /// neighbours find the same vertex.
    made: HashMap<(u32, u32, usize, i64), u32>,
}

impl Cutter {
    fn new(mesh: &Mesh, beyond: [Beyond; 2]) -> Self {
        let snap = |x: f64, beyond: Beyond| match beyond {
            Beyond::Extend => x,
            _ if (x - x.round()).abs() <= SNAP => x.round(),
            _ => x,
        };
        let place = |p: &DVec3| DVec3::new(snap(p.x, beyond[0]), snap(p.y, beyond[1]), p.z);
        Self {
            positions: mesh.positions().iter().map(place).collect(),
            vertices: Recipes::new(mesh.vertex_count()),
            corners: Recipes::new(mesh.corner_count()),
            made: HashMap::new(),
        }
    }

    fn at(&self, node: Node, axis: usize) -> f64 {
        self.positions[node.vertex as usize][axis]
    }

    /// The parts of a polygon to keep, each with the whole number it has to be
    /// moved back by along `axis`.
    fn slabs(&mut self, polygon: Vec<Node>, axis: usize, beyond: Beyond) -> Vec<(Vec<Node>, i64)> {
        match beyond {
            Beyond::Extend => vec![(polygon, 0)],
            Beyond::Clip => {
                let above = self.split(&polygon, axis, 0).1;
                let inside = above.and_then(|part| self.split(&part, axis, 1).0);
                inside.map(|part| (part, 0)).into_iter().collect()
            }
            Beyond::Cyclic => self.periods(polygon, axis),
        }
    }

    fn periods(&mut self, polygon: Vec<Node>, axis: usize) -> Vec<(Vec<Node>, i64)> {
        let places = || polygon.iter().map(|&node| self.at(node, axis));
        let first = places().fold(f64::INFINITY, f64::min).floor() as i64;
        let last = places().fold(f64::NEG_INFINITY, f64::max).ceil() as i64;
        if first == last {
            // Lies in a line: belongs to the cell nearer to the unit square.
            return vec![(polygon, if first >= 1 { first - 1 } else { first })];
        }
        let mut parts = Vec::new();
        let mut rest = polygon;
        for line in first + 1..last {
            let (below, above) = self.split(&rest, axis, line);
            parts.extend(below.map(|part| (part, line - 1)));
            match above {
                Some(part) => rest = part,
                None => return parts,
            }
        }
        parts.push((rest, last - 1));
        parts
    }

    /// The parts at or below and at or above a line (Sutherland and Hodgman
    /// 1974), each only if it has more than the line itself; a polygon in the
    /// line counts as both.
    fn split(
        &mut self,
        polygon: &[Node],
        axis: usize,
        line: i64,
    ) -> (Option<Vec<Node>>, Option<Vec<Node>>) {
        let level = line as f64;
        let is_below = polygon.iter().any(|&node| self.at(node, axis) < level);
        let is_above = polygon.iter().any(|&node| self.at(node, axis) > level);
        if !(is_below && is_above) {
            let whole = Some(polygon.to_vec());
            return match (is_below, is_above) {
                (true, _) => (whole, None),
                (_, true) => (None, whole),
                _ => (whole.clone(), whole),
            };
        }
        let (mut below, mut above) = (Vec::new(), Vec::new());
        for (k, &node) in polygon.iter().enumerate() {
            let next = polygon[(k + 1) % polygon.len()];
            let (here, there) = (self.at(node, axis), self.at(next, axis));
            if here <= level {
                below.push(node);
            }
            if here >= level {
                above.push(node);
            }
            if (here < level && there > level) || (here > level && there < level) {
                let cut = self.cut_edge(node, next, axis, line);
                below.push(cut);
                above.push(cut);
            }
        }
        let polygon = |mut nodes: Vec<Node>| {
            let lies_in = |node: Node| (self.at(node, axis) - level).abs() <= 0.0;
            // A part has an edge in the line only where it was cut.
            for k in 0..nodes.len() {
                if lies_in(nodes[k]) && lies_in(nodes[(k + 1) % nodes.len()]) {
                    nodes[k].edge = CUT;
                }
            }
            (nodes.len() >= 3).then_some(nodes)
        };
        (polygon(below), polygon(above))
    }

    fn cut_edge(&mut self, from: Node, to: Node, axis: usize, line: i64) -> Node {
        // Always from the lower vertex, so that both neighbours get the same bits.
        let (a, b) = if from.vertex < to.vertex {
            (from, to)
        } else {
            (to, from)
        };
        let (low, high) = (self.at(a, axis), self.at(b, axis));
        let t = (line as f64 - low) / (high - low);
        let corner = self.corners.mix(a.corner, b.corner, t);
        let (key, edge) = ((a.vertex, b.vertex, axis, line), from.edge);
        if let Some(&vertex) = self.made.get(&key) {
            return Node {
                vertex,
                corner,
                edge,
            };
        }
        let (start, end) = (
            self.positions[a.vertex as usize],
            self.positions[b.vertex as usize],
        );
        let mut position = start + (end - start) * t;
        position[axis] = line as f64;
        self.positions.push(position);
        let vertex = self.vertices.mix(a.vertex, b.vertex, t);
        self.made.insert(key, vertex);
        Node {
            vertex,
            corner,
            edge,
        }
    }
}

/// The mesh of all pieces, moved into the unit square. Vertices keep the
/// component's order; those made by cuts follow.
fn assemble(mesh: &Mesh, cutter: &Cutter, pieces: &[Piece]) -> Result<Mesh, GeometryError> {
    if pieces.is_empty() {
        return Err(GeometryError::Empty {
            what: "the component",
            missing: "faces inside the unit square",
        });
    }
    let key = |node: &Node, piece: &Piece| (node.vertex, piece.cell);
    let mut vertices: Vec<_> = pieces
        .iter()
        .flat_map(|piece| piece.polygon.iter().map(move |node| key(node, piece)))
        .collect();
    vertices.sort_unstable();
    vertices.dedup();
    let (mut offsets, mut corners, mut corner_rows) = (vec![0], Vec::new(), Vec::new());
    for piece in pieces {
        for node in &piece.polygon {
            let index = vertices.partition_point(|other| *other < key(node, piece));
            corners.push(index as u32);
            corner_rows.push(node.corner);
        }
        offsets.push(corners.len() as u32);
    }
    let back = |cell: [i64; 2]| DVec2::new(cell[0] as f64, cell[1] as f64);
    let positions = vertices
        .iter()
        .map(|&(vertex, cell)| cutter.positions[vertex as usize] - back(cell).extend(0.0))
        .collect();
    let topology = Topology::new(vertices.len(), offsets, corners)?;
    let faces: Vec<u32> = pieces.iter().map(|piece| piece.face).collect();
    let mut out = with_labels(mesh, Mesh::new(positions, topology.into())?, Some(&faces))?;
    let nodes = || pieces.iter().flat_map(|piece| &piece.polygon);
    let edges: Vec<u32> = nodes().map(|node| node.edge).collect();
    for attribute in mesh.attributes() {
        let values = match attribute.domain() {
            Domain::Face => attribute.values().gather(&faces),
            Domain::Corner if attribute.is_on_edges() => attribute.values().gather_or_zero(&edges),
            Domain::Corner => mixed(attribute, &cutter.corners, corner_rows.iter().copied()),
            Domain::Vertex => {
                let ids = vertices.iter().map(|&(vertex, _)| vertex);
                let values = mixed(attribute, &cutter.vertices, ids);
                let cells = vertices.iter().map(|&(_, cell)| back(cell));
                moved_with(attribute.name(), values, cells)
            }
        };
        out = out.with_attribute(attribute.with_values(values))?;
    }
    let seams = seams::seams(mesh, &edges);
    out.with_attribute(Attribute::new(SEAM, Domain::Corner, seams))
}

fn mixed(
    attribute: &Attribute,
    recipes: &Recipes,
    ids: impl Iterator<Item = u32>,
) -> AttributeValues {
    let (mut rows, mut ends) = (Vec::new(), vec![0]);
    let mut row = Vec::new();
    for id in ids {
        row.clear();
        recipes.add(id, 1.0, &mut row);
        rows.extend_from_slice(&row);
        ends.push(rows.len());
    }
    attribute
        .values()
        .combine(ends.windows(2).map(|range| &rows[range[0]..range[1]]))
}

/// Places where directions are read are on the face too: they move along.
fn moved_with(
    name: &str,
    values: AttributeValues,
    cells: impl Iterator<Item = DVec2>,
) -> AttributeValues {
    match values {
        AttributeValues::Vector2(places) if name == NORMAL_UV => AttributeValues::Vector2(
            places
                .iter()
                .zip(cells)
                .map(|(&uv, cell)| uv - cell)
                .collect(),
        ),
        values => values,
    }
}
