//! A compiled expression: a short list of operations on a small stack.

use tessgraph_geometry::digest::Hasher;
use tessgraph_geometry::math;

use super::function::Function;
use super::parse::Infix;

/// One operation. True is 1, false is 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Op {
    Constant(f64),
    /// The variable in `slot`, divided by `scale`: from SI to the file's units.
    Load {
        slot: u32,
        scale: f64,
    },
    Negate,
    Not,
    Infix(Infix),
    Call(Function),
}

impl Op {
    /// How many operands it takes off the stack.
    fn operands(self) -> usize {
        match self {
            Self::Constant(_) | Self::Load { .. } => 0,
            Self::Negate | Self::Not => 1,
            Self::Infix(_) => 2,
            Self::Call(function) => function.arity(),
        }
    }

    fn apply(self, args: &[f64]) -> f64 {
        match (self, args) {
            (Self::Negate, &[x]) => -x,
            (Self::Not, &[x]) => truth(x == 0.0),
            (Self::Infix(infix), &[a, b]) => apply_infix(infix, a, b),
            (Self::Call(function), args) => function.apply(args),
            _ => f64::NAN,
        }
    }
}

fn truth(condition: bool) -> f64 {
    f64::from(u8::from(condition))
}

#[allow(
    clippy::float_cmp,
    reason = "`==` in an expression means exactly equal"
)]
fn apply_infix(infix: Infix, a: f64, b: f64) -> f64 {
    match infix {
        Infix::Or => truth(a != 0.0 || b != 0.0),
        Infix::And => truth(a != 0.0 && b != 0.0),
        Infix::Less => truth(a < b),
        Infix::LessEqual => truth(a <= b),
        Infix::Greater => truth(a > b),
        Infix::GreaterEqual => truth(a >= b),
        Infix::Equal => truth(a == b),
        Infix::NotEqual => truth(a != b),
        Infix::Add => a + b,
        Infix::Subtract => a - b,
        Infix::Multiply => a * b,
        Infix::Divide => a / b,
        Infix::Remainder => a.rem_euclid(b),
        Infix::Power => math::pow(a, b),
    }
}

/// The stack of one evaluation: on the machine's stack, never on the heap.
const MAX_STACK: usize = 64;
/// What nearly every expression needs; clearing it costs next to nothing.
const SMALL_STACK: usize = 8;

/// Operations that leave exactly one number.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Program {
    ops: Box<[Op]>,
    /// The most numbers on the stack at once.
    height: usize,
}

/// Collects operations, computing at once what is already known.
#[derive(Debug, Default)]
pub(super) struct Builder {
    ops: Vec<Op>,
    height: usize,
    highest: usize,
}

impl Builder {
    /// Adds an operation; over constants alone it becomes its result.
    pub(super) fn push(&mut self, op: Op) {
        let count = op.operands();
        self.height = self.height + 1 - count;
        self.highest = self.highest.max(self.height);
        let start = self.ops.len() - count.min(self.ops.len());
        let mut args = [0.0; 3];
        let constants = self.ops[start..]
            .iter()
            .zip(&mut args)
            .filter_map(|(op, arg)| match op {
                Op::Constant(number) => {
                    *arg = *number;
                    Some(())
                }
                _ => None,
            });
        if count > 0 && constants.count() == count {
            self.ops.truncate(start);
            self.ops.push(Op::Constant(op.apply(&args[..count])));
        } else {
            self.ops.push(op);
        }
    }

    /// The program; `None` if it would need too high a stack.
    pub(super) fn finish(self) -> Option<Program> {
        // A constant of -0 must not be another program than one of 0.
        let tidy = |op| match op {
            Op::Constant(number) => Op::Constant(number + 0.0),
            op => op,
        };
        let ops = self.ops.into_iter().map(tidy).collect();
        (self.highest <= MAX_STACK).then_some(Program {
            ops,
            height: self.highest,
        })
    }
}

impl Program {
    pub(super) fn constant(number: f64) -> Self {
        Self {
            ops: Box::new([Op::Constant(number + 0.0)]),
            height: 1,
        }
    }

    /// The result, if it does not depend on any variable.
    pub(super) fn as_constant(&self) -> Option<f64> {
        match *self.ops {
            [Op::Constant(number)] => Some(number),
            _ => None,
        }
    }

    /// The one slot it loads and does nothing else with.
    pub(super) fn as_load(&self) -> Option<u32> {
        match *self.ops {
            [Op::Load { slot, .. }] => Some(slot),
            _ => None,
        }
    }

    /// The result for these variables; no allocation.
    ///
    /// # Panics
    /// If a slot of the program is missing in `slots`.
    pub(super) fn run(&self, slots: &[f64]) -> f64 {
        if self.height <= SMALL_STACK {
            self.run_on(slots, &mut [0.0; SMALL_STACK])
        } else {
            self.run_on(slots, &mut [0.0; MAX_STACK])
        }
    }

    fn run_on(&self, slots: &[f64], stack: &mut [f64]) -> f64 {
        let mut top = 0;
        for &op in &self.ops {
            let result = match op {
                Op::Constant(number) => number,
                Op::Load { slot, scale } => slots[slot as usize] / scale,
                // The commonest operations, without looking at a slice's length.
                Op::Infix(infix) => {
                    top -= 2;
                    apply_infix(infix, stack[top], stack[top + 1])
                }
                op => {
                    let base = top - op.operands();
                    let result = op.apply(&stack[base..top]);
                    top = base;
                    result
                }
            };
            stack[top] = result;
            top += 1;
        }
        stack[0]
    }

    /// The same program with each slot replaced by a number or another slot,
    /// and everything computed that then is known.
    pub(super) fn substitute(&self, of_slot: impl Fn(u32) -> Op) -> Self {
        let mut builder = Builder::default();
        for &op in &self.ops {
            builder.push(match op {
                Op::Load { slot, .. } => of_slot(slot),
                op => op,
            });
        }
        // Replacing loads one by one never needs a higher stack than before.
        builder.finish().unwrap_or_else(|| self.clone())
    }

    /// Feeds the operations, so that equal programs have equal digests.
    pub(super) fn feed(&self, hasher: &mut Hasher) {
        hasher.number(self.ops.len() as u64);
        for op in &self.ops {
            match *op {
                Op::Constant(number) => hasher.text("constant").float(number),
                Op::Load { slot, scale } => hasher.text("load").number(slot.into()).float(scale),
                Op::Negate => hasher.text("negate"),
                Op::Not => hasher.text("not"),
                Op::Infix(infix) => hasher.text(infix.sign()),
                Op::Call(function) => hasher.text(function.name()),
            };
        }
    }
}
