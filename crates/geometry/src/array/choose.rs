//! Which component each face takes.

use crate::random::uniform;
use crate::subdivide::Parents;
use crate::{Field, GeometryError, Mesh, Topology};

/// Marks a face that takes no component.
pub const NO_COMPONENT: u32 = u32::MAX;

/// One component index per value of `index`, rounded down; below 0 for none.
///
/// # Errors
/// [`GeometryError::Invalid`] names the first element whose index is not below
/// `components`.
pub fn choose_by_index(index: &Field, components: usize) -> Result<Vec<u32>, GeometryError> {
    let domain = index.domain();
    let choose = |(element, &value): (usize, &f64)| {
        let index = value.floor();
        if index < 0.0 {
            Ok(NO_COMPONENT)
        } else if index < components as f64 {
            Ok(index as u32)
        } else {
            Err(GeometryError::Invalid(format!(
                "{domain} {element} asks for component {index}, but there are {components}, \
                 counted from 0"
            )))
        }
    };
    index.values().iter().enumerate().map(choose).collect()
}

/// For each face of `base` the index of its material's name in `names`;
/// [`NO_COMPONENT`] for other materials and for none.
pub fn choose_by_material(base: &Mesh, names: &[String]) -> Vec<u32> {
    let of_label: Vec<u32> = base
        .materials()
        .labels()
        .iter()
        .map(|material| {
            let found = names.iter().position(|name| *name == material.name);
            found.map_or(NO_COMPONENT, |k| k as u32)
        })
        .collect();
    let of_face = base.materials().of_face();
    (0..base.face_count())
        .map(|face| {
            let label = of_face.get(face).copied().unwrap_or(crate::NO_LABEL);
            of_label
                .get(label as usize)
                .copied()
                .unwrap_or(NO_COMPONENT)
        })
        .collect()
}

/// A random component for each of `ids`, by weight.
///
/// The choice depends on the seed and the id alone, so a panel keeps its
/// component when others come or go. `weights` are relative frequencies, one
/// per component.
///
/// # Errors
/// [`GeometryError::OutOfRange`] for weights that are negative, not finite or
/// all zero.
pub fn choose_random(ids: &[i64], weights: &[f64], seed: u64) -> Result<Vec<u32>, GeometryError> {
    let total: f64 = weights.iter().sum();
    let bad = weights
        .iter()
        .copied()
        .find(|w| !(*w >= 0.0 && w.is_finite()));
    if bad.is_some() || !(total > 0.0 && total.is_finite()) {
        return Err(GeometryError::OutOfRange {
            what: "a weight of the random choice",
            value: bad.unwrap_or(total),
            requirement: "weights must be finite, not negative, and not all zero",
        });
    }
    let pick = |&id: &i64| {
        let mut left = uniform(seed, id) * total;
        for (index, &weight) in weights.iter().enumerate() {
            if left < weight {
                return index as u32;
            }
            left -= weight;
        }
        // Rounding can leave a hair: the last component that has a weight.
        weights
            .iter()
            .rposition(|&weight| weight > 0.0)
            .unwrap_or(0) as u32
    };
    Ok(ids.iter().map(pick).collect())
}

/// Components in order along a gradient: value 0 takes the first, 1 the last.
///
/// Values are clamped to 0..=1 and cut into equal bands. `randomness` in 0..=1
/// blurs the bands: each value moves up or down by at most half of it, by a
/// random amount that depends on seed and id (one per value) alone.
///
/// # Errors
/// [`GeometryError::OutOfRange`] for a randomness outside 0..=1,
/// [`GeometryError::Empty`] without components, [`GeometryError::FieldLength`]
/// when there are not as many ids as values.
pub fn choose_along(
    gradient: &Field,
    ids: &[i64],
    components: usize,
    randomness: f64,
    seed: u64,
) -> Result<Vec<u32>, GeometryError> {
    if !(0.0..=1.0).contains(&randomness) {
        return Err(GeometryError::OutOfRange {
            what: "the randomness",
            value: randomness,
            requirement: "it must be from 0 to 1",
        });
    }
    if components == 0 {
        return Err(GeometryError::Empty {
            what: "the array",
            missing: "component",
        });
    }
    if ids.len() != gradient.values().len() {
        return Err(GeometryError::FieldLength {
            domain: gradient.domain(),
            expected: ids.len(),
            actual: gradient.values().len(),
        });
    }
    let choose = |(&value, &id): (&f64, &i64)| {
        let value = value.clamp(0.0, 1.0) + (uniform(seed, id) - 0.5) * randomness;
        let band = (value * components as f64).floor();
        band.clamp(0.0, components as f64 - 1.0) as u32
    };
    Ok(gradient.values().iter().zip(ids).map(choose).collect())
}

