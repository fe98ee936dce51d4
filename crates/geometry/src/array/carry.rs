//! Attributes of the base brought onto the array.

use std::ops::{Add, Mul};

use bytemuck::Zeroable;

use super::basis::Weights;
use super::layout::Layout;
use super::map::Map;
use super::{ArrayOptions, Piece};
use crate::{Attribute, AttributeValues, Domain, GeometryError, Mesh, Monitor, parallel};

/// `mesh` with the attributes of `base` that `options.carry` names.
pub(super) fn carry(
    base: &Mesh,
    mut mesh: Mesh,
    pieces: &[Piece],
    layout: &Layout<'_>,
    map: &Map<'_>,
    options: &ArrayOptions<'_>,
    monitor: &dyn Monitor,
) -> Result<Mesh, GeometryError> {
    let carrier = Carrier {
        pieces,
        layout,
        map,
        monitor,
    };
    for name in options.carry {
        // Corners and faces of a base with parents are those of the small faces.
        let usable = |a: &&Attribute| a.domain() == Domain::Vertex || layout.is_by_face();
        let mut found = false;
        for attribute in base
            .attributes()
            .iter()
            .filter(usable)
            .filter(|a| a.name() == name)
        {
            found = true;
            mesh = mesh.with_attribute(attribute.with_values(carrier.values(attribute)?))?;
        }
        if !found {
            let available = base.attributes().iter().filter(usable);
            return Err(GeometryError::NoAttribute {
                name: name.clone(),
                wanted: if layout.is_by_face() {
                    "base"
                } else {
                    "base vertex"
                },
                available: available.map(|a| a.name().to_owned()).collect(),
            });
        }
    }
    Ok(mesh)
}

struct Carrier<'a> {
    pieces: &'a [Piece],
    layout: &'a Layout<'a>,
    map: &'a Map<'a>,
    monitor: &'a dyn Monitor,
}

impl Carrier<'_> {
    fn values(&self, attribute: &Attribute) -> Result<AttributeValues, GeometryError> {
        fn blend<T>(values: &[T], grid: &[u32], at: &Weights) -> T
        where
            T: Copy + Add<Output = T> + Mul<f64, Output = T>,
        {
            let [a, b, c, d] = at.at.map(|k| values[grid[k as usize] as usize]);
            let [p, q, r, s] = at.weight;
            (a * p + b * q) + (c * r + d * s)
        }
        let domain = attribute.domain();
        Ok(match attribute.values() {
            AttributeValues::Integer(values) => {
                let nearest =
                    |v: &[i64], grid: &[u32], at: &Weights| v[grid[at.nearest() as usize] as usize];
                AttributeValues::Integer(self.fill(domain, values, nearest)?.into())
            }
            AttributeValues::Number(values) => {
                AttributeValues::Number(self.fill(domain, values, blend)?.into())
            }
            AttributeValues::Vector2(values) => {
                AttributeValues::Vector2(self.fill(domain, values, blend)?.into())
            }
            AttributeValues::Vector3(values) => {
                AttributeValues::Vector3(self.fill(domain, values, blend)?.into())
            }
        })
    }

    /// One value per output element of `domain`, by `at` from the base's values
    /// under it.
    fn fill<T: Copy + Zeroable + Send + Sync>(
        &self,
        domain: Domain,
        values: &[T],
        at: impl Fn(&[T], &[u32], &Weights) -> T + Sync,
    ) -> Result<Vec<T>, GeometryError> {
        let layout = self.layout;
        let starts = match domain {
            Domain::Vertex => &layout.vertex_starts,
            Domain::Face => &layout.face_starts,
            Domain::Corner => &layout.corner_starts,
        };
        let mut out = parallel::zeroed(starts.last().map_or(0, |&count| count as usize));
        parallel::fill_runs(
            &mut out,
            starts,
            self.monitor,
            Vec::new,
            |grid, run, slots| {
                let placement = layout.placements[run];
                let points = &self.map.bases[self.map.basis_of[run] as usize].points;
                match domain {
                    Domain::Face => slots.fill(values[placement.cell as usize]),
                    Domain::Vertex => {
                        layout.grid(run, grid);
                        for (slot, point) in slots.iter_mut().zip(points) {
                            *slot = at(values, grid, &point.place);
                        }
                    }
                    Domain::Corner => {
                        let grid = layout.corner_grid(run);
                        let corners = self.pieces[placement.component as usize]
                            .mesh
                            .topology()
                            .corners();
                        for (slot, &vertex) in slots.iter_mut().zip(corners.iter()) {
                            *slot = at(values, &grid, &points[vertex as usize].place);
                        }
                    }
                }
            },
        )?;
        Ok(out)
    }
}
