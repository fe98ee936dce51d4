//! Named values on vertices, faces or corners.

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::Domain;
use crate::GeometryError;
use crate::buffer::Buffer;
use crate::digest::{Digest, Hasher};
use crate::subdivide::CREASE;

/// Edge attribute that is 1 on the edges at which a component was cut.
pub const SEAM: &str = "seam";

/// The values of an attribute, one per element of its domain.
#[derive(Debug, Clone, PartialEq)]
pub enum AttributeValues {
    /// Whole numbers: indices, ids.
    Integer(Buffer<i64>),
    /// Scalars.
    Number(Buffer<f64>),
    /// Pairs: texture coordinates.
    Vector2(Buffer<DVec2>),
    /// Triples: directions, linear colours.
    Vector3(Buffer<DVec3>),
}

impl AttributeValues {
    /// How many values there are.
    pub fn len(&self) -> usize {
        match self {
            Self::Integer(values) => values.len(),
            Self::Number(values) => values.len(),
            Self::Vector2(values) => values.len(),
            Self::Vector3(values) => values.len(),
        }
    }

    /// Whether there are no values.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The type in words: "integer", "number", "2D vector", "3D vector".
    pub fn type_name(&self) -> &'static str {
        match self {
            Self::Integer(_) => "integer",
            Self::Number(_) => "number",
            Self::Vector2(_) => "2D vector",
            Self::Vector3(_) => "3D vector",
        }
    }

    /// The values as numbers to calculate with; `None` of vectors. Whole numbers
    /// above 2^53, which would be ids, are rounded.
    pub fn numbers(&self) -> Option<Vec<f64>> {
        match self {
            Self::Number(values) => Some(values.to_vec()),
            Self::Integer(values) => Some(values.iter().map(|&number| number as f64).collect()),
            Self::Vector2(_) | Self::Vector3(_) => None,
        }
    }

    /// Whether the values are numbers, not vectors.
    pub fn is_numeric(&self) -> bool {
        matches!(self, Self::Number(_) | Self::Integer(_))
    }

    /// The values at `indices`, in that order, and 0 for [`u32::MAX`].
    pub(crate) fn gather_or_zero(&self, indices: &[u32]) -> Self {
        fn pick<T: Copy + Default>(values: &[T], indices: &[u32]) -> Buffer<T> {
            let value = |&index: &u32| match index {
                u32::MAX => T::default(),
                index => values[index as usize],
            };
            indices.iter().map(value).collect()
        }
        match self {
            Self::Integer(values) => Self::Integer(pick(values, indices)),
            Self::Number(values) => Self::Number(pick(values, indices)),
            Self::Vector2(values) => Self::Vector2(pick(values, indices)),
            Self::Vector3(values) => Self::Vector3(pick(values, indices)),
        }
    }

    /// The values at `indices`, in that order.
    ///
    /// # Panics
    /// If an index is out of range.
    pub fn gather(&self, indices: &[u32]) -> Self {
        fn pick<T: Copy + Send + Sync>(values: &Buffer<T>, indices: &[u32]) -> Buffer<T> {
            let picked: Vec<T> = indices
                .par_iter()
                .with_min_len(crate::parallel::CHUNK)
                .map(|&index| values[index as usize])
                .collect();
            picked.into()
        }
        match self {
            Self::Integer(values) => Self::Integer(pick(values, indices)),
            Self::Number(values) => Self::Number(pick(values, indices)),
            Self::Vector2(values) => Self::Vector2(pick(values, indices)),
            Self::Vector3(values) => Self::Vector3(pick(values, indices)),
        }
    }

    /// Weighted sums of values: `rows` yields for each output its (index,
    /// weight) pairs. Integers cannot be averaged and take the value of the
    /// heaviest index, the first of equals.
    pub fn combine<'a>(&self, rows: impl Iterator<Item = &'a [(u32, f64)]>) -> Self {
        fn sum<T, R>(values: &[T], rows: R) -> Buffer<T>
        where
            T: Copy + Default + std::ops::Add<Output = T> + std::ops::Mul<f64, Output = T>,
            R: Iterator<Item: IntoIterator<Item = (usize, f64)>>,
        {
            rows.map(|row| {
                row.into_iter().fold(T::default(), |sum, (index, weight)| {
                    sum + values[index] * weight
                })
            })
            .collect()
        }
        let plain = rows.map(|row| row.iter().map(|&(index, weight)| (index as usize, weight)));
        match self {
            Self::Integer(values) => Self::Integer(
                plain
                    .map(|row| {
                        let heaviest = row.fold((0, f64::NEG_INFINITY), |best, item| {
                            if item.1 > best.1 { item } else { best }
                        });
                        values[heaviest.0]
                    })
                    .collect(),
            ),
            Self::Number(values) => Self::Number(sum(values, plain)),
            Self::Vector2(values) => Self::Vector2(sum(values, plain)),
            Self::Vector3(values) => Self::Vector3(sum(values, plain)),
        }
    }

    /// The values of `self` followed by those of `other`; `None` if the types differ.
    pub fn concat(&self, other: &Self) -> Option<Self> {
        fn join<T: Copy>(a: &Buffer<T>, b: &Buffer<T>) -> Buffer<T> {
            a.iter().chain(b.iter()).copied().collect()
        }
        Some(match (self, other) {
            (Self::Integer(a), Self::Integer(b)) => Self::Integer(join(a, b)),
            (Self::Number(a), Self::Number(b)) => Self::Number(join(a, b)),
            (Self::Vector2(a), Self::Vector2(b)) => Self::Vector2(join(a, b)),
            (Self::Vector3(a), Self::Vector3(b)) => Self::Vector3(join(a, b)),
            _ => return None,
        })
    }

    fn first_non_finite(&self) -> Option<usize> {
        match self {
            Self::Integer(_) => None,
            Self::Number(values) => values.iter().position(|value| !value.is_finite()),
            Self::Vector2(values) => values.iter().position(|value| !value.is_finite()),
            Self::Vector3(values) => values.iter().position(|value| !value.is_finite()),
        }
    }

    fn digest(&self) -> Digest {
        match self {
            Self::Integer(values) => values.digest(),
            Self::Number(values) => values.digest(),
            Self::Vector2(values) => values.digest(),
            Self::Vector3(values) => values.digest(),
        }
    }
}

