//! Every property of the add-on is understood or refused by its name.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use tessgraph_graph::world::MemoryWorld;

use super::keys::WITHOUT_COUNTERPART;
use super::{Holds, LATER_PASS, Request, graph};
use crate::support::{self, workspace};

/// Settings that have a counterpart: a graph is made of them.
const UNDERSTOOD: &[&str] = &[
    r#""fill_mode": "TRI", "rotation_shift": 1"#,
    r#""fill_mode": "FAN", "rotation_shift": 3, "scale_mode": "ADAPTIVE""#,
    r#""fill_mode": "FRAME", "frame_mode": "CENTER", "frame_thickness": 0.3, "fill_frame": true,
       "fill_frame_mat": 1, "preserve_quads": true"#,
    r#""fill_mode": "FRAME", "frame_boundary": true, "frame_boundary_thickness": 0.1"#,
    r#""fill_mode": "FRAME", "vertex_group_frame_thickness": "W", "face_weight_frame": false,
       "invert_vertex_group_frame_thickness": true, "vertex_group_frame_thickness_factor": 0.3"#,
    r#""rotation_mode": "UV""#,
    r#""rotation_mode": "WEIGHT", "vertex_group_rotation": "W", "rotation_direction": "DIAG",
       "invert_vertex_group_rotation": true"#,
    r#""use_origin_offset": false, "offset": 0.5, "zscale": 2.0"#,
    r#""use_origin_offset": false, "scale_mode": "CONSTANT""#,
    r#""smooth_normals": true, "smooth_normals_iter": 3, "smooth_normals_uv": -1.0"#,
    r#""smooth_normals": true, "vertex_group_smooth_normals": "W",
       "invert_vertex_group_smooth_normals": true"#,
    r#""normals_x": 1.0, "normals_y": 1.0, "normals_z": 0.0"#,
    r#""normals_mode": "CUSTOM", "smooth_normals": true"#,
    r#""normals_mode": "FACES", "smooth_normals": true, "auto_rotate_boundary": true,
       "normals_z": 0.5, "vertex_group_scale_normals": "W", "merge": true"#,
    r#""normals_mode": "OBJECT", "smooth_normals": true, "smooth_normals_iter": 3"#,
    r#""normals_mode": "OBJECT", "smooth_normals": true, "scale_mode": "CONSTANT",
       "vertex_group_smooth_normals": "W", "smooth_normals_uv": 0.5"#,
    r#""vertex_group_scale_normals": "W", "invert_vertex_group_scale_normals": true,
       "normals_x": 0.0"#,
    r#""vertex_group_scale_normals": "W", "invert_vertex_group_scale_normals": true"#,
    r#""bool_dissolve_seams": true, "mode": "LOCAL", "bounds_x": "CYCLIC", "merge": true"#,
    r#""normals_mode": "OBJECT", "even_thickness": true, "even_thickness_iter": 4,
       "scale_mode": "CONSTANT", "target": "T""#,
    r#""vertex_group_thickness": "W", "invert_vertex_group_thickness": true,
       "vertex_group_thickness_factor": 0.1"#,
    r#""merge": true, "merge_thres": 0.01, "merge_open_edges_only": true, "close_mesh": "CAP",
       "cap_material_offset": 1"#,
    r#""merge": true, "close_mesh": "BRIDGE_CAP", "bridge_material_offset": 1"#,
    r#""merge": false, "close_mesh": "BRIDGE""#,
    r#""mode": "GLOBAL", "bounds_x": "CYCLIC", "bounds_y": "CLIP""#,
    r#""component_mode": "OBJECT", "component": "C", "generator": "G", "iterations": 1"#,
    r#""fill_mode": "FAN", "rotation_mode": "WEIGHT", "vertex_group_rotation": "W",
       "rotation_shift": 1"#,
    r#""fill_mode": "TRI", "rotation_mode": "WEIGHT", "vertex_group_rotation": "W",
       "rotation_direction": "DIAG", "invert_vertex_group_rotation": true"#,
    r#""fill_mode": "TRI", "rotation_mode": "UV""#,
    r#""bool_selection": true"#,
    r#""bool_material_id": true, "material_id": 1, "bool_selection": true"#,
    r#""bool_material_id": true, "material_id": 7"#,
    r#""auto_rotate_boundary": true"#,
    r#""auto_rotate_boundary": true, "fill_mode": "FAN", "rotation_mode": "UV""#,
    r#""iterations": 3, "normals_mode": "OBJECT", "scale_mode": "CONSTANT",
       "even_thickness": true"#,
    r#""iterations": 2, "combine_mode": "ALL", "bool_vertex_group": true,
       "vertex_group_thickness": "W", "bool_material_id": true, "material_id": 1"#,
    r#""merge": true, "close_mesh": "BRIDGE_CAP", "bool_vertex_group": true,
       "vertex_group_bridge": "W", "invert_vertex_group_bridge": true, "vertex_group_cap": "W",
       "invert_vertex_group_cap": true"#,
    r#""bool_smooth": true, "bool_vertex_group": true, "bool_materials": false, "bool_hold": true,
       "bool_random": true, "bool_combine": true, "bool_advanced": true, "cap_faces": true,
       "bridge_cuts": 3, "bridge_smoothness": 0.5, "open_edges_crease": 1.0,
       "bridge_edges_crease": 1.0, "bridge_material_offset": 2, "boundary_mat_offset": 1,
       "boundary_variable_offset": true, "consistent_wedges": false, "gen_modifiers": false,
       "com_modifiers": false, "error_message": "e", "warning_message": "w",
       "warning_message_merge": "w", "warning_message_thickness": "w", "patch_subs": 2,
       "combine_mode": "ALL", "rand_seed": 3, "rand_step": 2, "coll_rand_seed": 4,
       "component_coll": "K", "vertex_group_distribution": "W", "material_id": 2,
       "vertex_group_distribution_factor": 0.5, "invert_vertex_group_distribution": true,
       "vertex_group_cap_owner": "BASE", "vertex_group_bridge_owner": "BASE""#,
];

