import assert from "node:assert/strict";
import { test } from "node:test";
import { Vector3 } from "three";
import { pause } from "../../src/core/connection.ts";
import { BOX_WIDTH, layoutGraph } from "../../src/core/layout.ts";
import { blocks, spans } from "../../src/core/markdown.ts";
import type { Document, GraphNode, Status } from "../../src/core/protocol.ts";
import { Offsets, tokens } from "../../src/core/source.ts";
import { nearestRow, studyAxes } from "../../src/core/study.ts";
import { chipOf } from "../../src/panels/chip.ts";
import { rank } from "../../src/panels/dialogs.ts";
import { groupParameters } from "../../src/panels/parameters.ts";
import { sortedRows } from "../../src/panels/table.ts";
import { choices } from "../../src/panels/topbar.ts";
import { Panels } from "../../src/tools/panels.ts";
import { nextPick } from "../../src/tools/picking.ts";
import { wrap } from "../../src/tools/screenshot.ts";
import { fitPoints, samplePoints } from "../../src/view/fit.ts";
import { gridLines } from "../../src/view/grid_lines.ts";
import { scaleLength } from "../../src/view/scale.ts";

function node(name: string, ...from: string[]): GraphNode {
  return { name, kind: "Grid", about: "", line: 1, span: [0, 1], inputs: from.map((f) => ({ name: "mesh", text: f, from: [f] })), results: [{ name: "mesh", kind: "Mesh", main: true }] };
}

test("the graph runs left to right and no boxes overlap", () => {
  const nodes = [node("roof"), node("surface", "roof"), node("smooth", "surface"), node("even", "surface", "smooth"), node("facade", "surface", "even")];
  const layout = layoutGraph(nodes);
  const byName = new Map(layout.boxes.map((box) => [box.name, box]));
  for (const line of layout.lines) {
    const [from, to] = [byName.get(line.from), byName.get(line.to)];
    assert.ok(from && to && from.x + BOX_WIDTH <= to.x, `${line.from} before ${line.to}`);
  }
  for (const a of layout.boxes) {
    for (const b of layout.boxes) {
      const apart = a === b || a.x + a.width <= b.x || b.x + b.width <= a.x || a.y + a.height <= b.y || b.y + b.height <= a.y;
      assert.ok(apart, `${a.name} and ${b.name}`);
    }
  }
  assert.equal(layout.lines.length, 6);
  assert.deepEqual(layoutGraph(nodes), layout, "the same graph, the same picture");
});

test("references that lead nowhere do not break the layout", () => {
  assert.equal(layoutGraph([node("a", "gone", "a")]).lines.length, 0);
  assert.deepEqual(layoutGraph([]), { boxes: [], lines: [], width: 0, height: 0 });
});

test("bytes of the server become places in the page's text", () => {
  const text = '// façade — é\n"t": 0.25';
  const start = new TextEncoder().encode('// façade — é\n"t": ').length;
  const [from, to] = new Offsets(text).range([start, start + 4]);
  assert.equal(text.slice(from, to), "0.25");
  assert.deepEqual(new Offsets("ab").range([9, 12]), [2, 2]);
});

test("RON lines are taken apart without losing a letter", () => {
  const line = '    "t": Number(default: 0.12, about: "a \\" b"), // 3 "x"';
  const parts = tokens(line);
  assert.equal(parts.map((p) => p.text).join(""), line);
  assert.deepEqual(parts.filter((p) => p.kind === "number").map((p) => p.text), ["0.12"]);
  assert.equal(parts.at(-1)?.kind, "comment");
});

test("the chip says what is true of the picture", () => {
  const of = (status: Partial<Status>): string => chipOf("open", false, { type: "status", state: "up_to_date", ...status }, undefined).text;
  assert.equal(of({ ms: 210 }), "Up to date 210 ms");
  assert.equal(of({ state: "computing", done: 3, total: 7, node: "even", fraction: 0.5 }), "Computing 3/7 even 50 %");
  const timed = (elapsed: number, last?: number): string => chipOf("open", false, { type: "status", state: "computing", done: 0, total: 2 }, undefined, { elapsed, last }).text;
  assert.equal(timed(100, 4000), "Computing 0/2");
  assert.equal(timed(1234, 4000), "Computing 0/2 · 1.2 s of ~4.00 s");
  assert.equal(timed(1234), "Computing 0/2 · 1.2 s");
  assert.equal(of({ state: "stale", errors: 2, line: 14 }), "Stale: 2 errors (line 14)");
  assert.equal(of({ state: "stale", errors: 1 }), "Stale: 1 error");
  assert.equal(of({ state: "waiting", waiting_for: "meshes/roof.obj" }), "Waiting for meshes/roof.obj");
  assert.equal(chipOf("retrying", false, { type: "status", state: "up_to_date" }, undefined).text, "Disconnected: retrying");
  assert.match(chipOf("refused", false, undefined, undefined).text, /new address/);
  assert.equal(chipOf("open", true, { type: "status", state: "up_to_date" }, undefined).text, "Up to date · Read only (shared)");
  assert.equal(chipOf("open", true, { type: "status", state: "computing" }, undefined).act, undefined, "a guest stops nobody's run");
  assert.match(chipOf("offline", true, { type: "status", state: "up_to_date" }, undefined).text, /^Offline page/);
});

