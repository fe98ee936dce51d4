import assert from "node:assert/strict";
import { test } from "node:test";
import { readFragment, viewFragment } from "../../src/core/link.ts";
import { measure, pick } from "../../src/core/offline.ts";
import type { ShownMesh } from "../../src/core/protocol.ts";
import { INITIAL_VIEW, type ViewState } from "../../src/core/settings.ts";
import { isReachable, qrModules } from "../../src/panels/share.ts";

const VIEW: ViewState = {
  ...INITIAL_VIEW,
  camera: { position: [1, 2, 3], target: [0, 0, 0.1], offset: [0, 0, 0], zoom: 1, orthographic: false },
  field: "tiefe höhe",
  section: { normal: [0, 0.6, 0.8], at: 1.25, flipped: true },
  panels: { hidden: [3, 4], isolated: undefined },
  node: { node: "facade", result: "mesh" },
};

test("a link brings a view back whole", () => {
  const selection = { panels: [7, 9], picked: { face: 70, panel: 7, vertex: 3, level: "face" as const } };
  const fragment = viewFragment(VIEW, selection);
  assert.match(fragment, /^#view=[\w-]+$/, "nothing that an address would have to spell otherwise");
  const read = readFragment(fragment);
  assert.deepEqual(read, JSON.parse(JSON.stringify({ camera: VIEW.camera, edges: VIEW.edges, grid: true, directions: false, ghost: false, field: VIEW.field, section: VIEW.section, panels: { hidden: [3, 4] }, node: VIEW.node, selection })));
});

test("a link stays short enough to be passed on", () => {
  const many = Array.from({ length: 20_000 }, (_, i) => i);
  const fragment = viewFragment({ ...VIEW, panels: { hidden: many, isolated: many } }, { panels: many });
  assert.ok(fragment.length < 2000);
  assert.deepEqual(readFragment(fragment)?.camera, VIEW.camera);
});

test("what a link says wrongly is left out", () => {
  const of = (value: unknown): string => `#view=${Buffer.from(JSON.stringify(value)).toString("base64url")}`;
  assert.equal(readFragment(""), undefined);
  assert.equal(readFragment("#view=%%%"), undefined);
  assert.equal(readFragment(of(3)), undefined);
  const wrong = { camera: { position: [1, 2], target: [0, 0, 0], offset: [0, 0, 0], zoom: 1, orthographic: false }, edges: "dotted", ghost: "yes", section: { normal: [0, 0, null], at: 1, flipped: false }, panels: { hidden: [-1] }, node: { node: "a" }, selection: { panels: [0.5] }, theme: "pink" };
  assert.deepEqual(readFragment(of(wrong)), {});
  assert.deepEqual(readFragment(of({ ...wrong, ghost: true })), { ghost: true });
});

test("a code of this machine's own name is of no use to another", () => {
  for (const host of ["localhost:1", "127.0.0.1:8137", "127.1.2.3", "[::1]:8137", "0.0.0.0:1", "x.localhost"]) assert.equal(isReachable(`http://${host}/`), false, host);
  for (const host of ["192.168.1.7:8137", "10.0.0.2:1", "[fd00::2]:8137"]) assert.equal(isReachable(`http://${host}/`), true, host);
});

test("a code has the three marks readers look for", () => {
  const modules = qrModules("http://192.168.1.7:8137/0123456789abcdef0123456789abcdef/");
  const size = modules.length;
  assert.ok(size >= 29 && modules.every((row) => row.length === size));
  const mark = (x: number, y: number): string => Array.from({ length: 7 }, (_, k) => (modules[y + k] ?? []).slice(x, x + 7).map(Number).join("")).join(" ");
  const expected = "1111111 1000001 1011101 1011101 1011101 1000001 1111111";
  assert.deepEqual([mark(0, 0), mark(size - 7, 0), mark(0, size - 7)], [expected, expected, expected]);
});

test("an offline page measures what is drawn", () => {
  const mesh = { vertices: 2, faces: 1, triangles: 1, origin: [100, 0, 0], bounds: [[100, 0, 0], [103, 4, 0]], scale: 100 } as unknown as ShownMesh;
  const told = { mesh, positions: new Float32Array([0, 0, 0, 3, 4, 0]), unit: "cm" };
  const measured = measure(told, 3, { vertex: 0 }, { vertex: 1 });
  assert.equal(measured?.distance.text, "500 cm");
  assert.deepEqual(measured?.delta.map((along) => along.text), ["300 cm", "400 cm", "0 cm"]);
  assert.equal(measure(told, 3, { vertex: 0 }, { vertex: 2 }), undefined);
  assert.deepEqual(pick(told, 1, { vertex: 1 }).lines.map(([label, { text }]) => [label, text]), [["vertex", "1"], ["x", "10300 cm"], ["y", "400 cm"], ["z", "0 cm"]]);
  assert.deepEqual(pick(told, 1, { face: 0 }).lines, [["face", { text: "0", exact: "0" }]]);
});
