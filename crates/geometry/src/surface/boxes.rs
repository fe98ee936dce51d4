//! Axis-aligned boxes sorted so that those meeting another one are found fast.

use glam::DVec3;

use super::build;
use super::node::{LEAF, Node, Waiting};
use super::triangle::Triangle;
use crate::{GeometryError, Monitor};

/// Many boxes in the tree that [`super::Surface`] uses for its triangles.
#[derive(Debug)]
pub(crate) struct BoxTree {
    boxes: Vec<[DVec3; 2]>,
    nodes: Vec<Node>,
    /// The boxes of each leaf; a leaf that is not full repeats its last one.
    leaves: Vec<[u32; super::leaf::WIDTH]>,
    root: u32,
}

impl BoxTree {
    /// Sorts boxes, given by their lowest and highest corners, at least one.
    /// Cost: O(boxes · log boxes).
    ///
    /// # Errors
    /// [`GeometryError::Cancelled`].
    pub(crate) fn new(
        boxes: Vec<[DVec3; 2]>,
        monitor: &dyn Monitor,
    ) -> Result<Self, GeometryError> {
        // A box is sorted by its diagonal, a triangle without width.
        let diagonal = |index: u32| {
            let [low, high] = boxes[index as usize];
            Triangle([low, high, high])
        };
        let tree = build::build(boxes.len(), diagonal, monitor)?;
        let leaves = tree.leaves.iter().map(|leaf| leaf.triangles).collect();
        Ok(Self {
            nodes: tree.nodes,
            leaves,
            root: tree.root,
            boxes,
        })
    }

    /// Box `index` as its lowest and highest corner.
    pub(crate) fn bounds(&self, index: u32) -> [DVec3; 2] {
        self.boxes[index as usize]
    }

    /// Appends to `found` the boxes above `index` that meet box `index`,
    /// ascending. Cost: O(log boxes + found) for boxes that are not all over
    /// each other.
    pub(crate) fn meeting_above(&self, index: u32, found: &mut Vec<u32>) {
        let start = found.len();
        let own = self.bounds(index);
        let mut waiting = Waiting::new(self.root);
        while let Some((_, reference)) = waiting.pop() {
            if reference & LEAF != 0 {
                let leaf = &self.leaves[(reference & !LEAF) as usize];
                for (lane, &other) in leaf.iter().enumerate() {
                    let repeated = lane > 0 && leaf[lane - 1] == other;
                    if other > index && !repeated && overlap(own, self.bounds(other)) {
                        found.push(other);
                    }
                }
            } else {
                let node = &self.nodes[reference as usize];
                waiting.push(&node.apart(own[0], own[1]), &node.children, 0.0);
            }
        }
        found[start..].sort_unstable();
    }
}

/// Whether two boxes share a point, borders included.
pub(crate) fn overlap(a: [DVec3; 2], b: [DVec3; 2]) -> bool {
    a[0].cmple(b[1]).all() && b[0].cmple(a[1]).all()
}
