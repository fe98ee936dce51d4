//! What became of each vertex, in fields that agree with the counts.

use tessgraph_graph::Value;
use tessgraph_graph::value::ColumnValues;

use crate::support::Ran;

/// How many values of a field are each of 0 to 3, and -1.
fn tally(ran: &Ran, name: &str) -> [i64; 5] {
    let Value::Field(field) = ran.value(name) else {
        panic!("{name} is no field");
    };
    let mut counts = [0; 5];
    for &value in field.values().iter() {
        let place = if value < 0.0 { 4 } else { value as usize };
        counts[place] += 1;
    }
    counts
}

/// A shallow dome, and a smaller plate that faces it at 1.6: between them there is no
/// room for 1, beside them there is; over the dome's rim directions lean outward.
const FACING: &str = r#"
    "dome": ParametricSurface(x: "4 * u - 2", y: "4 * v - 2",
        z: "-0.3 * ((u - 0.5) ^ 2 + (v - 0.5) ^ 2)", cells: [8, 8]),
    "plate": Grid(cells: [2, 2], size: [2, 2], centre: true),
    "above": Transform(mesh: "plate", translate: (0, 0, 1.6)),
    "facing": FlipFaces(mesh: "above"),
    "base": JoinMeshes(meshes: ["dome", "facing"]),
    "normals": VertexNormals(mesh: "base"),
    "part": Cuboid(size: [1, 1, 2], centre: true),"#;

const STATUSES: [&str; 4] = ["solved", "extended", "border_clipped", "unsolved"];

#[test]
fn fields_of_compensated_directions_agree_with_the_counts() {
    for border in ["Clip", "Extend"] {
        let body = format!(
            "{FACING}\n\"out\": CompensateThickness(mesh: \"base\", directions: \"normals\", \
             thickness: 1, inward: 0.4, border: {border})"
        );
        let ran = Ran::nodes(&body, &[]);
        let mut seen = [0; 4];
        for side in ["outward", "inward"] {
            let tally = tally(&ran, &format!("out.{side}_status"));
            for (k, status) in STATUSES.iter().enumerate() {
                let count = ran.count(&format!("out.{side}_{status}"));
                assert_eq!(tally[k], count, "{border} {side} {status}");
                seen[k] += count;
            }
            assert_eq!(tally.iter().sum::<i64>(), 81 + 9);
        }
        for (k, status) in STATUSES.iter().enumerate() {
            assert_eq!(ran.count(&format!("out.{status}")), seen[k], "{status}");
        }
        assert!(seen[0] > 0 && seen[3] > 0, "{border}: {seen:?}");
        assert_eq!(seen[1] + seen[2] > 0, border == "Extend", "{seen:?}");
    }
}

#[test]
fn the_field_of_an_array_agrees_with_its_counts() {
    for join in ["None", "Weld"] {
        let body = format!(
            "{FACING}\n\"out\": ArrayComponents(base: \"base\", component: \"part\", \
             directions: \"normals\", compensate: PerVertex, join: {join})"
        );
        let ran = Ran::nodes(&body, &[]);
        let tally = tally(&ran, "out.status");
        for (k, status) in STATUSES.iter().enumerate() {
            let [out, inward] =
                ["outward", "inward"].map(|side| ran.count(&format!("out.{side}_{status}")));
            assert_eq!(tally[k], out + inward, "{join} {status}");
        }
        let vertices = ran.mesh("out").vertex_count() as i64;
        assert_eq!(tally.iter().sum::<i64>(), vertices);
        assert!(
            tally[3] > 0 && ran.count("out.unsolved") == tally[3],
            "{tally:?}"
        );
        let warnings = ran.warnings().concat();
        assert!(warnings.contains("3 in `status`"), "{warnings}");
    }
    let plain = format!(
        "{FACING}\n\"out\": ArrayComponents(base: \"base\", component: \"part\", directions: \"normals\")"
    );
    assert_eq!(tally(&Ran::nodes(&plain, &[]), "out.status"), [0; 5]);
}

#[test]
fn a_ramp_fills_its_histogram_evenly() {
    // 21 columns of vertices rise from 0 to 1 over a level base.
    let ran = Ran::nodes(
        r#""base": Grid(cells: [4, 4], size: [40, 40]),
        "ramp": ParametricSurface(x: "4 * u", y: "v", z: "u", cells: [20, 1]),
        "out": MeasureThickness(mesh: "ramp", base: "base", bins: 4)"#,
        &[],
    );
    let Value::Table(table) = ran.value("out.histogram") else {
        panic!("a table");
    };
    let column = |name: &str| {
        let found = table.columns().iter().find(|column| column.name == name);
        match found.map(|column| &column.values) {
            Some(ColumnValues::Number(values)) => values.clone(),
            Some(ColumnValues::Integer(values)) => values.iter().map(|&n| n as f64).collect(),
            other => panic!("{name}: {other:?}"),
        }
    };
    let close = |found: Vec<f64>, expected: [f64; 4]| {
        let off = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
        assert!(
            found.len() == 4 && off.fold(0.0, f64::max) < 1e-12,
            "{found:?}"
        );
    };
    close(column("from"), [0.0, 0.25, 0.5, 0.75]);
    close(column("to"), [0.25, 0.5, 0.75, 1.0]);
    let counts = column("vertices");
    assert!((counts.iter().sum::<f64>() - 42.0).abs() < 0.5);
    // Five columns of two each; rounding decides about those on the limits.
    assert!(
        counts.iter().all(|count| (8.0..=14.0).contains(count)),
        "{counts:?}"
    );
}

#[test]
fn numbers_do_where_fields_are_taken() {
    let ran = Ran::nodes(
        r#""base": Grid(cells: [3, 2], size: [3, 2]),
        "normals": VertexNormals(mesh: "base"),
        "low": Cuboid(size: [1, 1, 0.1]),
        "high": Cuboid(size: [1, 1, 0.5]),
        "second": ArrayComponents(base: "base", directions: "normals", components: ["low", "high"],
            choose: Index, index: 1),
        "last": ArrayComponents(base: "base", directions: "normals", components: ["low", "high"],
            choose: Gradient, gradient: "2 / 3"),
        "turned": RotateFaces(mesh: "base", by: Gradient, field: 3),
        "all": SelectFaces(mesh: "base", by: Field, field: 0.7),
        "none": SelectFaces(mesh: "base", by: Border, with: 0),
        "seven": SetAttribute(mesh: "base", name: "seven", on: Faces, field: 7),
        "sevens": AttributeField(mesh: "seven", name: "seven", on: Faces),
        "out": ColorByField(mesh: "base", field: 0.5)"#,
        &[],
    );
    let found = &ran.evaluation.diagnostics;
    assert!(ran.evaluation.is_ok(), "{}", crate::support::shown(found));
    for name in ["second", "last"] {
        let (_, high) = ran.mesh(name).bounds().expect("a mesh");
        assert!((high.z - 0.5).abs() < 1e-12, "{name}");
    }
    assert_eq!(ran.mesh("turned").face(4), ran.mesh("base").face(4));
    assert_eq!((ran.count("all.count"), ran.count("none.count")), (6, 0));
    assert_eq!(tally_of(&ran, "sevens"), [7.0; 6]);
    assert!((ran.number("out.low") - 0.5).abs() < 1e-12);
}

fn tally_of(ran: &Ran, name: &str) -> Vec<f64> {
    match ran.value(name) {
        Value::Field(field) => field.values().to_vec(),
        other => panic!("{:?}", other.kind()),
    }
}
