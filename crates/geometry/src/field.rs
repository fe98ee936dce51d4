//! Scalars over a mesh, and numbers that may vary over it.

use std::fmt;
use std::sync::Arc;

use crate::buffer::Buffer;
use crate::digest::{Digest, Hasher};
use crate::mesh::Domain;
use crate::{GeometryError, Mesh, parallel};

/// What a number measures; decides its unit where it meets a reader.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Quantity {
    /// A plain number: a weight, a count, a ratio.
    #[default]
    Number,
    /// A length in metres.
    Length,
    /// An area in square metres.
    Area,
    /// A volume in cubic metres.
    Volume,
    /// An angle in radians.
    Angle,
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Number => "number",
            Self::Length => "length",
            Self::Area => "area",
            Self::Volume => "volume",
            Self::Angle => "angle",
        })
    }
}

/// One finite scalar per vertex or per face.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    domain: Domain,
    quantity: Quantity,
    values: Buffer<f64>,
}

impl Field {
    /// A field of `values`, one per element of `domain`.
    ///
    /// # Errors
    /// [`GeometryError::NonFiniteValue`] names the first NaN or infinity;
    /// [`GeometryError::Invalid`] for a domain other than vertices and faces.
    pub fn new(
        domain: Domain,
        quantity: Quantity,
        values: Vec<f64>,
    ) -> Result<Self, GeometryError> {
        if domain == Domain::Corner {
            return Err(GeometryError::Invalid(
                "a field is on vertices or faces, not corners".into(),
            ));
        }
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            return Err(GeometryError::NonFiniteValue {
                what: "the field's value",
                domain,
                index,
            });
        }
        Ok(Self {
            domain,
            quantity,
            values: values.into(),
        })
    }

    /// The elements the field is on.
    pub fn domain(&self) -> Domain {
        self.domain
    }

    /// What its values measure.
    pub fn quantity(&self) -> Quantity {
        self.quantity
    }

    /// The values, one per element of the domain.
    pub fn values(&self) -> &Buffer<f64> {
        &self.values
    }

    /// The smallest and the largest value; `None` of a field without values.
    ///
    /// Cost: O(values), in parallel.
    pub fn range(&self) -> Option<(f64, f64)> {
        parallel::range(self.values.len(), |index| self.values[index])
    }

    /// The same field with every value multiplied: a change of units.
    pub fn scaled(&self, factor: f64, quantity: Quantity) -> Self {
        let values = self.values.iter().map(|value| value * factor).collect();
        Self {
            domain: self.domain,
            quantity,
            values,
        }
    }

    /// Content digest: domain, quantity and values.
    pub fn digest(&self) -> Digest {
        Hasher::new()
            .text("field")
            .number(self.domain as u64)
            .number(self.quantity as u64)
            .digest(self.values.digest())
            .finish()
    }

    /// Checks that the field has one value per element of `domain` of `mesh`.
    ///
    /// # Errors
    /// [`GeometryError::FieldDomain`] or [`GeometryError::FieldLength`].
    pub fn check(&self, mesh: &Mesh, domain: Domain) -> Result<(), GeometryError> {
        let expected = mesh.element_count(domain);
        if self.domain != domain {
            return Err(GeometryError::FieldDomain {
                expected: domain,
                actual: self.domain,
            });
        }
        if self.values.len() != expected {
            let actual = self.values.len();
            return Err(GeometryError::FieldLength {
                domain,
                expected,
                actual,
            });
        }
        Ok(())
    }
}

/// A number that is the same everywhere, or given element by element.
#[derive(Debug, Clone, PartialEq)]
pub enum Amount {
    /// The same number everywhere.
    Constant(f64),
    /// One number per element.
    Field(Arc<Field>),
}

impl Amount {
    /// The number at element `index`.
    ///
    /// # Panics
    /// If it is a field with no such element; [`Amount::check`] rules that out.
    pub fn at(&self, index: usize) -> f64 {
        match self {
            Self::Constant(number) => *number,
            Self::Field(field) => field.values[index],
        }
    }

    /// Checks that there is a number for every element of `domain` of `mesh`.
    ///
    /// # Errors
    /// As [`Field::check`]; a constant fits everywhere.
    pub fn check(&self, mesh: &Mesh, domain: Domain) -> Result<(), GeometryError> {
        match self {
            Self::Constant(_) => Ok(()),
            Self::Field(field) => field.check(mesh, domain),
        }
    }

    /// The number at a corner: that of `face`, or of `vertex` for a field on
    /// vertices.
    ///
    /// # Panics
    /// If it is a field with no such element; [`Amount::check_corners`] rules that out.
    pub(crate) fn at_corner(&self, face: usize, vertex: u32) -> f64 {
        match self {
            Self::Field(field) if field.domain == Domain::Face => field.values[face],
            _ => self.at(vertex as usize),
        }
    }

    /// Checks that there is a number for every vertex or for every face of `mesh`.
    ///
    /// # Errors
    /// [`GeometryError::FieldLength`].
    pub(crate) fn check_corners(&self, mesh: &Mesh) -> Result<(), GeometryError> {
        match self {
            Self::Constant(_) => Ok(()),
            Self::Field(field) => field.check(mesh, field.domain),
        }
    }

    /// The numbers of all elements of `domain` of `mesh`, as a field.
    ///
    /// # Errors
    /// As [`Amount::check`]; [`GeometryError::NonFiniteValue`] for a constant.
    pub fn on(&self, mesh: &Mesh, domain: Domain) -> Result<Arc<Field>, GeometryError> {
        self.check(mesh, domain)?;
        match self {
            Self::Field(field) => Ok(Arc::clone(field)),
            Self::Constant(number) => {
                let values = vec![*number; mesh.element_count(domain)];
                Field::new(domain, Quantity::Number, values).map(Arc::new)
            }
        }
    }

    /// The elements of a field, or `otherwise` for a constant, which is on all.
    pub fn domain_or(&self, otherwise: Domain) -> Domain {
        match self {
            Self::Constant(_) => otherwise,
            Self::Field(field) => field.domain(),
        }
    }

    /// The smallest and the largest number that occurs; the constant twice, and
    /// infinity and its opposite for a field without values.
    pub fn range(&self) -> (f64, f64) {
        match self {
            Self::Constant(number) => (*number, *number),
            Self::Field(field) => field.range().unwrap_or((f64::INFINITY, f64::NEG_INFINITY)),
        }
    }
}

impl From<f64> for Amount {
    fn from(number: f64) -> Self {
        Self::Constant(number)
    }
}