test("each result stands once in the menu, with its name when it is not the main one", () => {
  const graph: Document = {
    type: "document", source: "", units: "m", parameters: [], can_undo: false, can_redo: false,
    nodes: [{ ...node("check"), results: [{ name: "pairs", kind: "Report", main: true }, { name: "flags", kind: "Field", main: false }] }],
    outputs: [
      { path: "a.json", node: "check", result: "pairs", kind: "Report" },
      { path: "b.json", node: "check", result: "pairs", kind: "Report" },
      { path: "c.csv", node: "check", result: "flags", kind: "Field" },
    ],
  };
  assert.deepEqual(choices(graph, undefined).map((c) => c.label), ["check (Report)", "check.flags (Field)"]);
});

test("many parameters fall into groups by their first word", () => {
  assert.deepEqual(groupParameters(["roof_width", "depth", "roof_height", "smooth"]), [
    { title: "roof", names: ["roof_width", "roof_height"] },
    { title: "other", names: ["depth", "smooth"] },
  ]);
});

test("tables sort by number, text and emptiness, and keep the order of equals", () => {
  const rows = [[2, "b10"], [null, "b9"], [1, "a"], [2, "b2"]];
  assert.deepEqual(sortedRows(rows, 0, false), [2, 0, 3, 1]);
  assert.deepEqual(sortedRows(rows, 0, true), [0, 3, 2, 1], "empty cells stay last");
  assert.deepEqual(sortedRows(rows, 1, false), [2, 3, 1, 0]);
});

test("a search finds beginnings first, then words, then letters", () => {
  assert.equal(rank("smooth_dirs", "smo"), 0);
  assert.equal(rank("smooth_dirs", "dirs"), 1);
  assert.equal(rank("smooth_dirs", "moot"), 2);
  assert.equal(rank("smooth_dirs", "sds"), 3);
  assert.equal(rank("smooth_dirs", "xyz"), undefined);
});

test("reference pages become blocks of plain text", () => {
  const list = blocks("# A\n\nOne\ntwo `x`.\n\n- item\n\n| a | b |\n|---|---|\n| 1 | 2 \\| 3 |\n\n```ron\n<script>\n```\n");
  assert.deepEqual(list, [
    { kind: "heading", text: "A" },
    { kind: "paragraph", text: "One two `x`." },
    { kind: "item", text: "item" },
    { kind: "row", cells: ["a", "b"], head: true },
    { kind: "row", cells: ["1", "2 | 3"], head: false },
    { kind: "code", text: "<script>" },
  ]);
  assert.deepEqual(spans("a `b` [c](d.md)"), ["a ", "b", " c"]);
});

test("a study's columns become axes, words in order", () => {
  const axes = studyAxes(["t", "mode", "pairs"], [[0.1, "b", "3"], [0.3, "a", null], [0.2, "c", "5"]], String);
  const round = (axis: number): number[] => [...(axes[axis]?.places ?? [])].map((p) => Number(p.toFixed(6)));
  assert.deepEqual(round(0), [0, 1, 0.5]);
  assert.deepEqual(round(1), [0.5, 0, 1]);
  assert.deepEqual(round(2), [0, Number.NaN, 1]);
  assert.equal(nearestRow(axes, 0, 1, () => true), 1);
  assert.equal(nearestRow(axes, 0, 1, (row) => row !== 1), undefined);
  assert.equal(nearestRow(axes, 0.5, 0.25, () => true), 0);
});

test("pauses between attempts to connect grow to two seconds", () => {
  const list = [0, 1, 2, 3, 4, 5, 20].map(pause);
  assert.deepEqual(list, [100, 200, 400, 800, 1600, 2000, 2000]);
});

