//! From a number in the file to an input's value, and the input's range.

use tessgraph_geometry::{Field, Quantity, list_ids};

use crate::names::shown;
use crate::node::InputSpec;
use crate::units::Units;
use crate::value::{Kind, Value, six_digits};

/// What a scalar must be: its kind, its unit, its range. One for inputs and
/// parameters, for literals and computed values, so that all agree.
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    name: String,
    kind: Kind,
    quantity: Quantity,
    units: Units,
    min: Option<f64>,
    above: Option<f64>,
    max: Option<f64>,
}

/// Whole numbers beyond this are not exact in `f64`.
const EXACT_INTEGERS: f64 = 9_007_199_254_740_992.0;

impl Target {
    /// What a scalar at this input must be; for a list, what each item must be.
    pub fn of_input(spec: &InputSpec, units: Units) -> Self {
        let kind = match spec.kind {
            Kind::List(item) => *item,
            kind => kind,
        };
        Self::of_part(spec, kind, units)
    }

    /// What a part of this input's value must be: an item, a component.
    pub(crate) fn of_part(spec: &InputSpec, kind: Kind, units: Units) -> Self {
        Self {
            name: spec.name.to_owned(),
            kind,
            quantity: spec.quantity,
            units,
            min: spec.min,
            above: spec.above,
            max: spec.max,
        }
    }

    /// What a scalar of that name must be, with its range in the file's units.
    pub(crate) fn of_parameter(
        name: &str,
        kind: Kind,
        quantity: Quantity,
        units: Units,
        range: (Option<f64>, Option<f64>),
    ) -> Self {
        let to_si = |number: f64| number * units.to_si(quantity);
        let (min, max) = (range.0.map(to_si), range.1.map(to_si));
        Self {
            name: name.to_owned(),
            kind,
            quantity,
            units,
            min,
            above: None,
            max,
        }
    }

    /// The same range for numbers that are written in other units.
    pub(crate) fn in_units(&self, units: Units) -> Self {
        Self {
            units,
            ..self.clone()
        }
    }

    /// The kind of the value.
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// What its numbers measure.
    pub fn quantity(&self) -> Quantity {
        self.quantity
    }

    /// The name of the input or parameter.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What a number of the file is multiplied by to be in SI units.
    pub fn scale(&self) -> f64 {
        self.units.to_si(self.quantity)
    }

    /// The value of a number in the file's units: in SI units, of the right
    /// kind, within the range.
    ///
    /// # Errors
    /// In words of the file, when it is none of these.
    pub fn of_number(&self, number: f64) -> Result<Value, String> {
        if !number.is_finite() {
            return Err(format!(
                "`{}` takes a finite number, not {number}",
                shown(&self.name)
            ));
        }
        if self.kind == Kind::Integer {
            return self.of_integer(self.whole(number)?);
        }
        // Adding zero turns -0 into 0.
        let value = Value::Number(number * self.scale() + 0.0);
        self.check(&value).map(|()| value)
    }

    /// The value of a whole number in the file's units, kept exact.
    ///
    /// # Errors
    /// As [`Target::of_number`].
    pub fn of_integer(&self, number: i64) -> Result<Value, String> {
        if self.kind != Kind::Integer {
            return self.of_number(number as f64);
        }
        let value = Value::Integer(number);
        self.check(&value).map(|()| value)
    }

    fn whole(&self, number: f64) -> Result<i64, String> {
        if number.fract() != 0.0 {
            let name = shown(&self.name);
            return Err(format!("`{name}` takes a whole number, not {number}"));
        }
        if number.abs() > EXACT_INTEGERS {
            let (number, name) = (six_digits(number), shown(&self.name));
            return Err(format!("{number} is too large for `{name}`"));
        }
        // Whole and within 2^53: the conversion is exact.
        Ok(number as i64)
    }

    /// Checks a value in SI units against the range; for vectors, fields and
    /// lists each number in it. Values without numbers pass.
    ///
    /// # Errors
    /// The first number outside, in the file's units, and the range.
    pub fn check(&self, value: &Value) -> Result<(), String> {
        match value {
            Value::Number(number) => self.check_number(*number, ""),
            Value::Integer(number) => self.check_number(*number as f64, ""),
            Value::Vector(vector) => vector
                .to_array()
                .iter()
                .try_for_each(|number| self.check_number(*number, "")),
            Value::Field(field) => self.check_field(field),
            Value::List(items) => items.iter().try_for_each(|item| self.check(item)),
            _ => Ok(()),
        }
    }

