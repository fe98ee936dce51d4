// The array's formula against the vertices that the server has evaluated.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { factorAt, type Parts, positionOf } from "../../src/core/instances.ts";
import type { Vec3 } from "../../src/core/protocol.ts";

type Fixture = {
  origin: Vec3;
  bounds: [Vec3, Vec3];
  is_unit: boolean;
  reach: number;
  samples: [number, number][];
  vertices: number[];
  points: number[];
  grids: number[];
  grid_starts: number[];
  positions: number[];
  outward: number[];
  inward: number[];
  factors: number[][];
  expected: { value: number; origin: Vec3; positions: number[] }[];
};

const fixture = JSON.parse(readFileSync(new URL("instances.json", import.meta.url), "utf8")) as Fixture;

const parts: Parts = {
  vertices: Uint32Array.from(fixture.vertices),
  points: Float32Array.from(fixture.points),
  grids: Uint32Array.from(fixture.grids),
  gridStarts: Uint32Array.from(fixture.grid_starts),
  positions: Float32Array.from(fixture.positions),
  outward: Float32Array.from(fixture.outward),
  inward: Float32Array.from(fixture.inward),
  isUnit: fixture.is_unit,
  factors: fixture.factors.map((values) => Float32Array.from(values)),
};

test("the formula gives the evaluated vertices, at every value of the parameter", () => {
  const [low, high] = fixture.bounds;
  const size = Math.max(...[0, 1, 2].map((axis) => (high[axis] ?? 0) - (low[axis] ?? 0)));
  const count = parts.vertices.length / 2;
  assert.ok(count >= 24 && fixture.expected.length === 3);
  for (const { value, origin, positions } of fixture.expected) {
    assert.equal(positions.length, 3 * count);
    const factor = factorAt(fixture.samples, value);
    for (let vertex = 0; vertex < count; vertex += 1) {
      const found = positionOf(parts, vertex, factor);
      for (const axis of [0, 1, 2]) {
        const exact = (positions[3 * vertex + axis] ?? Number.NaN) + (origin[axis] ?? 0) - (fixture.origin[axis] ?? 0);
        const off = Math.abs((found[axis] ?? Number.NaN) - exact);
        assert.ok(off <= 1e-6 * size, `vertex ${vertex}, axis ${axis} at ${value}: off by ${off}`);
      }
    }
  }
});

test("no vertex is farther from the base than the server says", () => {
  const flat = { ...parts, points: parts.points.map((number, k) => (k % 8 === 3 ? 0 : number)) };
  let most = 0;
  for (let vertex = 0; 2 * vertex < parts.vertices.length; vertex += 1) {
    const [a, b] = [positionOf(parts, vertex, 1), positionOf(flat, vertex, 1)];
    most = Math.max(most, Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
  }
  assert.ok(most > 0 && most <= fixture.reach * (1 + 1e-6), `${most}, ${fixture.reach}`);
});

test("factors lie on lines between the samples, and beyond them", () => {
  const samples: [number, number][] = [
    [1, 0.5],
    [2, 1],
    [4, 5],
  ];
  const at = (value: number): number => factorAt(samples, value);
  assert.deepEqual([0, 1, 1.5, 2, 3, 4, 5].map(at), [0, 0.5, 0.75, 1, 3, 5, 7]);
});