test("grids lie at round distances of the file's unit, under what is far from zero", () => {
  const lines = gridLines([[0, 0, 0], [10, 10, 3]], [5, 5, 1.5], 1000);
  assert.equal(lines.step, 1);
  assert.equal(lines.z, -1.5);
  const far = gridLines([[5e6, 5e6, 400], [5e6 + 10, 5e6 + 10, 403]], [5e6, 5e6, 400], 1);
  assert.equal(far.z, 0);
  assert.ok(far.major.every((x) => Math.abs(x) < 100), "numbers stay small far from the origin");
});

test("the scale bar is a round length that fits", () => {
  const { length, pixels } = scaleLength(0.013);
  assert.equal(length, 1);
  assert.ok(Math.abs(pixels - 1 / 0.013) < 1e-9);
});

test("a fitted camera sees every point, and two opposite sides touch", () => {
  const points = [[-1, -2, -3], [4, 2, 3], [1, -2, 3], [-1, 2, -3], [0, 0, 5]].map(([x = 0, y = 0, z = 0]) => new Vector3(x, y, z));
  const lens = { right: new Vector3(1, 0, 0), up: new Vector3(0, 1, 0), back: new Vector3(0, 0, 1), tangentX: 0.5, tangentY: 0.3 };
  const { target, distance, extent } = fitPoints(points, lens);
  const seen = points.map((p) => p.clone().sub(target)).map((p) => ({ x: p.x / (distance - p.z) / 0.5, y: p.y / (distance - p.z) / 0.3 }));
  const sides = [Math.max(...seen.map((s) => s.x)), -Math.min(...seen.map((s) => s.x)), Math.max(...seen.map((s) => s.y)), -Math.min(...seen.map((s) => s.y))];
  for (const side of sides) assert.ok(side <= 1 + 1e-12, String(sides));
  const touching = sides.map((side) => Math.abs(side - 1) < 1e-12);
  assert.ok((touching[0] && touching[1]) || (touching[2] && touching[3]), String(sides));
  assert.ok(extent >= 2.5 && extent >= (2 * 0.5) / 0.3);
});

test("clicks go from the panel to its face to its vertex, and begin anew elsewhere", () => {
  const hit = { face: 5, panel: 2, vertex: 9 };
  const panel = nextPick(undefined, hit, true);
  assert.equal(panel.level, "panel");
  const face = nextPick(panel, hit, true);
  assert.equal(face.level, "face");
  assert.equal(nextPick(face, { ...hit, face: 6 }, true).level, "face", "another face of the same panel");
  const vertex = nextPick(face, hit, true);
  assert.equal(vertex.level, "vertex");
  assert.equal(nextPick(vertex, hit, true).level, "panel");
  assert.equal(nextPick(face, { ...hit, face: 7, panel: 3 }, true).level, "panel");
  assert.equal(nextPick(undefined, { ...hit, panel: 5 }, false).level, "face", "without panels, faces come first");
});

test("panels are hidden and isolated by what is selected", () => {
  const panels = new Panels();
  panels.select(1, false);
  panels.select(3, true);
  assert.deepEqual([...panels.states()], [0, 4, 0, 4]);
  panels.select(3, true);
  assert.deepEqual([...panels.states()], [0, 4], "a second Shift click takes it away");
  assert.equal(panels.hide(), 1);
  assert.deepEqual([...panels.states()], [0, 1]);
  panels.select(0, false);
  panels.isolate();
  assert.deepEqual([...panels.states()], [6, 1]);
  const copy = new Panels();
  copy.restore(panels.state());
  assert.ok(copy.isIsolating && copy.hidesSome);
  assert.deepEqual([...copy.states()], [2, 1]);
  copy.isolate();
  assert.ok(!copy.isIsolating);
  copy.showAll();
  assert.equal(copy.states().length, 0);
});

test("few vertices stand for many, and all for few", () => {
  assert.equal(samplePoints(new Float32Array(12)).length, 4);
  const many = samplePoints(Float32Array.from({ length: 3 * 100_000 }, (_, i) => i));
  assert.ok(many.length >= 5000 && many.length <= 10_000);
  assert.deepEqual(many[0], [0, 1, 2]);
});

test("captions fill their lines", () => {
  assert.deepEqual(wrap(["aaa", "bbb", "c"], "  ", 8, (t) => t.length), ["aaa  bbb", "c"]);
});
