//! Why a node could not compute its results.

use tessgraph_geometry::GeometryError;

/// A failure of one node: what is wrong, where, and what to do.
#[derive(Debug, Clone, PartialEq)]
pub struct NodeError {
    message: String,
    help: Option<String>,
    input: Option<&'static str>,
    cancelled: bool,
}

impl NodeError {
    /// An error with this message.
    pub fn new(message: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            help: None,
            input: None,
            cancelled: false,
        }
    }

    /// Adds a way out.
    #[must_use]
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Says which input the error is about, so that it is shown there.
    #[must_use]
    pub fn at_input(mut self, input: &'static str) -> Self {
        self.input = Some(input);
        self
    }

    /// What is wrong.
    pub fn message(&self) -> &str {
        &self.message
    }

    /// A way out, if one is known.
    pub fn help(&self) -> Option<&str> {
        self.help.as_deref()
    }

    /// The input at fault, if it is one.
    pub fn input(&self) -> Option<&'static str> {
        self.input
    }

    /// Whether the node only stopped because it was told to.
    pub fn is_cancelled(&self) -> bool {
        self.cancelled
    }
}

impl From<GeometryError> for NodeError {
    fn from(error: GeometryError) -> Self {
        Self {
            message: error.to_string(),
            help: error.advice().map(str::to_owned),
            input: None,
            cancelled: error == GeometryError::Cancelled,
        }
    }
}

impl std::fmt::Display for NodeError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for NodeError {}
