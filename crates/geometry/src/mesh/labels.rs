//! Materials, groups and objects: one label per face out of a short list.

use crate::GeometryError;
use crate::buffer::Buffer;
use crate::digest::Hasher;
use crate::mesh::Domain;

/// Marks a face without a label.
pub const NO_LABEL: u32 = u32::MAX;

/// A short list of labels and, for each face, which of them it has.
///
/// Either there is one index per face, or no face has a label and the index
/// list is empty.
#[derive(Debug, Clone, PartialEq)]
pub struct Labels<L> {
    labels: Vec<L>,
    of_face: Buffer<u32>,
}

impl<L> Default for Labels<L> {
    fn default() -> Self {
        Self {
            labels: Vec::new(),
            of_face: Buffer::default(),
        }
    }
}

impl<L> Labels<L> {
    /// `labels`, and for each face an index into them or [`NO_LABEL`].
    ///
    /// # Errors
    /// [`GeometryError::Invalid`] if an index has no label.
    pub fn new(labels: Vec<L>, of_face: Vec<u32>) -> Result<Self, GeometryError> {
        let valid = |&index: &u32| index == NO_LABEL || (index as usize) < labels.len();
        if let Some(face) = of_face.iter().position(|index| !valid(index)) {
            return Err(GeometryError::Invalid(format!(
                "face {face} has label {}, but there are {}",
                of_face[face],
                labels.len()
            )));
        }
        Ok(Self {
            labels,
            of_face: of_face.into(),
        })
    }

    /// The labels in order.
    pub fn labels(&self) -> &[L] {
        &self.labels
    }

    /// One index per face, or nothing when no face has a label.
    pub fn of_face(&self) -> &Buffer<u32> {
        &self.of_face
    }

    /// The label of `face`, if it has one.
    pub fn get(&self, face: usize) -> Option<&L> {
        self.labels.get(*self.of_face.get(face)? as usize)
    }

    /// Whether no face has a label.
    pub fn is_empty(&self) -> bool {
        self.of_face.is_empty()
    }

    /// Labels for faces taken from other faces: output face `i` is labelled as
    /// input face `source[i]`.
    ///
    /// # Panics
    /// If a source face does not exist.
    pub fn gather(&self, source: &[u32]) -> Self
    where
        L: Clone,
    {
        if self.is_empty() {
            return Self::default();
        }
        let of_face = source
            .iter()
            .map(|&face| self.of_face[face as usize])
            .collect();
        Self {
            labels: self.labels.clone(),
            of_face,
        }
    }

    pub(super) fn check(&self, name: &str, faces: usize) -> Result<(), GeometryError> {
        let actual = self.of_face.len();
        if actual == 0 || actual == faces {
            return Ok(());
        }
        let (domain, name) = (Domain::Face, name.to_owned());
        Err(GeometryError::AttributeLength {
            name,
            domain,
            expected: faces,
            actual,
        })
    }

    pub(super) fn feed(&self, hasher: &mut Hasher, feed_label: impl Fn(&L, &mut Hasher)) {
        hasher.number(self.labels.len() as u64);
        for label in &self.labels {
            feed_label(label, hasher);
        }
        hasher.digest(self.of_face.digest());
    }
}

/// How a face looks: the part of a material that OBJ and glTF share.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Its name, by which faces refer to it.
    pub name: String,
    /// Linear red, green, blue and opacity, each in 0..=1.
    pub base_color: [f64; 4],
    /// 0 for paint or stone, 1 for bare metal.
    pub metallic: f64,
    /// 0 for a mirror, 1 for chalk.
    pub roughness: f64,
}

impl Material {
    /// A light grey, rough material of that name.
    pub fn named(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            base_color: [0.8, 0.8, 0.8, 1.0],
            metallic: 0.0,
            roughness: 0.7,
        }
    }

    pub(super) fn feed(&self, hasher: &mut Hasher) {
        hasher.text(&self.name);
        for number in self
            .base_color
            .iter()
            .chain([&self.metallic, &self.roughness])
        {
            hasher.float(*number);
        }
    }
}
