//! From a plan's origins to the values a node is given.

use std::sync::Arc;

use tessgraph_geometry::{Field, Quantity};

use crate::NodeError;
use crate::expr::Target;
use crate::node::InputSpec;
use crate::plan::{Origin, ResultRef};
use crate::units::Units;
use crate::value::{Kind, Value};

/// The value of an input; `None` if it was left out. Results of other nodes
/// are taken from `get`.
pub(super) fn value_of(
    origin: &Origin,
    get: &dyn Fn(ResultRef) -> Value,
) -> Result<Option<Value>, String> {
    Ok(Some(match origin {
        Origin::Absent => return Ok(None),
        Origin::Constant(value) => value.clone(),
        Origin::Result(result) => get(*result),
        Origin::Expression(expression) => expression.evaluate(get)?,
        Origin::Formula(template) => Value::Formula(Arc::new(template.bind(get)?)),
        Origin::List(items) => {
            let items: Result<Vec<_>, _> = items.iter().map(|item| value_of(item, get)).collect();
            Value::List(items?.into_iter().flatten().collect())
        }
        Origin::Vector(parts) => {
            let mut numbers = [0.0; 3];
            for (number, part) in numbers.iter_mut().zip(parts.iter()) {
                if let Some(Value::Number(value)) = value_of(part, get)? {
                    *number = value;
                }
            }
            Value::Vector(numbers.into())
        }
    }))
}

/// The value as the node receives it: an integer becomes a number where one is
/// wanted, a plain field takes on the input's quantity. What came from another
/// node is held against the input's range and length here; literals were at load.
pub(super) fn fitted(
    spec: &InputSpec,
    origin: &Origin,
    value: Value,
    units: Units,
) -> Result<Value, NodeError> {
    let value = match (spec.kind, value) {
        // Integers above 2^53 are no lengths or weights; rounding is harmless.
        (Kind::Number | Kind::Amount, Value::Integer(number)) => Value::Number(number as f64),
        (Kind::Amount | Kind::Field, Value::Field(field)) => {
            Value::Field(in_quantity(spec, field, units)?)
        }
        (_, value) => value,
    };
    if matches!(origin, Origin::Constant(_)) {
        return Ok(value);
    }
    if let (Some(wanted), Value::List(items)) = (spec.length, &value)
        && items.len() != wanted
    {
        let message = format!(
            "`{}` takes {wanted} items, but there are {}",
            spec.name,
            items.len()
        );
        return Err(NodeError::new(message).at_input(spec.name));
    }
    let checked = Target::of_input(spec, units).check(&value);
    checked.map_err(|message| NodeError::new(message).at_input(spec.name))?;
    Ok(value)
}

/// The field in SI units of the input's quantity. A plain field is read as a
/// literal would be, in the file's units, and a length at an input of plain
/// numbers becomes the file's number.
fn in_quantity(spec: &InputSpec, field: Arc<Field>, units: Units) -> Result<Arc<Field>, NodeError> {
    if spec.quantity == field.quantity() {
        return Ok(field);
    }
    if spec.quantity == Quantity::Number {
        // Where a plain number is wanted, a length is the number its reader sees.
        let per_unit = 1.0 / units.to_si(field.quantity());
        return Ok(Arc::new(field.scaled(per_unit, Quantity::Number)));
    }
    if field.quantity() != Quantity::Number {
        let (wanted, given) = (spec.quantity, field.quantity());
        let message = format!(
            "`{}` takes a field of {wanted}s, but this is one of {given}s",
            spec.name
        );
        return Err(NodeError::new(message).at_input(spec.name));
    }
    Ok(Arc::new(
        field.scaled(units.to_si(spec.quantity), spec.quantity),
    ))
}
