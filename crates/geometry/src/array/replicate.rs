//! Faces, attributes and labels of the components, once per placement.

use std::sync::Arc;

use bytemuck::Zeroable;
use glam::DVec3;

use super::layout::Layout;
use super::{BASE_FACE, COMPONENT, COMPONENT_FACE, PANEL, Piece};
use crate::normals_uv::NORMAL_UV;
use crate::{
    Attribute, AttributeValues, Domain, GeometryError, Labels, Mesh, Monitor, NO_LABEL, Topology,
    parallel,
};

/// The output mesh of `positions`, which are finite, with faces and all that
/// components carry.
pub(super) fn replicate(
    base: &Mesh,
    pieces: &[Piece],
    layout: &Layout<'_>,
    positions: Vec<DVec3>,
    monitor: &dyn Monitor,
) -> Result<Mesh, GeometryError> {
    let topology = topology(pieces, layout, positions.len(), monitor)?;
    let mut mesh = Mesh::of_finite(positions, Arc::new(topology))?
        .with_materials(labels(pieces, layout, Mesh::materials, monitor)?)?
        .with_groups(labels(pieces, layout, Mesh::groups, monitor)?)?
        .with_objects(labels(pieces, layout, Mesh::objects, monitor)?)?;
    for attribute in attributes(pieces)? {
        let values = copies(&attribute, pieces, layout, monitor)?;
        mesh = mesh.with_attribute(attribute.with_values(values))?;
    }
    with_provenance(base, pieces, layout, mesh, monitor)
}

fn topology(
    pieces: &[Piece],
    layout: &Layout<'_>,
    vertex_count: usize,
    monitor: &dyn Monitor,
) -> Result<Topology, GeometryError> {
    let component = |run: usize| {
        pieces[layout.placements[run].component as usize]
            .mesh
            .topology()
    };
    let count = layout
        .corner_starts
        .last()
        .map_or(0, |&count| count as usize);
    let mut corners: Vec<u32> = parallel::zeroed(count);
    parallel::fill_runs(
        &mut corners,
        &layout.corner_starts,
        monitor,
        || (),
        |(), run, slots| {
            let first = layout.vertex_starts[run];
            for (slot, &vertex) in slots.iter_mut().zip(component(run).corners().iter()) {
                *slot = first + vertex;
            }
        },
    )?;
    let count = layout.face_starts.last().map_or(0, |&count| count as usize);
    let mut offsets: Vec<u32> = parallel::zeroed(count + 1);
    parallel::fill_runs(
        &mut offsets[1..],
        &layout.face_starts,
        monitor,
        || (),
        |(), run, slots| {
            let first = layout.corner_starts[run];
            for (slot, &end) in slots.iter_mut().zip(&component(run).offsets()[1..]) {
                *slot = first + end;
            }
        },
    )?;
    Topology::of_sound(vertex_count, offsets, corners)
}

/// Every attribute some component has, in order of first appearance, except
/// the places of directions.
fn attributes(pieces: &[Piece]) -> Result<Vec<Attribute>, GeometryError> {
    let mut found: Vec<Attribute> = Vec::new();
    for (index, piece) in pieces.iter().enumerate() {
        for attribute in piece.mesh.attributes() {
            if (attribute.name(), attribute.domain()) == (NORMAL_UV, Domain::Vertex) {
                continue;
            }
            let same = |other: &&Attribute| {
                other.name() == attribute.name() && other.domain() == attribute.domain()
            };
            let Some(other) = found.iter().find(same) else {
                found.push(attribute.clone());
                continue;
            };
            let types = [other.values().type_name(), attribute.values().type_name()];
            if types[0] != types[1] {
                return Err(GeometryError::Invalid(format!(
                    "attribute `{}` is a {} in component {index}, but a {} in an earlier one",
                    attribute.name(),
                    types[1],
                    types[0]
                )));
            }
        }
    }
    Ok(found)
}

/// Values of an attribute for the whole output; zero on components without it.
fn copies(
    attribute: &Attribute,
    pieces: &[Piece],
    layout: &Layout<'_>,
    monitor: &dyn Monitor,
) -> Result<AttributeValues, GeometryError> {
    let domain = attribute.domain();
    let values: Vec<Option<&AttributeValues>> = pieces
        .iter()
        .map(|piece| {
            piece
                .mesh
                .attribute(attribute.name(), domain)
                .map(Attribute::values)
        })
        .collect();
    macro_rules! copy {
        ($kind:ident) => {{
            let of = |values: &Option<&'_ AttributeValues>| match values {
                Some(AttributeValues::$kind(values)) => values.to_vec(),
                _ => Vec::new(),
            };
            let rows: Vec<Vec<_>> = values.iter().map(of).collect();
            let starts = starts_of(layout, domain);
            AttributeValues::$kind(repeat(&rows, layout, starts, monitor)?.into())
        }};
    }
    Ok(match attribute.values() {
        AttributeValues::Integer(_) => copy!(Integer),
        AttributeValues::Number(_) => copy!(Number),
        AttributeValues::Vector2(_) => copy!(Vector2),
        AttributeValues::Vector3(_) => copy!(Vector3),
    })
}

