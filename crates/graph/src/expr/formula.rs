//! Formulas over variables that the node supplies: coordinates, attributes.

use tessgraph_geometry::digest::{Digest, Hasher};

use super::ExprError;
use super::expression::{ResolvedName, ResultUse, scalar};
use super::program::{Op, Program};
use super::types::{Resolve, Type, compile};
use crate::plan::ResultRef;
use crate::value::Value;

/// A formula ready to be evaluated at every element of a mesh.
///
/// Variables go in and the result comes out in SI units; inside, numbers are
/// in the file's units, as its author sees them.
#[derive(Debug, Clone, PartialEq)]
pub struct Formula {
    program: Program,
    /// What must be supplied, in the order first written.
    names: Vec<String>,
    /// Those of `names` that are mesh attributes.
    attributes: Vec<String>,
    /// SI units per unit of the file, for the result.
    scale: f64,
}

impl Formula {
    /// A formula that is the same number everywhere, in SI units.
    pub fn constant(number: f64) -> Self {
        let program = Program::constant(number);
        Self {
            program,
            names: Vec::new(),
            attributes: Vec::new(),
            scale: 1.0,
        }
    }

    /// The number it is everywhere, in SI units, if it has no variables.
    pub fn as_constant(&self) -> Option<f64> {
        self.program.as_constant().map(|number| number * self.scale)
    }

    /// The variables to supply to [`Formula::evaluate`], in its order: the free
    /// names of the input's spec and names of mesh attributes.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Those of [`Formula::names`] that are mesh attributes.
    pub fn attribute_names(&self) -> &[String] {
        &self.attributes
    }

    /// Whether the formula needs that variable.
    pub fn uses(&self, name: &str) -> bool {
        self.names.iter().any(|other| other == name)
    }

    /// The result in SI units for `values`, in SI units in the order of
    /// [`Formula::names`]; NaN or infinite where the formula has no value.
    /// Allocates nothing and may run on many threads. Cost: O(operations).
    ///
    /// # Panics
    /// If there are fewer values than names.
    pub fn evaluate(&self, values: &[f64]) -> f64 {
        self.program.run(values) * self.scale
    }

    /// Digest of what is computed, not of the text it was written as.
    pub fn digest(&self) -> Digest {
        let mut hasher = Hasher::new();
        hasher
            .text("formula")
            .float(self.scale)
            .number(self.names.len() as u64);
        for name in &self.names {
            hasher
                .text(name)
                .number(u64::from(self.attributes.contains(name)));
        }
        self.program.feed(&mut hasher);
        hasher.finish()
    }

    /// Constants take the scale into themselves, so that 0.12 m is the same
    /// formula as 12 cm.
    fn tidy(self) -> Self {
        match self.as_constant() {
            Some(number) => Self::constant(number),
            None => self,
        }
    }
}

/// A variable of a formula that the node supplies.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FormulaName {
    pub(crate) name: String,
    pub(crate) is_attribute: bool,
}

/// What a slot of a formula's program stands for.
#[derive(Debug, Clone, PartialEq)]
enum Slot {
    /// A variable, with its scale.
    Name(FormulaName, f64),
    /// A node's result.
    Result(ResultUse),
}

/// A formula some of whose names are numeric results of other nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct FormulaTemplate {
    program: Program,
    slots: Vec<Slot>,
    scale: f64,
}

/// Hands out the slots of a formula while its names are resolved.
#[derive(Debug, Default)]
pub(crate) struct FormulaSlots {
    slots: Vec<Slot>,
}

impl FormulaSlots {
    /// The slot of a variable that the node supplies.
    pub(crate) fn name(&mut self, name: &str, is_attribute: bool, scale: f64) -> u32 {
        let name = FormulaName {
            name: name.to_owned(),
            is_attribute,
        };
        self.slot(Slot::Name(name, scale))
    }

    /// The slot of a node's result.
    pub(crate) fn result(&mut self, use_: ResultUse) -> u32 {
        self.slot(Slot::Result(use_))
    }

    fn slot(&mut self, wanted: Slot) -> u32 {
        let place = self
            .slots
            .iter()
            .position(|slot| *slot == wanted)
            .unwrap_or_else(|| {
                self.slots.push(wanted);
                self.slots.len() - 1
            });
        // A text within the size limit of a file cannot hold 2^32 names.
        place as u32
    }
}

impl FormulaTemplate {
    /// Compiles `text`; `scale` is SI units per unit of the file for its result.
    ///
    /// # Errors
    /// All unknown names and wrong types; a known result that is not finite.
    pub(crate) fn compile(
        text: &str,
        scale: f64,
        mut resolve: impl FnMut(&str, std::ops::Range<usize>, &mut FormulaSlots) -> ResolvedName,
    ) -> Result<Self, Vec<ExprError>> {
        let (mut slots, mut unknown) = (FormulaSlots::default(), false);
        let resolve: &mut Resolve<'_> = &mut |name, span| {
            let leaf = resolve(name, span, &mut slots);
            unknown |= matches!(leaf, Ok(None));
            leaf
        };
        let compiled = compile(text, resolve)?;
        let whole = 0..text.len();
        if compiled.ty == Some(Type::Bool) {
            return Err(vec![
                ExprError::new(whole, "a formula gives a number, not true or false")
                    .code("wrong_kind")
                    .remark("true or false")
                    .help("turn a condition into a number: `if(condition, 1, 0)`"),
            ]);
        }
        if compiled
            .program
            .as_constant()
            .is_some_and(|number| !number.is_finite() && !unknown)
        {
            return Err(vec![ExprError::new(whole, "this gives no finite number")]);
        }
        Ok(Self {
            program: compiled.program,
            slots: slots.slots,
            scale,
        })
    }

    /// The results it needs, each once, in the order they are first written.
    pub fn results(&self) -> Vec<ResultRef> {
        let results = self.slots.iter().filter_map(|slot| match slot {
            Slot::Result(use_) => Some(use_.result),
            Slot::Name(..) => None,
        });
        results.collect()
    }

    /// Renumbers the nodes it refers to: node `i` becomes `places[i]`.
    pub(crate) fn renumber(&mut self, places: &[usize]) {
        for slot in &mut self.slots {
            if let Slot::Result(use_) = slot {
                use_.result.node = places[use_.result.node];
            }
        }
    }

    /// The formula with these results in their places; `get` gives a result's
    /// value in SI units.
    ///
    /// # Errors
    /// When a result is no number.
    pub fn bind(&self, get: &dyn Fn(ResultRef) -> Value) -> Result<Formula, String> {
        let mut ops = Vec::with_capacity(self.slots.len());
        let mut names: Vec<FormulaName> = Vec::new();
        for slot in &self.slots {
            ops.push(match slot {
                Slot::Result(use_) => Op::Constant(scalar(&get(use_.result))? / use_.scale),
                Slot::Name(name, scale) => {
                    names.push(name.clone());
                    Op::Load {
                        slot: names.len() as u32 - 1,
                        scale: *scale,
                    }
                }
            });
        }
        let program = self.program.substitute(|slot| ops[slot as usize]);
        let attributes = names.iter().filter(|name| name.is_attribute);
        let attributes = attributes.map(|name| name.name.clone()).collect();
        let names = names.into_iter().map(|name| name.name).collect();
        Ok(Formula {
            program,
            names,
            attributes,
            scale: self.scale,
        }
        .tidy())
    }
}
