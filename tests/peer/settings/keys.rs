//! The add-on's property names: which ask for nothing by themselves.

use serde_json::{Map, Value, json};

/// Read by nothing in the add-on, by its own account; names of objects that are
/// files here; and what only a Blender scene shows.
const IDLE: &[&str] = &[
    "bool_advanced",
    "bool_combine",
    "bool_hold",
    "bool_materials",
    "bool_random",
    "bool_smooth",
    "bridge_cuts",
    "bridge_smoothness",
    "cap_faces",
    "com_modifiers",
    "component",
    "error_message",
    "gen_modifiers",
    "generator",
    "target",
    "vertex_group_bridge_owner",
    "vertex_group_cap_owner",
    "warning_message",
    "warning_message_merge",
    "warning_message_thickness",
];

/// Say how something is done that only another key asks for.
const DEPENDENT: &[(&str, &[&str])] = &[
    ("bool_vertex_group", &[]),
    ("boundary_mat_offset", &["component_mode"]),
    ("boundary_variable_offset", &["component_mode"]),
    ("fill_frame_mat", &["component_mode"]),
    ("consistent_wedges", &["component_mode"]),
    ("coll_rand_seed", &["component_mode"]),
    ("component_coll", &["component_mode"]),
    ("vertex_group_distribution", &["component_mode"]),
    ("vertex_group_distribution_factor", &["component_mode"]),
    ("invert_vertex_group_distribution", &["component_mode"]),
    ("rand_seed", &["rotation_mode"]),
    ("rand_step", &["rotation_mode"]),
    ("material_id", &["bool_material_id"]),
    ("merge_thres", &["merge"]),
    ("merge_open_edges_only", &["merge"]),
    ("combine_mode", &["iterations"]),
    ("patch_subs", &["iterations"]),
    ("cap_material_offset", &[]),
    ("bridge_material_offset", &[]),
    ("open_edges_crease", &[]),
    ("bridge_edges_crease", &[]),
];

/// Values that ask for nothing.
fn defaults() -> Value {
    json!({
        "component_mode": "OBJECT", "rotation_mode": "DEFAULT", "rotation_direction": "ORTHO",
        "rotation_shift": 0, "bool_shapekeys": false, "bool_selection": false,
        "bool_material_id": false, "bool_dissolve_seams": false, "iterations": 1,
        "close_mesh": "NONE", "merge": false, "merge_open_edges_only": false, "auto_rotate_boundary": false, "use_origin_offset": true,
        "vertex_group_thickness": "", "invert_vertex_group_thickness": false,
        "vertex_group_thickness_factor": 0.0, "vertex_group_frame_thickness": "",
        "invert_vertex_group_frame_thickness": false, "vertex_group_frame_thickness_factor": 0.0,
        "vertex_group_cap": "", "invert_vertex_group_cap": false, "vertex_group_bridge": "",
        "invert_vertex_group_bridge": false, "vertex_group_rotation": "",
        "invert_vertex_group_rotation": false, "vertex_group_smooth_normals": "",
        "invert_vertex_group_smooth_normals": false, "smooth_normals_uv": 0.0,
        "normals_x": 1.0, "normals_y": 1.0, "normals_z": 1.0,
        "vertex_group_scale_normals": "", "invert_vertex_group_scale_normals": false,
        "frame_boundary_thickness": 0.0,
    })
}

/// What no graph here asks for, each with its reason; the first word of a reason
/// about some values of a key is "with".
pub(super) const WITHOUT_COUNTERPART: &[(&str, &str)] = &[
    ("a_key_of_a_later_version", "nobody knows what it asks for"),
    (
        "bool_dissolve_seams",
        "with a component that is not cut: its seams are marks in the scene",
    ),
    (
        "bool_selection",
        "with several passes: what a pass made has no selection in a folder",
    ),
    (
        "bool_shapekeys",
        "shapes of one mesh are files of their own here",
    ),
    ("coll_rand_seed", "of COLLECTION"),
    (
        "combine_mode",
        "with UNUSED: which faces of a pass are unused is in the scene only",
    ),
    ("component_coll", "of COLLECTION"),
    (
        "component_mode",
        "with COLLECTION and MATERIALS: further components are objects of the scene",
    ),
    ("invert_vertex_group_bridge", "of a group of the component"),
    ("invert_vertex_group_cap", "of a group of the component"),
    (
        "normals_mode",
        "with SHAPEKEYS, and FACES over patches: patches have no face of their own",
    ),
    ("rand_seed", "of RANDOM"),
    ("rand_step", "of RANDOM"),
    ("rotation_mode", "with RANDOM: numpy's random numbers"),
    (
        "vertex_group_bridge",
        "with a group of the component, of which a folder holds nothing",
    ),
    (
        "vertex_group_cap",
        "with a group of the component, of which a folder holds nothing",
    ),
    (
        "vertex_group_thickness",
        "with other groups, or in later passes unmapped: a folder holds one group",
    ),
];

/// Takes out of `settings` what asks for nothing: idle keys, values that are
/// the default, and dependent keys whose governing key is one of these.
pub(super) fn drop_idle(settings: &mut Map<String, Value>) {
    let defaults = defaults();
    let same = |value: &Value, default: &Value| match (value.as_f64(), default.as_f64()) {
        (Some(value), Some(default)) => value.to_bits() == default.to_bits(),
        _ => value == default,
    };
    settings.retain(|key, value| {
        let is_default = defaults
            .get(key)
            .is_some_and(|default| same(value, default));
        !(is_default || IDLE.contains(&key.as_str()))
    });
    for (key, governing) in DEPENDENT {
        if governing.iter().all(|key| !settings.contains_key(*key)) {
            settings.remove(*key);
        }
    }
}
