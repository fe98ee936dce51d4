//! A rule that must hold.

use tessgraph_graph::{EvalCx, Node, NodeError};
use tessgraph_macros::Inputs;

/// Makes the run fail where a design rule does not hold.
///
/// The condition is an expression over results of other nodes, such as
/// `"check.pairs == 0"`. Its message says what is wrong. An output that only states
/// rules keeps a graph guarded wherever it runs.
///
/// ```ron
/// Graph(version: 1, nodes: {
///     "box": Cuboid(size: [1, 1, 0.8]),
///     "check": CheckIntersections(mesh: "box"),
///     "out": Require(condition: "check.pairs == 0", message: "panels cross"),
/// })
/// ```
#[derive(Inputs)]
pub(crate) struct Require {
    /// What must be true.
    condition: bool,
    /// What is said when it is not.
    message: String,
}

impl Node for Require {
    type Output = bool;

    fn eval(self, _: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        if self.condition {
            return Ok(true);
        }
        let message = match self.message.trim() {
            "" => "a required condition does not hold",
            message => message,
        };
        Err(NodeError::new(message).at_input("condition"))
    }
}
