//! Types of expressions, checked before anything is computed.

use std::ops::Range;

use tessgraph_geometry::math::{PI, TAU};

use super::ExprError;
use super::function::Function;
use super::parse::{Action, Infix, Prefix, Step, parse};
use super::program::{Builder, Op, Program};

/// The type of an expression.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Type {
    /// A number, whole or not.
    Number,
    /// True or false.
    Bool,
}

impl Type {
    /// "a number", "true or false".
    pub fn label(self) -> &'static str {
        match self {
            Self::Number => "a number",
            Self::Bool => "true or false",
        }
    }

    /// How to get this type from the other.
    pub(super) fn help(self) -> &'static str {
        match self {
            Self::Number => "turn a condition into a number: `if(condition, 1, 0)`",
            Self::Bool => "compare the number with something: `x > 0`",
        }
    }
}

/// What a name in an expression stands for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Leaf {
    /// A number known already, in the file's units.
    Number(f64),
    /// A condition known already.
    Bool(bool),
    /// A variable: its slot, its type, and SI units per unit of the file.
    Variable {
        /// Where its value will stand.
        slot: u32,
        /// What it is.
        ty: Type,
        /// What its value in SI units is divided by.
        scale: f64,
    },
}

/// Words that name a constant or an operator and therefore nothing else.
const RESERVED: [&str; 8] = ["pi", "tau", "true", "false", "and", "or", "not", "if"];

/// Whether a parameter or node may not have this name.
pub fn is_reserved(name: &str) -> bool {
    RESERVED.contains(&name)
}

fn constant(name: &str) -> Option<Leaf> {
    Some(match name {
        "pi" => Leaf::Number(PI),
        "tau" => Leaf::Number(TAU),
        "true" => Leaf::Bool(true),
        "false" => Leaf::Bool(false),
        _ => return None,
    })
}

/// Gives names a meaning; `None` when it has reported the error itself, so
/// that the checking goes on without following errors.
pub(super) type Resolve<'r> = dyn FnMut(&str, Range<usize>) -> Result<Option<Leaf>, ExprError> + 'r;

/// A compiled expression and its type; `None` where a name has no known type.
pub(super) struct Compiled {
    pub(super) program: Program,
    pub(super) ty: Option<Type>,
}

/// Compiles `text`, finding all unknown names and wrong types.
pub(super) fn compile(text: &str, resolve: &mut Resolve<'_>) -> Result<Compiled, Vec<ExprError>> {
    let steps = parse(text).map_err(|error| vec![error])?;
    let mut checker = Checker {
        builder: Builder::default(),
        stack: Vec::new(),
        errors: Vec::new(),
    };
    for step in steps {
        checker.step(step, resolve);
    }
    let Some((ty, _)) = checker.stack.pop().filter(|_| checker.errors.is_empty()) else {
        return Err(checker.errors);
    };
    match checker.builder.finish() {
        Some(program) => Ok(Compiled { program, ty }),
        None => Err(vec![
            ExprError::new(0..text.len(), "the expression is nested too deeply")
                .help("compute a part of it in a parameter of its own"),
        ]),
    }
}

struct Checker {
    builder: Builder,
    /// Type and place of each operand on the stack; no type after an error.
    stack: Vec<(Option<Type>, Range<usize>)>,
    errors: Vec<ExprError>,
}

impl Checker {
    fn step(&mut self, step: Step<'_>, resolve: &mut Resolve<'_>) {
        let Step { action, span } = step;
        match action {
            Action::Number(number) => self.leaf(Some(Leaf::Number(number)), span),
            Action::Name(name) => {
                let leaf = match constant(name) {
                    Some(leaf) => Some(leaf),
                    None => resolve(name, span.clone()).unwrap_or_else(|error| {
                        self.errors.push(error);
                        None
                    }),
                };
                self.leaf(leaf, span);
            }
            Action::Prefix(prefix) => self.prefix(prefix, span),
            Action::Infix(infix) => self.infix(infix, span),
            Action::Call(function) => self.call(function, span),
        }
    }

