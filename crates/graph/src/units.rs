//! The unit of every length in a graph file.

use tessgraph_geometry::Quantity;
use tessgraph_geometry::math::PI;

use crate::value::six_digits;

/// Units of a graph file. Inside, everything is metres and radians; angles in
/// a file are degrees whatever its units.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Units {
    /// Metres.
    #[default]
    M,
    /// Centimetres.
    Cm,
    /// Millimetres.
    Mm,
    /// Feet of exactly 0.3048 m.
    Ft,
    /// Inches of exactly 0.0254 m.
    In,
}

impl Units {
    /// All units, in the order of their names in a file.
    pub const ALL: &'static [(&'static str, Self)] = &[
        ("M", Self::M),
        ("Cm", Self::Cm),
        ("Mm", Self::Mm),
        ("Ft", Self::Ft),
        ("In", Self::In),
    ];

    /// The units of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL
            .iter()
            .find(|(other, _)| *other == name)
            .map(|(_, units)| *units)
    }

    /// Metres per unit.
    pub fn metres(self) -> f64 {
        match self {
            Self::M => 1.0,
            Self::Cm => 0.01,
            Self::Mm => 0.001,
            Self::Ft => 0.3048,
            Self::In => 0.0254,
        }
    }

    /// The sign of the unit: m, cm, mm, ft, in.
    pub fn sign(self) -> &'static str {
        match self {
            Self::M => "m",
            Self::Cm => "cm",
            Self::Mm => "mm",
            Self::Ft => "ft",
            Self::In => "in",
        }
    }

    /// What a number of the file is multiplied by to be in SI units.
    pub fn to_si(self, quantity: Quantity) -> f64 {
        let metres = self.metres();
        match quantity {
            Quantity::Number => 1.0,
            Quantity::Length => metres,
            Quantity::Area => metres * metres,
            Quantity::Volume => metres * metres * metres,
            Quantity::Angle => PI / 180.0,
        }
    }

    /// A number in SI units as the file's readers see it.
    ///
    /// Divides rather than multiplying by the inverse, so that 0.12 m is 12 cm
    /// and 120 mm exactly.
    pub fn from_si(self, number: f64, quantity: Quantity) -> f64 {
        number / self.to_si(quantity)
    }

    /// The sign of a quantity in these units: "m", "cm²", "°", or nothing.
    pub fn quantity_sign(self, quantity: Quantity) -> String {
        match quantity {
            Quantity::Number => String::new(),
            Quantity::Length => self.sign().to_owned(),
            Quantity::Area => format!("{}²", self.sign()),
            Quantity::Volume => format!("{}³", self.sign()),
            Quantity::Angle => "°".to_owned(),
        }
    }

    /// A length in metres as text: "12 cm".
    pub fn length_text(self, metres: f64) -> String {
        let number = six_digits(self.from_si(metres, Quantity::Length));
        format!("{number} {}", self.sign())
    }
}
