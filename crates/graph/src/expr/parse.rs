//! From text to steps in the order they are computed.
//!
//! Operator precedence by binding powers (Pratt). Steps come out in postfix
//! order straight away: no tree is built, so a long chain of additions costs no
//! recursion. Only brackets, signs and powers recurse, to a limit.

use std::ops::Range;

use super::ExprError;
use super::function::Function;
use super::token::{Lexer, Token};

/// One step of a computation on a stack.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Step<'a> {
    pub(super) action: Action<'a>,
    /// The operator, name or number it comes from.
    pub(super) span: Range<usize>,
}

/// What a step does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Action<'a> {
    Number(f64),
    Name(&'a str),
    Prefix(Prefix),
    Infix(Infix),
    Call(Function),
}

/// An operator before its operand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Prefix {
    Negate,
    Plus,
    Not,
}

/// An operator between its operands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Infix {
    Or,
    And,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
    Power,
}

impl Infix {
    fn from_token(token: Token<'_>) -> Option<Self> {
        let (Token::Sign(sign) | Token::Name(sign)) = token else {
            return None;
        };
        Some(match sign {
            "or" => Self::Or,
            "and" => Self::And,
            "<" => Self::Less,
            "<=" => Self::LessEqual,
            ">" => Self::Greater,
            ">=" => Self::GreaterEqual,
            "==" => Self::Equal,
            "!=" => Self::NotEqual,
            "+" => Self::Add,
            "-" => Self::Subtract,
            "*" => Self::Multiply,
            "/" => Self::Divide,
            "%" => Self::Remainder,
            "^" => Self::Power,
            _ => return None,
        })
    }

    pub(super) fn sign(self) -> &'static str {
        match self {
            Self::Or => "or",
            Self::And => "and",
            Self::Less => "<",
            Self::LessEqual => "<=",
            Self::Greater => ">",
            Self::GreaterEqual => ">=",
            Self::Equal => "==",
            Self::NotEqual => "!=",
            Self::Add => "+",
            Self::Subtract => "-",
            Self::Multiply => "*",
            Self::Divide => "/",
            Self::Remainder => "%",
            Self::Power => "^",
        }
    }

    pub(super) fn is_comparison(self) -> bool {
        self.power() == COMPARISON
    }

    /// How tightly the operator binds.
    fn power(self) -> u8 {
        match self {
            Self::Or => 1,
            Self::And => 2,
            Self::Less
            | Self::LessEqual
            | Self::Greater
            | Self::GreaterEqual
            | Self::Equal
            | Self::NotEqual => COMPARISON,
            Self::Add | Self::Subtract => 5,
            Self::Multiply | Self::Divide | Self::Remainder => 6,
            Self::Power => 8,
        }
    }
}

const NOT: u8 = 3;
const COMPARISON: u8 = 4;
const SIGN: u8 = 7;

/// Brackets, signs, powers and arguments inside each other, at most. Far more
/// than a person writes, far less than the stack holds.
const MAX_DEPTH: usize = 200;

/// Longer expressions are not written by people.
const MAX_BYTES: usize = 32 * 1024;

/// The steps of the expression `text`.
pub(super) fn parse(text: &str) -> Result<Vec<Step<'_>>, ExprError> {
    if text.len() > MAX_BYTES {
        let message = format!("the expression is longer than {} KiB", MAX_BYTES / 1024);
        return Err(ExprError::new(0..text.len(), message)
            .help("split it into parameters or nodes of their own"));
    }
    let mut parser = Parser::new(text)?;
    if parser.token == Token::End {
        return Err(ExprError::new(0..text.len(), "the expression is empty")
            .help("write a number, the name of a parameter, or a formula of them"));
    }
    parser.expression(0)?;
    match parser.token {
        Token::End => Ok(parser.steps),
        _ => Err(parser.unexpected("an operator or the end")),
    }
}

/// The names in an expression, each with its place, in the order written.
pub type Names<'a> = Vec<(&'a str, Range<usize>)>;

/// The names that `text` uses, without constants and functions.
///
/// # Errors
/// When `text` is no expression.
pub fn names(text: &str) -> Result<Names<'_>, ExprError> {
    let steps = parse(text)?.into_iter();
    Ok(steps
        .filter_map(|step| match step.action {
            Action::Name(name) if !super::is_reserved(name) => Some((name, step.span)),
            _ => None,
        })
        .collect())
}

struct Parser<'a> {
    lexer: Lexer<'a>,
    token: Token<'a>,
    span: Range<usize>,
    steps: Vec<Step<'a>>,
    depth: usize,
}

impl<'a> Parser<'a> {
    fn new(text: &'a str) -> Result<Self, ExprError> {
        let mut lexer = Lexer::new(text);
        let (token, span) = lexer.next()?;
        Ok(Self {
            lexer,
            token,
            span,
            steps: Vec::new(),
            depth: 0,
        })
    }

    /// Takes the current token and reads the next.
    fn advance(&mut self) -> Result<Range<usize>, ExprError> {
        let (token, span) = self.lexer.next()?;
        self.token = token;
        Ok(std::mem::replace(&mut self.span, span))
    }

    fn push(&mut self, action: Action<'a>, span: Range<usize>) {
        self.steps.push(Step { action, span });
    }