    /// Names the elements whose number is outside.
    fn check_field(&self, field: &Field) -> Result<(), String> {
        let outside = |(index, &number): (usize, &f64)| {
            (!self.contains(number)).then_some((index as u32, number))
        };
        let wrong: Vec<_> = field
            .values()
            .iter()
            .enumerate()
            .filter_map(outside)
            .collect();
        let Some(&(_, first)) = wrong.first() else {
            return Ok(());
        };
        let ids: Vec<u32> = wrong.iter().map(|&(index, _)| index).collect();
        self.check_number(first, &format!(" at {} {}", field.domain(), list_ids(&ids)))
    }

    fn contains(&self, number: f64) -> bool {
        let too_small = self.min.is_some_and(|min| number < min)
            || self.above.is_some_and(|above| number <= above);
        !too_small && self.max.is_none_or(|max| number <= max)
    }

    fn check_number(&self, number: f64, place: &str) -> Result<(), String> {
        if self.contains(number) {
            return Ok(());
        }
        let (name, range, number) = (shown(&self.name), self.range(), self.text(number));
        Err(format!("`{name}` must be {range}, but is {number}{place}"))
    }

    /// The range in words: "at least 2 cm", "0 to 6", "above 0 m".
    pub fn range(&self) -> String {
        let text = |number| self.text(number);
        match (self.min, self.above, self.max) {
            (Some(min), _, Some(max)) => format!("{} to {}", text(min), text(max)),
            (Some(min), _, None) => format!("at least {}", text(min)),
            (None, Some(above), Some(max)) => {
                format!("above {} and at most {}", text(above), text(max))
            }
            (None, Some(above), None) => format!("above {}", text(above)),
            (None, None, Some(max)) => format!("at most {}", text(max)),
            (None, None, None) => "finite".to_owned(),
        }
    }

    /// A number in SI units as text in the file's units.
    fn text(&self, number: f64) -> String {
        let sign = self.units.quantity_sign(self.quantity);
        let space = if sign.is_empty() || self.quantity == Quantity::Angle {
            ""
        } else {
            " "
        };
        let number = match self.kind {
            Kind::Integer if number.abs() < EXACT_INTEGERS => format!("{number}"),
            _ => six_digits(self.units.from_si(number, self.quantity)),
        };
        format!("{number}{space}{sign}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn length(units: Units, min: f64, max: f64) -> Target {
        let range = (Some(min), Some(max));
        Target::of_parameter("thickness", Kind::Number, Quantity::Length, units, range)
    }

    #[test]
    fn numbers_become_metres_exactly() {
        let Ok(Value::Number(metres)) = length(Units::Cm, 2.0, 40.0).of_number(12.0) else {
            panic!("12 cm is within 2 to 40 cm");
        };
        assert_eq!(metres.to_bits(), 0.12_f64.to_bits());
    }

    #[test]
    fn ranges_speak_the_units_of_the_file() {
        let error = length(Units::Cm, 2.0, 40.0).of_number(41.0).unwrap_err();
        assert_eq!(error, "`thickness` must be 2 cm to 40 cm, but is 41 cm");
        let angle = Target::of_parameter(
            "turn",
            Kind::Number,
            Quantity::Angle,
            Units::M,
            (None, Some(90.0)),
        );
        assert_eq!(
            angle.of_number(91.0).unwrap_err(),
            "`turn` must be at most 90°, but is 91°"
        );
    }

    #[test]
    fn integers_must_be_whole_and_exact() {
        let count = Target::of_parameter(
            "n",
            Kind::Integer,
            Quantity::Number,
            Units::M,
            (Some(0.0), None),
        );
        assert!(matches!(count.of_number(3.0), Ok(Value::Integer(3))));
        assert_eq!(
            count.of_number(2.5).unwrap_err(),
            "`n` takes a whole number, not 2.5"
        );
        assert!(count.of_number(1e300).unwrap_err().contains("too large"));
        assert_eq!(
            count.of_integer(-1).unwrap_err(),
            "`n` must be at least 0, but is -1"
        );
        assert!(count.of_number(f64::NAN).is_err());
    }
}
