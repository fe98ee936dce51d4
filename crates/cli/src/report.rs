//! What a run came to, for people and for programs.

use std::fmt::Write as _;

use serde_json::{Value, json};
use tessgraph_graph::{NodeRun, Outcome};

use crate::json::{line, number};
use crate::outputs::WrittenOutput;
use crate::text::{Align, bytes_text, count, printable, table, time_text};

/// The outcome of a run.
pub(crate) struct RunReport<'a> {
    /// Whether everything asked for was made.
    pub(crate) ok: bool,
    /// Milliseconds from the start of the command.
    pub(crate) ms: f64,
    /// The nodes in the order of the plan.
    pub(crate) nodes: &'a [NodeRun],
    /// The most memory each node took, where that was measured.
    pub(crate) peaks: &'a [Option<u64>],
    /// The outputs that were made, in the order of the file.
    pub(crate) outputs: &'a [WrittenOutput],
}

impl RunReport<'_> {
    /// The nodes, each with the most memory it took.
    fn measured(&self) -> impl Iterator<Item = (&NodeRun, Option<u64>)> {
        let peaks = self.peaks.iter().copied().chain(std::iter::repeat(None));
        self.nodes.iter().zip(peaks)
    }
}

/// The outcomes in the order they are counted in.
const OUTCOMES: [Outcome; 6] = [
    Outcome::Computed,
    Outcome::Cached,
    Outcome::CutOff,
    Outcome::Failed,
    Outcome::Blocked,
    Outcome::Skipped,
];

/// The report as JSON on one line.
pub(crate) fn json(report: &RunReport<'_>) -> String {
    let nodes: Vec<Value> = report
        .measured()
        .map(|(node, peak)| node_json(node, peak))
        .collect();
    let outputs = report.outputs.iter().map(
        |output| json!({ "path": output.name, "bytes": output.bytes, "changed": output.changed }),
    );
    let outputs: Vec<Value> = outputs.collect();
    let report =
        json!({ "ok": report.ok, "ms": ms(report.ms), "nodes": nodes, "outputs": outputs });
    format!("{}\n", line(&report))
}

fn node_json(node: &NodeRun, peak: Option<u64>) -> Value {
    json!({
        "name": node.name,
        "kind": node.kind,
        "outcome": node.outcome.name(),
        "ms": ms(node.ms),
        "bytes": node.bytes,
        "peak_bytes": peak,
        "warnings": node.warnings,
    })
}

/// Milliseconds to the microsecond: what clocks are good for.
fn ms(ms: f64) -> Value {
    number((ms * 1000.0).round() / 1000.0)
}

/// The report as a table of nodes, a line per output and a summary.
pub(crate) fn human(report: &RunReport<'_>) -> String {
    let head = ["node", "kind", "outcome", "time", "size", "memory"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    rows.extend(report.measured().map(|(node, peak)| row(node, peak)));
    let align = [
        Align::Left,
        Align::Left,
        Align::Left,
        Align::Right,
        Align::Right,
        Align::Right,
    ];
    // What no node took, or nobody measured, needs no column.
    let columns = 5 + usize::from(report.peaks.iter().flatten().any(|&peak| peak > 0));
    rows.iter_mut().for_each(|row| row.truncate(columns));
    let mut text = table(&rows, &align[..columns]);
    let outputs = report.outputs.iter().map(|output| {
        let what = if output.changed {
            "written"
        } else {
            "unchanged"
        };
        let path = printable(&output.shown).into_owned();
        vec![path, bytes_text(output.bytes), what.to_owned()]
    });
    let outputs: Vec<_> = outputs.collect();
    if !outputs.is_empty() {
        text.push('\n');
        text.push_str(&table(&outputs, &[Align::Left, Align::Right, Align::Left]));
    }
    let _ = writeln!(text, "\n{}", summary(report));
    text
}

fn row(node: &NodeRun, peak: Option<u64>) -> Vec<String> {
    let ran = matches!(node.outcome, Outcome::Computed | Outcome::Failed);
    let time = ran.then(|| time_text(node.ms));
    let size = node
        .outcome
        .is_done()
        .then(|| bytes_text(node.bytes as u64));
    vec![
        printable(&node.name).into_owned(),
        node.kind.to_owned(),
        node.outcome.name().to_owned(),
        time.unwrap_or_default(),
        size.unwrap_or_default(),
        peak.map(bytes_text).unwrap_or_default(),
    ]
}

/// "5 nodes: 4 computed, 1 cached in 0.8 s".
pub(crate) fn summary(report: &RunReport<'_>) -> String {
    let counts = OUTCOMES.iter().filter_map(|outcome| {
        let number = report
            .nodes
            .iter()
            .filter(|node| node.outcome == *outcome)
            .count();
        (number > 0).then(|| format!("{number} {}", outcome.name().replace('_', " ")))
    });
    let counts: Vec<_> = counts.collect();
    let nodes = count(report.nodes.len(), "node");
    format!("{nodes}: {} in {}", counts.join(", "), time_text(report.ms))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn node(name: &str, outcome: Outcome, warnings: &[&str]) -> NodeRun {
        NodeRun {
            name: name.to_owned(),
            kind: "ReadMesh",
            outcome,
            ms: 1.23456,
            bytes: 14_210,
            warnings: warnings.iter().map(|&warning| warning.to_owned()).collect(),
        }
    }

    fn output(changed: bool) -> WrittenOutput {
        WrittenOutput {
            name: "out/a.glb".to_owned(),
            shown: "x/out/a.glb".to_owned(),
            bytes: 1_200_000,
            changed,
            lost: Vec::new(),
        }
    }

    #[test]
    fn json_has_the_documented_shape() {
        let nodes = [node("roof", Outcome::CutOff, &["open"])];
        let outputs = [output(true)];
        let report = RunReport {
            ok: true,
            ms: 800.0,
            nodes: &nodes,
            peaks: &[Some(1_300_000)],
            outputs: &outputs,
        };
        let expected = concat!(
            r#"{"ok":true,"ms":800.0,"nodes":[{"name":"roof","kind":"ReadMesh","#,
            r#""outcome":"cut_off","ms":1.235,"bytes":14210,"peak_bytes":1300000,"warnings":["open"]}],"#,
            r#""outputs":[{"path":"out/a.glb","bytes":1200000,"changed":true}]}"#,
            "\n"
        );
        assert_eq!(json(&report), expected);
    }

    #[test]
    fn people_see_a_table_and_a_summary() {
        let nodes = [
            node("roof", Outcome::Computed, &[]),
            node("smooth_dirs", Outcome::Cached, &[]),
            node("x", Outcome::Blocked, &[]),
        ];
        let outputs = [output(false)];
        let report = RunReport {
            ok: false,
            ms: 800.0,
            nodes: &nodes,
            peaks: &[Some(1_300_000), None, None],
            outputs: &outputs,
        };
        let expected = "\
node         kind      outcome     time     size  memory
roof         ReadMesh  computed  1.2 ms  14.2 kB  1.3 MB
smooth_dirs  ReadMesh  cached            14.2 kB
x            ReadMesh  blocked

x/out/a.glb  1.2 MB  unchanged

3 nodes: 1 computed, 1 cached, 1 blocked in 0.8 s
";
        assert_eq!(human(&report), expected);
        let unmeasured = RunReport {
            peaks: &[None; 3],
            ..report
        };
        assert!(
            human(&unmeasured).starts_with("node         kind      outcome     time     size\n")
        );
    }
}