/// `choice` with `component` on every face at an open border.
pub fn choose_at_border(topology: &Topology, choice: &[u32], component: u32) -> Vec<u32> {
    let border = border_faces(topology);
    let pairs = choice.iter().zip(&border);
    pairs
        .map(|(&other, &at)| if at { component } else { other })
        .collect()
}

/// Whether each face has a border edge.
pub fn border_faces(topology: &Topology) -> Vec<bool> {
    let counts = border_edge_counts(topology).into_iter();
    counts.map(|count| count > 0).collect()
}

/// How many border edges each face has.
pub fn border_edge_counts(topology: &Topology) -> Vec<u32> {
    let count = |face: usize| {
        let edges = 0..topology.face(face).len();
        edges.filter(|&k| is_border(topology, face, k)).count() as u32
    };
    (0..topology.face_count()).map(count).collect()
}

/// Quarter turns that bring the border of each face to its side v = 0, 0 for
/// faces inside; at a corner of the base the next border edge is u = 1.
pub fn border_turns(topology: &Topology) -> Vec<u8> {
    let turns = |face: usize| {
        if topology.face(face).len() != 4 {
            return 0;
        }
        let border = |k: usize| is_border(topology, face, k % 4);
        turns_to([0, 1, 2, 3].map(border))
    };
    (0..topology.face_count()).map(turns).collect()
}

/// As [`border_edge_counts`] for the sides of the parents of a subdivided mesh; 0
/// for those without a whole grid.
pub fn border_side_counts(parents: &Parents) -> Vec<u32> {
    let sides = (0..parents.len()).map(|patch| patch_sides(parents, patch));
    let count = |sides: [bool; 4]| sides.into_iter().map(u32::from).sum();
    sides.map(count).collect()
}

/// As [`border_turns`] for the parents of a subdivided mesh.
pub fn border_patch_turns(parents: &Parents) -> Vec<u8> {
    let sides = (0..parents.len()).map(|patch| patch_sides(parents, patch));
    sides.map(turns_to).collect()
}

/// Quarter turns that bring the first of the sides in a run to side 0.
fn turns_to(sides: [bool; 4]) -> u8 {
    // In the sense of the face.
    let first = (0..4).find(|&k| sides[k] && !sides[(k + 3) % 4]);
    first.map_or(0, |k| (4 - k as u8) % 4)
}

/// Which sides of a patch lie on an open border: v = 0, u = 1, v = 1, u = 0.
fn patch_sides(parents: &Parents, patch: usize) -> [bool; 4] {
    let Some(grid) = parents.whole_grid(patch) else {
        return [false; 4];
    };
    let last = grid.side() - 1;
    // Cells have their corners in the order of the patch, so the k-th side of a
    // patch is the k-th edge of its cells there.
    let cells = [(0, 0), (last, 0), (last, last), (0, last)];
    [0, 1, 2, 3].map(|k| is_border(parents.topology(), grid.face(cells[k].0, cells[k].1), k))
}