/// Settings without a counterpart, or whose data a case's folder does not hold,
/// and the keys that must be named.
const REFUSED: &[(&str, &[&str])] = &[
    // Shape keys and collections by name are left to the add-on.
    (r#""normals_mode": "SHAPEKEYS""#, &["normals_mode"]),
    (r#""bool_shapekeys": true"#, &["bool_shapekeys"]),
    (
        r#""component_mode": "COLLECTION", "component_coll": "K", "coll_rand_seed": 1"#,
        &["component_mode", "component_coll", "coll_rand_seed"],
    ),
    // numpy's random numbers.
    (
        r#""rotation_mode": "RANDOM", "rand_seed": 1, "rand_step": 2"#,
        &["rotation_mode", "rand_seed", "rand_step"],
    ),
    // Components named as materials are in the scene only.
    (r#""component_mode": "MATERIALS""#, &["component_mode"]),
    // A patch has no one face that is flat.
    (
        r#""normals_mode": "FACES", "fill_mode": "PATCH""#,
        &["normals_mode"],
    ),
    (r#""bool_dissolve_seams": true"#, &["bool_dissolve_seams"]),
    // Groups of the component, of which a folder holds nothing.
    (
        r#""merge": true, "close_mesh": "BRIDGE", "vertex_group_bridge": "W",
           "invert_vertex_group_bridge": true"#,
        &["vertex_group_bridge", "invert_vertex_group_bridge"],
    ),
    (
        r#""merge": true, "close_mesh": "CAP", "vertex_group_cap": "W",
           "invert_vertex_group_cap": true"#,
        &["vertex_group_cap", "invert_vertex_group_cap"],
    ),
    // One file holds one group, and what a pass made has no selection.
    (
        r#""vertex_group_thickness": "W", "merge": true, "close_mesh": "CAP",
           "bool_vertex_group": true, "vertex_group_cap": "V""#,
        &["vertex_group_thickness", "vertex_group_cap"],
    ),
    (
        r#""iterations": 2, "bool_selection": true"#,
        &["bool_selection"],
    ),
    (
        r#""iterations": 2, "vertex_group_thickness": "W""#,
        &["vertex_group_thickness"],
    ),
    // What of a pass counts as unused is in the scene only.
    (
        r#""iterations": 2, "combine_mode": "UNUSED""#,
        &["combine_mode"],
    ),
    (
        r#""a_key_of_a_later_version": 1"#,
        &["a_key_of_a_later_version"],
    ),
];

/// For a folder that holds all it may.
fn request(settings: &str) -> Request {
    let names = |names: [&str; 2]| names.map(str::to_owned).to_vec();
    let holds = Holds {
        weights: true,
        selection: true,
        target: true,
        base_materials: names(["Glass", "Stone"]),
        component_materials: names(["Glass", "Steel"]),
    };
    graph(&format!("{{\"settings\": {{{settings}}}}}"), &holds)
}

#[test]
fn what_has_a_counterpart_becomes_a_graph() {
    for settings in UNDERSTOOD {
        match request(settings) {
            Request::Refused(keys) => panic!("{settings}: refused {keys:?}"),
            Request::Graph { text, later, .. } => {
                let mut world = MemoryWorld::default();
                world.insert(LATER_PASS, later.unwrap_or_default().as_bytes());
                let plan = support::try_load_in("case.ron", &text, &world);
                let found = plan.err().map(|found| support::shown(&found));
                assert_eq!(found, None, "{settings}\n{text}");
            }
        }
    }
}

#[test]
fn what_has_none_is_refused_by_name() {
    for (settings, expected) in REFUSED {
        match request(settings) {
            Request::Refused(keys) => {
                let keys: BTreeSet<&str> = keys.iter().map(String::as_str).collect();
                assert_eq!(keys, expected.iter().copied().collect(), "{settings}");
            }
            Request::Graph { text, .. } => panic!("{settings}: {text}"),
        }
    }
}

#[test]
fn all_that_is_refused_has_its_reason() {
    let refused: BTreeSet<&str> = REFUSED
        .iter()
        .flat_map(|(_, keys)| *keys)
        .copied()
        .collect();
    let reasons = WITHOUT_COUNTERPART.iter().map(|(key, _)| *key);
    assert_eq!(refused, reasons.collect());
    assert!(WITHOUT_COUNTERPART.is_sorted());
}

/// The list of the add-on's properties, beside this checkout or one further up.
fn list() -> Option<PathBuf> {
    let named = |folder: &Path| folder.join("shared/peer/tissue/features.md");
    let workspace = workspace();
    workspace.ancestors().map(named).find(|path| path.is_file())
}

#[test]
fn every_property_of_the_add_on_is_looked_at() {
    let Some(list) = list() else {
        println!("skipped: the list of properties is not here");
        return;
    };
    let text = support::text_of(&list);
    let rows = text.lines().filter_map(|line| line.strip_prefix("| `"));
    // The name of a UV layer, which cases name apart, is no property.
    let names = rows.filter_map(|row| row.split('`').next());
    let names: BTreeSet<&str> = names.filter(|name| *name != "Eval_Normals").collect();
    assert!(names.len() > 90, "{}", names.len());
    let settings = UNDERSTOOD
        .iter()
        .chain(REFUSED.iter().map(|(settings, _)| settings));
    let settings: String = settings.copied().collect();
    let missing: Vec<_> = names
        .into_iter()
        .filter(|name| !settings.contains(&format!("\"{name}\"")))
        .collect();
    assert!(missing.is_empty(), "{missing:?}");
}