/// A named list of values, one per element of a domain.
#[derive(Debug, Clone, PartialEq)]
pub struct Attribute {
    name: String,
    domain: Domain,
    values: AttributeValues,
}

impl Attribute {
    /// An attribute of that name; the mesh it is added to checks the length.
    pub fn new(name: impl Into<String>, domain: Domain, values: AttributeValues) -> Self {
        Self {
            name: name.into(),
            domain,
            values,
        }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The elements it is on.
    pub fn domain(&self) -> Domain {
        self.domain
    }

    /// Its values, one per element of the domain.
    pub fn values(&self) -> &AttributeValues {
        &self.values
    }

    /// The same name and domain with other values.
    pub fn with_values(&self, values: AttributeValues) -> Self {
        Self {
            name: self.name.clone(),
            domain: self.domain,
            values,
        }
    }

    /// Whether its values belong to the edges that leave the corners, not to the
    /// corners: creases and seams.
    pub(crate) fn is_on_edges(&self) -> bool {
        self.domain == Domain::Corner && [CREASE, SEAM].contains(&self.name())
    }

    pub(super) fn check(&self, expected: usize) -> Result<(), GeometryError> {
        let actual = self.values.len();
        if actual != expected {
            let name = self.name.clone();
            return Err(GeometryError::AttributeLength {
                name,
                domain: self.domain,
                expected,
                actual,
            });
        }
        match self.values.first_non_finite() {
            Some(index) => Err(GeometryError::NonFiniteValue {
                what: "the attribute's value",
                domain: self.domain,
                index,
            }),
            None => Ok(()),
        }
    }

    pub(super) fn feed(&self, hasher: &mut Hasher) {
        hasher
            .text(&self.name)
            .number(self.domain as u64)
            .text(self.values.type_name())
            .digest(self.values.digest());
    }

    pub(super) fn storage(&self) -> (usize, usize) {
        match &self.values {
            AttributeValues::Integer(values) => (values.address(), values.byte_size()),
            AttributeValues::Number(values) => (values.address(), values.byte_size()),
            AttributeValues::Vector2(values) => (values.address(), values.byte_size()),
            AttributeValues::Vector3(values) => (values.address(), values.byte_size()),
        }
    }
}
