import assert from "node:assert/strict";
import { test } from "node:test";
import type { Vec3 } from "../../src/core/protocol.ts";
import { AXES, axisOf, basisOf, capFan, capOutline, cross, type CutLines, dot, nextSection, placeOnCut, planeName, planeThrough, reach } from "../../src/core/section.ts";

const BOX: [Vec3, Vec3] = [[0, 0, 0], [4, 2, 6]];

test("a press after the other goes across X, Y, Z, along the picked face, and ends", () => {
  const face: Vec3[] = [[0, 0, 1], [1, 0, 2], [1, 1, 2], [0, 1, 1]];
  const names: string[] = [];
  let section = nextSection(undefined, BOX, face);
  while (section) {
    names.push(`${planeName(section)} ${section.at.toFixed(3)}`);
    section = nextSection(section, BOX, face);
  }
  assert.deepEqual(names, ["X 2.000", "Y 1.000", "Z 3.000", "free 0.707"]);
  const z = { normal: [0, 0, 1] as Vec3, at: 3, flipped: true };
  assert.equal(nextSection(z, BOX, []), undefined, "nothing is picked");
  assert.equal(nextSection(z, BOX, face)?.flipped, true);
});

test("a plane through a face lies on it, and a line has none", () => {
  const plane = planeThrough([[9, 0, 5], [10, 0, 5], [10, 1, 5], [9, 1, 5]]);
  assert.deepEqual(plane, { normal: [0, 0, 1], at: 5 });
  assert.equal(planeThrough([[0, 0, 0], [1, 1, 1], [2, 2, 2]]), undefined);
  assert.equal(axisOf({ normal: [0, 0, -1], at: 0, flipped: false }), undefined);
});

test("a box reaches as far as its corners", () => {
  assert.deepEqual(AXES.map((axis) => reach(axis, BOX)), [[0, 4], [0, 2], [0, 6]]);
  assert.deepEqual(reach([0.6, 0, -0.8], BOX).map((c) => Number(c.toFixed(12))), [-4.8, 2.4]);
});

test("a basis is square, and turns left seen against the normal", () => {
  for (const normal of [...AXES, [0.6, 0, 0.8] as Vec3, [-0.48, 0.6, 0.64] as Vec3]) {
    const [u, v] = basisOf(normal);
    for (const [a, b] of [[u, v], [u, normal], [v, normal]] as const) assert.ok(Math.abs(dot(a, b)) < 1e-12);
    cross(u, v).forEach((c, k) => assert.ok(Math.abs(c - (normal[k as 0] ?? 0)) < 1e-12));
  }
});

/** A square of side 2 about (10, 0, 0) with a square hole of side 1, across Z, and an open line to the right. */
function frame(): CutLines {
  const square = (size: number): number[][] => [[-size, -size], [size, -size], [size, size], [-size, size]];
  const loop = (corners: number[][]): number[][] => corners.map((from, i) => [...from, 0, ...(corners[(i + 1) % 4] ?? []), 0]);
  const segments = [...loop(square(1)), ...loop(square(0.5).reverse()), [3, -1, 0, 3, 1, 0]];
  return { origin: [10, 0, 0], ends: Float32Array.from(segments.flat()), panels: Uint32Array.from([1, 1, 1, 1, 2, 2, 2, 2, 3]), closedCount: 8 };
}

test("a place is inside, in a hole, outside, or near an open line", () => {
  const at = (x: number, y: number, visible = (_: number): boolean => true): { winding: number; distance: number } => placeOnCut(frame(), [0, 0, 1], [10 + x, y, 0], visible);
  assert.equal(at(0.75, 0.1).winding, 1);
  assert.equal(at(0, 0).winding, 0);
  assert.equal(at(0, 0, (panel) => panel !== 2).winding, 1, "the hole's panel is hidden");
  assert.equal(at(2.75, 0).winding, 0);
  assert.ok(Math.abs(at(2.75, 0).distance - 0.25) < 1e-6);
  // From the other side of the plane outlines turn the other way.
  assert.equal(placeOnCut(frame(), [0, 0, -1], [10.75, 0.1, 0], () => true).winding, -1);
});

test("a cap is made of closed outlines of visible panels alone", () => {
  assert.equal(capFan(frame(), () => true).length, 8 * 9);
  assert.equal(capOutline(frame(), () => true).length, 9 * 6);
  assert.equal(capFan(frame(), (panel) => panel === 3).length, 0);
  assert.deepEqual([...capOutline(frame(), (panel) => panel === 3)], [3, -1, 0, 3, 1, 0]);
});
