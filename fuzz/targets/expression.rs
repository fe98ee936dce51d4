#![no_main]

use libfuzzer_sys::fuzz_target;

// The text as a formula over a field, and as a number.
fuzz_target!(|text: &str| {
    let text = text.escape_default();
    tessgraph_fuzz::evaluate_graph(&format!(
        "Graph(version: 1, params: {{\"t\": 0.5, \"k\": true}}, nodes: {{\"m\": Grid(cells: (2, 2)), \
         \"f\": EvaluateField(mesh: \"m\", value: \"{text}\"), \
         \"g\": Grid(cells: (1, 1), size: (\"{text}\", 1))}}, \
         outputs: {{\"f.json\": \"f\", \"g.obj\": \"g\"}})"
    ));
});