    /// An operand and all operators after it that bind at least at `lowest`.
    fn expression(&mut self, lowest: u8) -> Result<(), ExprError> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            let message = format!("the expression is nested deeper than {MAX_DEPTH} levels");
            return Err(ExprError::new(self.span.clone(), message)
                .help("compute a part of it in a parameter of its own"));
        }
        self.operand()?;
        let mut compared = false;
        while let Some(infix) = Infix::from_token(self.token) {
            let power = infix.power();
            if power < lowest {
                break;
            }
            if power == COMPARISON && std::mem::replace(&mut compared, true) {
                return Err(
                    ExprError::new(self.span.clone(), "comparisons do not chain")
                        .help("compare two at a time: `a < b and b < c`"),
                );
            }
            let span = self.advance()?;
            // A power binds its exponent from the right; the others from the left.
            self.expression(if infix == Infix::Power {
                SIGN
            } else {
                power + 1
            })?;
            self.push(Action::Infix(infix), span);
        }
        self.depth -= 1;
        Ok(())
    }

    fn operand(&mut self) -> Result<(), ExprError> {
        match self.token {
            Token::Number(number) => {
                let span = self.advance()?;
                self.push(Action::Number(number), span);
                Ok(())
            }
            Token::Sign("-") => self.prefix(Prefix::Negate, SIGN),
            Token::Sign("+") => self.prefix(Prefix::Plus, SIGN),
            Token::Name("not") => self.prefix(Prefix::Not, NOT),
            Token::Name("and" | "or") => Err(self.unexpected("a value")),
            Token::Name(name) => self.name(name),
            Token::Sign("(") => {
                let open = self.advance()?;
                self.expression(0)?;
                self.close(open)
            }
            _ => Err(self.unexpected("a value")),
        }
    }

    fn prefix(&mut self, prefix: Prefix, power: u8) -> Result<(), ExprError> {
        let span = self.advance()?;
        self.expression(power)?;
        self.push(Action::Prefix(prefix), span);
        Ok(())
    }

    fn name(&mut self, name: &'a str) -> Result<(), ExprError> {
        let span = self.advance()?;
        if self.token != Token::Sign("(") {
            if name == "if" {
                let message = "`if` is a function";
                return Err(ExprError::new(span, message).help("write `if(condition, a, b)`"));
            }
            self.push(Action::Name(name), span);
            return Ok(());
        }
        match Function::from_name(name) {
            Some(function) => self.call(function, span),
            None => Err(unknown_function(name, span)),
        }
    }

    fn call(&mut self, function: Function, span: Range<usize>) -> Result<(), ExprError> {
        let open = self.advance()?;
        let mut count = 0;
        while self.token != Token::Sign(")") {
            self.expression(0)?;
            count += 1;
            // `min(a, b, c)` is `min(min(a, b), c)`.
            if count == function.arity() || (count > function.arity() && function.takes_more()) {
                self.push(Action::Call(function), span.clone());
            }
            match self.token {
                Token::Sign(",") => {
                    self.advance()?;
                }
                Token::Sign(")") => {}
                _ => return Err(self.unclosed(open)),
            }
        }
        self.advance()?;
        let enough =
            count == function.arity() || (count > function.arity() && function.takes_more());
        if enough {
            return Ok(());
        }
        let (wanted, usage) = (function.arity(), function.usage());
        let least = if function.takes_more() {
            "at least "
        } else {
            ""
        };
        let plural = if wanted == 1 { "" } else { "s" };
        let message = format!(
            "`{}` takes {least}{wanted} argument{plural}, not {count}",
            function.name()
        );
        Err(ExprError::new(span, message).help(format!("write `{usage}`")))
    }

    fn close(&mut self, open: Range<usize>) -> Result<(), ExprError> {
        if self.token != Token::Sign(")") {
            return Err(self.unclosed(open));
        }
        self.advance()?;
        Ok(())
    }

    fn unclosed(&self, open: Range<usize>) -> ExprError {
        if self.token == Token::End {
            return ExprError::new(open, "this bracket is not closed").help("add a `)`");
        }
        self.unexpected("an operator or `)`")
    }

    fn unexpected(&self, wanted: &str) -> ExprError {
        let message = match self.token {
            Token::End => format!("expected {wanted}, but the expression ends"),
            Token::Number(_) => format!("expected {wanted}, found a number"),
            Token::Name(name) => {
                format!("expected {wanted}, found `{}`", crate::names::shown(name))
            }
            Token::Sign(sign) => format!("expected {wanted}, found `{sign}`"),
        };
        let error = ExprError::new(self.span.clone(), message);
        error.help(match self.token {
            Token::Sign(";") => "arguments are separated by `,`",
            Token::End => "complete it, or remove the operator before",
            _ if wanted == "a value" => "write a number, a name or a bracket here",
            _ => "write an operator such as `*` before it",
        })
    }
}

fn unknown_function(name: &str, span: Range<usize>) -> ExprError {
    let message = format!("there is no function `{}`", crate::names::shown(name));
    let help = crate::names::did_you_mean(name, Function::names()).unwrap_or_else(|| {
        format!(
            "functions are {}",
            Function::names().collect::<Vec<_>>().join(", ")
        )
    });
    ExprError::new(span, message)
        .code("unknown_name")
        .remark("no such function")
        .help(help)
}
