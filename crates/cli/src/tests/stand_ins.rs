//! Small nodes with which commands are tested.

use std::sync::Arc;
use std::time::{Duration, Instant};

use tessgraph_geometry::{Labels, Material, Mesh};
use tessgraph_graph::value::FilePath;
use tessgraph_graph::{EvalCx, Node, NodeError, NodeSpec};
use tessgraph_macros::{Inputs, Outputs};

pub(super) static NODES: &[NodeSpec] = &[
    NodeSpec::of::<Square>(),
    NodeSpec::of::<Length>(),
    NodeSpec::of::<Reads>(),
    NodeSpec::of::<Fails>(),
    NodeSpec::of::<Panics>(),
    NodeSpec::of::<Squares>(),
    NodeSpec::of::<Nothing>(),
    NodeSpec::of::<Waits>(),
];

/// Makes a square of one face.
#[derive(Inputs)]
struct Square {
    /// Length of a side.
    #[input(above = 0, unit = length)]
    side: f64,
    /// Whether its face has a material.
    #[input(default = false)]
    painted: bool,
}

fn square(side: f64) -> Result<Mesh, NodeError> {
    let corners = [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]];
    let corners = corners.map(|[x, y]| [x, y, 0.0]);
    Ok(Mesh::from_faces(corners.to_vec(), &[[0, 1, 2, 3]])?)
}

impl Node for Square {
    type Output = Arc<Mesh>;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let mesh = square(self.side)?;
        if !self.painted {
            return Ok(Arc::new(mesh));
        }
        cx.warn("fresh paint");
        let paint = Labels::new(vec![Material::named("paint")], vec![0])?;
        Ok(Arc::new(mesh.with_materials(paint)?))
    }
}

/// Gives a length back.
#[derive(Inputs)]
struct Length {
    /// The length.
    #[input(unit = length)]
    value: f64,
}

/// A report with one length.
#[derive(Outputs)]
#[outputs(report)]
struct Lengths {
    /// The length.
    #[output(unit = length)]
    length: f64,
}

impl Node for Length {
    type Output = Lengths;

    fn eval(self, _: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        Ok(Lengths { length: self.value })
    }
}

/// Reads a file and the file `beside` next to it, and gives their bytes.
#[derive(Inputs)]
struct Reads {
    /// The file.
    path: FilePath,
}

impl Node for Reads {
    type Output = usize;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let beside = cx
            .read_beside(&self.path, "beside.json")
            .map_or(0, |bytes| bytes.len());
        Ok(cx.read(&self.path)?.len() + beside)
    }
}

/// Fails.
#[derive(Inputs)]
struct Fails {
    /// Named in the error.
    value: f64,
}

impl Node for Fails {
    type Output = f64;

    fn eval(self, _: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let message = format!("{} is \x1b[31mno good", self.value);
        Err(NodeError::new(message)
            .at_input("value")
            .with_help("try \x07 again"))
    }
}

/// Panics.
#[derive(Inputs)]
struct Panics {
    /// Passed on.
    value: f64,
}

impl Node for Panics {
    type Output = f64;

    fn eval(self, _: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        panic!("on purpose: {}", self.value)
    }
}

/// Makes several squares.
#[derive(Inputs)]
struct Squares {
    /// How many.
    count: u32,
}

impl Node for Squares {
    type Output = Vec<Arc<Mesh>>;

    fn eval(self, _: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        (0..self.count).map(|_| square(1.0).map(Arc::new)).collect()
    }
}

/// Makes a mesh of nothing.
#[derive(Inputs)]
struct Nothing {}

impl Node for Nothing {
    type Output = Arc<Mesh>;

    fn eval(self, _: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        Ok(Arc::new(Mesh::from_faces::<[u32; 3]>(Vec::new(), &[])?))
    }
}

/// Waits, unless it is asked to stop.
#[derive(Inputs)]
struct Waits {
    /// What it gives back.
    value: f64,
    /// Seconds it takes.
    seconds: f64,
}

impl Node for Waits {
    type Output = f64;

    fn eval(self, cx: &EvalCx<'_>) -> Result<Self::Output, NodeError> {
        let start = Instant::now();
        while start.elapsed().as_secs_f64() < self.seconds {
            cx.monitor().check()?;
            std::thread::sleep(Duration::from_millis(1));
        }
        Ok(self.value)
    }
}
