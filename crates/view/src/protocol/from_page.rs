//! What the page asks for.

use serde::Deserialize;

use super::Value;

/// What the page asks for.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum FromPage {
    /// Evaluate with another value of a parameter.
    Set {
        /// The parameter.
        name: String,
        /// The value, in the file's units.
        value: Value,
    },
    /// Put a value into the file.
    Write {
        /// The parameter.
        name: String,
        /// The value, in the file's units.
        value: Value,
    },
    /// Put back what the file said when the session began.
    Reset {
        /// The parameter.
        name: String,
    },
    /// Take back the last edit made here.
    Undo,
    /// Make the last edit again that was taken back.
    Redo,
    /// Show another result.
    Show {
        /// The node.
        node: String,
        /// The name of the result; the main one if left out.
        result: Option<String>,
    },
    /// Stop the run at work.
    Cancel,
    /// Run, whatever has changed.
    Run,
    /// Tell what is known of a face or a vertex.
    Pick {
        /// A number for the answer.
        request: u64,
        /// The face.
        face: Option<usize>,
        /// The vertex, of the face if both are given.
        vertex: Option<usize>,
    },
    /// Measure a distance.
    Measure {
        /// A number for the answer.
        request: u64,
        /// One end.
        from: MeasureEnd,
        /// The other.
        to: MeasureEnd,
    },
    /// Cut what is shown.
    Section {
        /// A number for the answer.
        request: u64,
        /// Where.
        plane: PlaneAsked,
    },
    /// Draw what is shown, for a browser that cannot.
    Render {
        /// A number for the answer.
        request: u64,
        /// Width and height in pixels.
        size: [u32; 2],
        /// From the model towards the eye; not zero.
        towards: [f64; 3],
    },
    /// Tell how the picture follows a parameter before the graph is evaluated.
    Preview {
        /// A number for the answer.
        request: u64,
        /// The parameter.
        name: String,
        /// The smallest value that it may be given next, in the file's units.
        from: f64,
        /// The largest one.
        to: f64,
    },
    /// Tell what is known of a node.
    Describe {
        /// The node.
        node: String,
    },
}

impl FromPage {
    /// Whether it changes the graph, what it runs with, or the run at work.
    pub fn is_change(&self) -> bool {
        use FromPage::{Cancel, Redo, Reset, Run, Set, Undo, Write};
        matches!(
            self,
            Set { .. } | Write { .. } | Reset { .. } | Undo | Redo | Cancel | Run
        )
    }
}

/// An end of a measured distance.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
pub struct MeasureEnd {
    /// A vertex.
    pub vertex: Option<usize>,
    /// Or a face.
    pub face: Option<usize>,
    /// Or a place of a cut.
    pub cut: Option<CutPlace>,
}

/// A plane.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub struct PlaneAsked {
    /// Its direction; need not be of length one.
    pub normal: [f64; 3],
    /// Its distance from the origin along that, in metres.
    pub at: f64,
}

/// The place of a cut that is closest to another.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub struct CutPlace {
    /// Where is cut.
    pub plane: PlaneAsked,
    /// Near this place, in metres.
    pub near: [f64; 3],
    /// Corners within this many metres are taken before sides.
    pub snap: f64,
}
