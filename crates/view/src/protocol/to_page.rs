//! What the server tells the page.

use serde::Serialize;

use super::{
    BufferName, Check, Described, Document, Measured, NodeOutcome, Picked, Previewed, Problem,
    Sectioned, Shares, Shown, Status, Value,
};

/// What the server tells the page.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum ToPage {
    /// Who speaks; the first message of a connection.
    Hello(Hello),
    /// The graph file.
    Document(Document),
    /// Whether what is shown is true.
    Status(Status),
    /// What became of each node.
    Outcomes {
        /// In the order they are evaluated.
        nodes: Vec<NodeOutcome>,
    },
    /// What is wrong.
    Diagnostics {
        /// In the order of their places.
        items: Vec<Problem>,
    },
    /// What the graph measures and checks.
    Checks {
        /// In the order they are evaluated.
        items: Vec<Check>,
    },
    /// What the next picture will need, told as soon as it is known: before the run
    /// has ended.
    Coming(Coming),
    /// What the 3D view shows.
    Shown(Box<Shown>),
    /// The answer to [`FromPage::Pick`](super::FromPage::Pick).
    Picked(Picked),
    /// The answer to [`FromPage::Measure`](super::FromPage::Measure).
    Measured(Measured),
    /// The answer to [`FromPage::Section`](super::FromPage::Section).
    Sectioned(Sectioned),
    /// The answer to [`FromPage::Render`](super::FromPage::Render).
    Rendered {
        /// The number of the request.
        request: u64,
        /// The picture, a PNG.
        picture: BufferName,
    },
    /// The answer to [`FromPage::Describe`](super::FromPage::Describe).
    Described(Described),
    /// The answer to [`FromPage::Preview`](super::FromPage::Preview).
    Previewed(Box<Previewed>),
    /// Something people should know.
    Notice(Notice),
    /// The table of a study of the graph.
    Study(Study),
    /// What a page on another machine may do.
    Access {
        /// Whether it may change values.
        may_edit: bool,
    },
    /// With whom the page is shared: the answer to [`Sharing`](super::Sharing).
    Shares(Shares),
}

/// Who speaks.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Hello {
    /// Of the program.
    pub version: String,
    /// The graph file's name.
    pub file: String,
    /// The folder it is in.
    pub folder: String,
    /// Another one after each start of the server.
    pub session: String,
    /// Whether the page may change nothing.
    pub read_only: bool,
}

/// What the next picture will need.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Coming {
    /// Where its vertices are, as [`ShownMesh::positions`](super::ShownMesh) will
    /// name it.
    pub positions: BufferName,
}

/// How much a notice matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Level {
    /// Good to know.
    Info,
    /// Something was not done.
    Warning,
    /// Something went wrong.
    Error,
}

/// Something people should know.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Notice {
    /// How much it matters.
    pub level: Level,
    /// What.
    pub text: String,
}

/// The table of a study of the graph.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Study {
    /// The table's path.
    pub path: String,
    /// Its headings.
    pub columns: Vec<String>,
    /// Its rows.
    pub rows: Vec<Vec<Option<Value>>>,
    /// The number of the picture of each row that has one; none at all if empty.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub pictures: Vec<Option<usize>>,
}