fn is_border(topology: &Topology, face: usize, k: usize) -> bool {
    let adjacency = topology.adjacency();
    let edge = adjacency.corner_edges()[topology.corner_range(face).start + k];
    edge != crate::NO_EDGE && adjacency.is_boundary_edge(edge as usize)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Domain, Quantity, test_support};

    fn field(values: &[f64]) -> Field {
        Field::new(Domain::Face, Quantity::Number, values.to_vec()).unwrap()
    }

    fn grid(nx: u32, ny: u32) -> Mesh {
        test_support::grid(nx, ny, |x, y| [x, y, 0.0])
    }

    #[test]
    fn indices_are_checked() {
        let chosen = choose_by_index(&field(&[0.9, 1.0, -0.5]), 2).unwrap();
        assert_eq!(chosen, [0, 1, NO_COMPONENT]);
        let error = choose_by_index(&field(&[0.0, 2.0]), 2)
            .unwrap_err()
            .to_string();
        assert!(
            error.contains("face 1") && error.contains("component 2"),
            "{error}"
        );
    }

    #[test]
    fn random_choices_follow_weights_and_keep_with_their_id() {
        let ids: Vec<i64> = (0..10_000).collect();
        let chosen = choose_random(&ids, &[1.0, 0.0, 3.0], 7).unwrap();
        let share = chosen.iter().filter(|&&k| k == 2).count() as f64 / 1e4;
        // Three standard deviations of a share of 3/4 in 10 000 draws are 0.013.
        assert!((share - 0.75).abs() < 0.013, "{share}");
        assert!(!chosen.contains(&1));
        let some = choose_random(&ids[5000..], &[1.0, 0.0, 3.0], 7).unwrap();
        assert_eq!(some, chosen[5000..]);
        assert!(choose_random(&ids, &[0.0], 7).is_err());
        assert!(choose_random(&ids, &[f64::NAN], 7).is_err());
    }

    #[test]
    fn a_gradient_is_cut_into_bands() {
        let values = field(&[-1.0, 0.0, 0.34, 0.66, 0.67, 1.0, 2.0]);
        let ids: Vec<i64> = (0..7).collect();
        let chosen = choose_along(&values, &ids, 3, 0.0, 1).unwrap();
        assert_eq!(chosen, [0, 0, 1, 1, 2, 2, 2]);
        assert!(choose_along(&values, &ids, 3, 1.5, 1).is_err());
    }

    #[test]
    fn patches_turn_as_the_faces_they_come_from() {
        use crate::subdivide::{Options, subdivide};
        let base = grid(3, 2);
        for levels in 1..=2 {
            let options = Options {
                levels,
                ..Options::default()
            };
            let fine = subdivide(&base, options, &crate::Unmonitored).unwrap();
            let (topology, parents) = (base.topology(), &fine.parents);
            assert_eq!(border_side_counts(parents), border_edge_counts(topology));
            assert_eq!(border_patch_turns(parents), border_turns(topology));
        }
    }

    #[test]
    fn borders_turn_to_the_side_v_0() {
        let base = grid(3, 3);
        let border = border_faces(base.topology());
        assert_eq!(border.iter().filter(|&&at| at).count(), 8);
        assert!(!border[4]);
        let counts = border_edge_counts(base.topology());
        assert_eq!(counts, [2, 1, 2, 1, 0, 1, 2, 1, 2]);
        for (face, turns) in border_turns(base.topology()).into_iter().enumerate() {
            let corners = base.face(face);
            let first = corners[(4 - turns as usize) % 4];
            let second = corners[(5 - turns as usize) % 4];
            let edge = |v: u32| base.positions()[v as usize];
            let on = |axis: usize, x: f64| {
                (edge(first)[axis] - x).abs() + (edge(second)[axis] - x).abs() < 1e-12
            };
            let at_border = on(0, 0.0) || on(0, 3.0) || on(1, 0.0) || on(1, 3.0);
            assert_eq!(at_border, border[face], "face {face} turned by {turns}");
        }
        let choice = choose_at_border(base.topology(), &[0; 9], 1);
        assert_eq!(choice, [1, 1, 1, 1, 0, 1, 1, 1, 1]);
    }
}
