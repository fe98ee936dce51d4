//! The node tree: which meshes are where.

use std::collections::BTreeMap;

use glam::{DAffine3, DMat3, DQuat, DVec3};
use serde::Deserialize;
use serde::de::IgnoredAny;
use tessgraph_geometry::glam;

use super::document::Document;
use super::{EXPORT, fault};
use crate::error::{FaultKind, IoError};

/// A scene: its root nodes.
#[derive(Deserialize)]
pub(super) struct Scene {
    #[serde(default)]
    nodes: Vec<u32>,
}

/// A node. Transforms are `f64` here, so that a translation to survey
/// coordinates keeps its millimetres.
#[derive(Deserialize)]
pub(super) struct Node {
    mesh: Option<u32>,
    #[serde(default)]
    children: Vec<u32>,
    name: Option<String>,
    matrix: Option<Vec<f64>>,
    translation: Option<[f64; 3]>,
    rotation: Option<[f64; 4]>,
    scale: Option<[f64; 3]>,
    skin: Option<IgnoredAny>,
    #[serde(default)]
    extensions: BTreeMap<String, IgnoredAny>,
}

/// A mesh at a place.
pub(super) struct Instance {
    pub(super) mesh: usize,
    /// The node's name, if it has one.
    pub(super) name: Option<String>,
    pub(super) scene_from_mesh: DAffine3,
    /// JSON pointer to the node.
    pub(super) pointer: String,
}

/// The mesh instances of the default scene, parents before children.
///
/// Every node is visited at most once, which rules out cycles and the
/// exponential growth of shared children; the walk keeps its own stack.
///
/// # Errors
/// When there is no scene or no mesh in it, or the nodes do not form trees.
pub(super) fn instances(
    document: &Document<'_>,
    warnings: &mut Vec<String>,
) -> Result<Vec<Instance>, IoError> {
    let (index, scene) = document.default_scene()?;
    let pointer = document.scenes.pointer(index);
    let mut visited = vec![false; document.nodes.len()];
    let mut notes = Notes::default();
    let mut instances = Vec::new();
    let roots = scene.nodes.iter().rev();
    let mut stack: Vec<_> = roots
        .map(|&node| (node as usize, None, DAffine3::IDENTITY))
        .collect();
    while let Some((index, parent, scene_from_parent)) = stack.pop() {
        let from = match parent {
            None => format!("{pointer}/nodes"),
            Some(parent) => format!("{}/children", document.nodes.pointer(parent)),
        };
        let node = document.nodes.get(index, &from)?;
        if std::mem::replace(&mut visited[index], true) {
            let cause = format!(
                "it reaches node {index} a second time; nodes form trees, without cycles or shared children"
            );
            return Err(fault(FaultKind::Syntax, &from, cause, EXPORT));
        }
        let pointer = document.nodes.pointer(index);
        let scene_from_node = scene_from_parent * node.transform(&pointer, &mut notes)?;
        if !scene_from_node.is_finite() {
            let cause = "the node's transform is not finite together with its parents'";
            return Err(fault(FaultKind::NotFinite, &pointer, cause, EXPORT));
        }
        if let Some(mesh) = node.mesh {
            notes.node(node, &scene_from_node);
            instances.push(Instance {
                mesh: mesh as usize,
                name: node.name.clone(),
                scene_from_mesh: scene_from_node,
                pointer,
            });
        }
        let children = node.children.iter().rev();
        stack.extend(children.map(|&child| (child as usize, Some(index), scene_from_node)));
    }
    if instances.is_empty() {
        let cause = "the default scene has no mesh";
        return Err(fault(
            FaultKind::Empty,
            &pointer,
            cause,
            "export the objects with the scene",
        ));
    }
    notes.report(warnings);
    Ok(instances)
}

/// Counts of what is read in another way than written.
#[derive(Default)]
struct Notes {
    skins: usize,
    instancing: usize,
    flat: usize,
    both: usize,
    not_unit: usize,
}

impl Notes {
    fn node(&mut self, node: &Node, transform: &DAffine3) {
        self.skins += usize::from(node.skin.is_some());
        self.instancing += usize::from(node.extensions.contains_key("EXT_mesh_gpu_instancing"));
        let [x, y, z] = transform.matrix3.to_cols_array_2d().map(DVec3::from);
        self.flat += usize::from(x.cross(y).dot(z).abs() == 0.0);
    }

    fn report(&self, warnings: &mut Vec<String>) {
        let mut say = |count: usize, text: &str| {
            if count > 0 {
                warnings.push(format!("{count} {text}"));
            }
        };
        say(
            self.skins,
            "skinned mesh(es): read in the pose of their nodes, without the skeleton",
        );
        say(
            self.instancing,
            "node(s) with EXT_mesh_gpu_instancing: read once, without the copies",
        );
        say(
            self.flat,
            "mesh node(s) have a transform without volume: their meshes are flattened",
        );
        say(
            self.both,
            "node(s) have a matrix and a translation, rotation or scale: the matrix counts",
        );
        say(
            self.not_unit,
            "node(s) have a rotation that is not of unit length: normalised",
        );
    }
}

impl Node {
    /// The node's own transform.
    fn transform(&self, pointer: &str, notes: &mut Notes) -> Result<DAffine3, IoError> {
        let parts = self.translation.is_some() || self.rotation.is_some() || self.scale.is_some();
        if let Some(matrix) = &self.matrix {
            notes.both += usize::from(parts);
            return affine(matrix, &format!("{pointer}/matrix"));
        }
        let mut rotation = DMat3::IDENTITY;
        if let Some(given) = self.rotation {
            let length = DQuat::from_array(given).length();
            if length == 0.0 || !length.is_finite() {
                let cause = "the rotation has no direction: its length is zero or not finite";
                let pointer = format!("{pointer}/rotation");
                return Err(fault(FaultKind::Syntax, &pointer, cause, EXPORT));
            }
            notes.not_unit += usize::from((length - 1.0).abs() > 1e-3);
            rotation = DMat3::from_quat(DQuat::from_array(given.map(|part| part / length)));
        }
        let scale = DVec3::from(self.scale.unwrap_or([1.0; 3]));
        Ok(DAffine3 {
            matrix3: rotation * DMat3::from_diagonal(scale),
            translation: DVec3::from(self.translation.unwrap_or_default()),
        })
    }
}

/// A column-major 4x4 matrix whose last row is 0 0 0 1.
#[expect(
    clippy::float_cmp,
    reason = "the specification demands exactly these values"
)]
fn affine(matrix: &[f64], pointer: &str) -> Result<DAffine3, IoError> {
    let Ok(m) = <[f64; 16]>::try_from(matrix) else {
        let cause = format!("the matrix has {} numbers instead of 16", matrix.len());
        return Err(fault(FaultKind::Syntax, pointer, cause, EXPORT));
    };
    if [m[3], m[7], m[11], m[15]] != [0.0, 0.0, 0.0, 1.0] {
        let cause = "the matrix has a projection in it: its last row is not 0 0 0 1";
        return Err(fault(
            FaultKind::Unsupported,
            pointer,
            cause,
            "apply the transform before export",
        ));
    }
    let column = |k: usize| DVec3::new(m[4 * k], m[4 * k + 1], m[4 * k + 2]);
    Ok(DAffine3 {
        matrix3: DMat3::from_cols(column(0), column(1), column(2)),
        translation: column(3),
    })
}