    fn leaf(&mut self, leaf: Option<Leaf>, span: Range<usize>) {
        let (op, ty) = match leaf {
            Some(Leaf::Number(number)) => (Op::Constant(number), Some(Type::Number)),
            Some(Leaf::Bool(truth)) => (Op::Constant(f64::from(u8::from(truth))), Some(Type::Bool)),
            Some(Leaf::Variable { slot, ty, scale }) => (Op::Load { slot, scale }, Some(ty)),
            None => (Op::Constant(0.0), None),
        };
        self.builder.push(op);
        self.stack.push((ty, span));
    }

    /// Takes an operand off and complains if it is not of type `wanted`.
    fn take(&mut self, wanted: Option<Type>, of: &str) -> (Option<Type>, Range<usize>) {
        // Steps come from the parser, which pushes operands before operators.
        let (ty, span) = self.stack.pop().unwrap_or((None, 0..0));
        if let (Some(wanted), Some(ty)) = (wanted, ty)
            && ty != wanted
        {
            let takes = match wanted {
                Type::Number => "numbers",
                Type::Bool => "conditions",
            };
            let error = ExprError::new(span.clone(), format!("`{of}` takes {takes}"))
                .remark(format!("this is {}", ty.label()));
            self.errors.push(error.help(wanted.help()));
        }
        (ty, span)
    }

    fn prefix(&mut self, prefix: Prefix, span: Range<usize>) {
        let (op, wanted, sign) = match prefix {
            Prefix::Negate => (Some(Op::Negate), Type::Number, "-"),
            Prefix::Plus => (None, Type::Number, "+"),
            Prefix::Not => (Some(Op::Not), Type::Bool, "not"),
        };
        let (_, operand) = self.take(Some(wanted), sign);
        if let Some(op) = op {
            self.builder.push(op);
        }
        self.stack.push((Some(wanted), span.start..operand.end));
    }

    fn infix(&mut self, infix: Infix, _span: Range<usize>) {
        let (wanted, gives) = match infix {
            Infix::Or | Infix::And => (Some(Type::Bool), Type::Bool),
            Infix::Equal | Infix::NotEqual => (None, Type::Bool),
            _ if infix.is_comparison() => (Some(Type::Number), Type::Bool),
            _ => (Some(Type::Number), Type::Number),
        };
        let (right, right_span) = self.take(wanted, infix.sign());
        let (left, left_span) = self.take(wanted, infix.sign());
        let whole = left_span.start..right_span.end;
        self.require_same(infix.sign(), left, right, &whole);
        self.builder.push(Op::Infix(infix));
        self.stack.push((Some(gives), whole));
    }

    fn require_same(&mut self, of: &str, a: Option<Type>, b: Option<Type>, span: &Range<usize>) {
        // Other operators have complained about the operand itself already.
        if !matches!(of, "==" | "!=" | "if") {
            return;
        }
        if let (Some(a), Some(b)) = (a, b)
            && a != b
        {
            let message = format!(
                "`{of}` takes two of a kind, not {} and {}",
                a.label(),
                b.label()
            );
            self.errors
                .push(ExprError::new(span.clone(), message).help(Type::Number.help()));
        }
    }

    fn call(&mut self, function: Function, span: Range<usize>) {
        let name = function.name();
        let mut end = span.end;
        let gives = if function == Function::If {
            let (no, no_span) = self.take(None, name);
            let (yes, yes_span) = self.take(None, name);
            self.require_same("if", yes, no, &(yes_span.start..no_span.end));
            self.take(Some(Type::Bool), name);
            end = no_span.end;
            yes.or(no)
        } else {
            for _ in 0..function.arity() {
                end = end.max(self.take(Some(Type::Number), name).1.end);
            }
            Some(Type::Number)
        };
        self.builder.push(Op::Call(function));
        self.stack.push((gives, span.start..end));
    }
}
