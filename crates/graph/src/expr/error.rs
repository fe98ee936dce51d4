//! What is wrong with an expression, and where in its text.

use std::ops::Range;

/// One mistake in an expression.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExprError {
    /// A stable name for this kind of mistake: `bad_expression`, `unknown_name`.
    pub code: &'static str,
    /// Bytes of the expression's text, on character boundaries.
    pub span: Range<usize>,
    /// What is wrong.
    pub message: String,
    /// A few words for the place itself.
    pub remark: String,
    /// A way out, if one is known.
    pub help: Option<String>,
    /// Another place that explains the mistake, with a remark: bytes of the
    /// file the expression stands in.
    pub elsewhere: Option<Box<(Range<usize>, String)>>,
}

impl ExprError {
    /// A mistake of syntax or type at `span`.
    pub(crate) fn new(span: Range<usize>, message: impl Into<String>) -> Self {
        Self {
            code: "bad_expression",
            span,
            message: message.into(),
            remark: "here".to_owned(),
            help: None,
            elsewhere: None,
        }
    }

    pub(crate) fn code(mut self, code: &'static str) -> Self {
        self.code = code;
        self
    }

    pub(crate) fn remark(mut self, remark: impl Into<String>) -> Self {
        self.remark = remark.into();
        self
    }

    pub(crate) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    pub(crate) fn elsewhere(mut self, span: Range<usize>, remark: impl Into<String>) -> Self {
        self.elsewhere = Some(Box::new((span, remark.into())));
        self
    }
}
