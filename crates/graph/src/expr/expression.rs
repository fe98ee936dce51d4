//! Expressions over results of nodes, computed once these are known.

use super::ExprError;
use super::program::Program;
use super::target::Target;
use super::types::{Leaf, Resolve, Type, compile};
use crate::names::shown;
use crate::plan::ResultRef;
use crate::value::{Kind, Value};

/// A node result that an expression uses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResultUse {
    /// Which result.
    pub result: ResultRef,
    /// SI units per unit of the file, for what the result measures.
    pub scale: f64,
}

/// A checked expression whose free names are results of nodes.
///
/// It is computed in the file's units and converted at its border, so that
/// `"roof_length / 4 + 2"` means what a reader of a file in centimetres expects.
#[derive(Debug, Clone, PartialEq)]
pub struct Expression {
    text: String,
    program: Program,
    uses: Vec<ResultUse>,
    target: Target,
    /// The expression is one result of the quantity wanted: it is taken as it
    /// is, without the last bit that converting twice may cost.
    direct: bool,
}

/// What compiling an expression for an input gives.
pub(crate) enum Scalar {
    /// Its value is known already.
    Known(Value),
    /// It needs other nodes' results.
    Later(Expression),
}

impl Expression {
    /// Compiles `text` for `target`. `uses` holds the results that `resolve`
    /// has handed out slots for, in the order of the slots.
    ///
    /// # Errors
    /// All unknown names and wrong types; a known value that is out of range.
    pub(crate) fn compile(
        text: &str,
        target: Target,
        mut resolve: impl FnMut(&str, std::ops::Range<usize>, &mut Vec<ResultUse>) -> ResolvedName,
    ) -> Result<Scalar, Vec<ExprError>> {
        let (mut uses, mut unknown) = (Vec::new(), false);
        let resolve: &mut Resolve<'_> = &mut |name, span| {
            let leaf = resolve(name, span, &mut uses);
            unknown |= matches!(leaf, Ok(None));
            leaf
        };
        let compiled = compile(text, resolve)?;
        let whole = 0..text.len();
        let wanted = if target.kind() == Kind::Bool {
            Type::Bool
        } else {
            Type::Number
        };
        if let Some(ty) = compiled.ty.filter(|ty| *ty != wanted) {
            let (name, kind) = (shown(target.name()), target.kind().label());
            let message = format!("`{name}` takes {kind}, not {}", ty.label());
            return Err(vec![
                ExprError::new(whole, message)
                    .code("wrong_kind")
                    .remark(ty.label())
                    .help(wanted.help()),
            ]);
        }
        let program = compiled.program;
        let direct = program
            .as_load()
            .and_then(|slot| uses.get(slot as usize))
            .is_some_and(|use_| {
                target.kind() == Kind::Bool || use_.scale.to_bits() == target.scale().to_bits()
            });
        let expression = Self {
            text: text.to_owned(),
            program,
            uses,
            target,
            direct,
        };
        let Some(number) = expression.program.as_constant() else {
            return Ok(Scalar::Later(expression));
        };
        if unknown {
            // What is wrong with the name was reported; its value says nothing.
            return Err(Vec::new());
        }
        expression
            .finish(number)
            .map(Scalar::Known)
            .map_err(|message| {
                vec![
                    ExprError::new(whole, message)
                        .code("out_of_range")
                        .remark("this value"),
                ]
            })
    }

    /// The results it needs, each once, in the order they are first written.
    pub fn results(&self) -> Vec<ResultRef> {
        self.uses.iter().map(|use_| use_.result).collect()
    }

    /// Renumbers the nodes it refers to: node `i` becomes `places[i]`.
    pub(crate) fn renumber(&mut self, places: &[usize]) {
        for use_ in &mut self.uses {
            use_.result.node = places[use_.result.node];
        }
    }

    /// The expression as written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The value for these results, in SI units, of the input's kind, within
    /// its range. `get` gives a result's value in SI units.
    ///
    /// # Errors
    /// In words of the file: not finite, not whole, or out of range.
    pub fn evaluate(&self, get: &dyn Fn(ResultRef) -> Value) -> Result<Value, String> {
        if self.direct
            && let [only] = self.uses.as_slice()
        {
            return self.take(get(only.result));
        }
        let mut slots = Vec::with_capacity(self.uses.len());
        for use_ in &self.uses {
            slots.push(scalar(&get(use_.result))?);
        }
        self.finish(self.program.run(&slots))
    }

    /// A result of the right quantity, unchanged but for its kind.
    fn take(&self, value: Value) -> Result<Value, String> {
        let value = match (self.target.kind(), value) {
            (Kind::Number | Kind::Amount, Value::Integer(number)) => Value::Number(number as f64),
            (Kind::Integer, Value::Number(number)) => return self.target.of_number(number),
            (_, value) => value,
        };
        self.target.check(&value).map(|()| value)
    }

    fn finish(&self, number: f64) -> Result<Value, String> {
        if self.target.kind() == Kind::Bool {
            return Ok(Value::Bool(number != 0.0));
        }
        if !number.is_finite() {
            return Err(format!("`{}` gives no finite number", shown(&self.text)));
        }
        self.target.of_number(number)
    }
}

/// A name's meaning, or the error; `None` when it was reported elsewhere.
pub(crate) type ResolvedName = Result<Option<Leaf>, ExprError>;

/// A scalar result as a number; true is 1.
pub(super) fn scalar(value: &Value) -> Result<f64, String> {
    match value {
        Value::Number(number) => Ok(*number),
        Value::Integer(number) => Ok(*number as f64),
        Value::Bool(truth) => Ok(f64::from(u8::from(*truth))),
        other => Err(format!(
            "an expression takes numbers, not {}",
            other.kind().label()
        )),
    }
}