fn starts_of<'a>(layout: &'a Layout<'_>, domain: Domain) -> &'a [u32] {
    match domain {
        Domain::Vertex => &layout.vertex_starts,
        Domain::Face => &layout.face_starts,
        Domain::Corner => &layout.corner_starts,
    }
}

/// The row of each placement's component, one after the other.
fn repeat<T: Zeroable + Copy + Send + Sync>(
    rows: &[Vec<T>],
    layout: &Layout<'_>,
    starts: &[u32],
    monitor: &dyn Monitor,
) -> Result<Vec<T>, GeometryError> {
    let count = starts.last().map_or(0, |&count| count as usize);
    let mut out = parallel::zeroed(count);
    parallel::fill_runs(
        &mut out,
        starts,
        monitor,
        || (),
        |(), run, slots| {
            let row = &rows[layout.placements[run].component as usize];
            if row.len() == slots.len() {
                slots.copy_from_slice(row);
            }
        },
    )?;
    Ok(out)
}

/// Labels of all components: equal labels become one.
fn labels<L: Clone + PartialEq>(
    pieces: &[Piece],
    layout: &Layout<'_>,
    of: fn(&Mesh) -> &Labels<L>,
    monitor: &dyn Monitor,
) -> Result<Labels<L>, GeometryError> {
    if pieces.iter().all(|piece| of(&piece.mesh).is_empty()) {
        return Ok(Labels::default());
    }
    let mut all: Vec<L> = Vec::new();
    let mut rows = Vec::new();
    for piece in pieces {
        let labels = of(&piece.mesh);
        let mut index = Vec::new();
        for label in labels.labels() {
            index.push(
                all.iter()
                    .position(|other| other == label)
                    .unwrap_or_else(|| {
                        all.push(label.clone());
                        all.len() - 1
                    }) as u32,
            );
        }
        let label_of = |face: usize| {
            let label = labels.of_face().get(face).copied().unwrap_or(NO_LABEL);
            index.get(label as usize).copied().unwrap_or(NO_LABEL)
        };
        rows.push((0..piece.mesh.face_count()).map(label_of).collect());
    }
    Labels::new(all, repeat(&rows, layout, &layout.face_starts, monitor)?)
}

fn with_provenance(
    base: &Mesh,
    pieces: &[Piece],
    layout: &Layout<'_>,
    mesh: Mesh,
    monitor: &dyn Monitor,
) -> Result<Mesh, GeometryError> {
    let starts = &layout.face_starts;
    let count = starts.last().map_or(0, |&count| count as usize);
    let per_placement = |name: &str, value: &(dyn Fn(usize) -> i64 + Sync)| {
        let mut out: Vec<i64> = parallel::zeroed(count);
        parallel::fill_runs(
            &mut out,
            starts,
            monitor,
            || (),
            |(), run, slots| {
                slots.fill(value(run));
            },
        )?;
        let values = AttributeValues::Integer(out.into());
        Ok::<_, GeometryError>(Attribute::new(name, Domain::Face, values))
    };
    let cell = |run: usize| i64::from(layout.placements[run].cell);
    let base_face = per_placement(BASE_FACE, &cell)?;
    let panel = match base.attribute(PANEL, Domain::Face).map(Attribute::values) {
        Some(AttributeValues::Integer(ids)) if layout.is_by_face() => {
            per_placement(PANEL, &|run| ids[layout.placements[run].cell as usize])?
        }
        // Without ids of its own the panel is the face, sharing its buffer.
        _ => Attribute::new(PANEL, Domain::Face, base_face.values().clone()),
    };
    let rows: Vec<Vec<i64>> = pieces
        .iter()
        .map(|piece| (0..piece.mesh.face_count() as i64).collect())
        .collect();
    let component_faces = repeat(&rows, layout, starts, monitor)?;
    let values = AttributeValues::Integer(component_faces.into());
    let mut mesh = mesh
        .with_attribute(base_face)?
        .with_attribute(Attribute::new(COMPONENT_FACE, Domain::Face, values))?
        .with_attribute(panel)?;
    if pieces.len() > 1 {
        let component = |run: usize| i64::from(layout.placements[run].component);
        mesh = mesh.with_attribute(per_placement(COMPONENT, &component)?)?;
    }
    Ok(mesh)
}
