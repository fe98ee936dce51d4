// The array's formula X(u, v, w) over the parts that the server sends, as the shader
// of view/instances.ts computes it on the graphics card; and what a parameter does.
import type { Vec3 } from "./protocol.ts";

/** The parts of an array, as their buffers hold them. */
export type Parts = {
  /** Placement and point of each vertex. */
  vertices: Uint32Array;
  /** Eight numbers a point: grid place and fractions of (u, v), height; the same of (u', v'), row. */
  points: Float32Array;
  grids: Uint32Array;
  gridStarts: Uint32Array;
  positions: Float32Array;
  /** Direction and length of each vertex of the base. */
  outward: Float32Array;
  inward?: Float32Array | undefined;
  /** Whether directions are units and lengths interpolated apart. */
  isUnit: boolean;
  factors: Float32Array[];
};

/** Numbers of a point; one of them is a texel of four. */
export const POINT_NUMBERS = 8;

/** Unit directions whose sum is shorter have cancelled out. */
export const CANCELLED = 1e-6;

/** Where a vertex of the array lies when all heights are multiplied by `factor`. */
export function positionOf(parts: Parts, vertex: number, factor: number): Vec3 {
  const placement = parts.vertices[2 * vertex] ?? 0;
  const point = POINT_NUMBERS * (parts.vertices[2 * vertex + 1] ?? 0);
  const number = (k: number): number => parts.points[point + k] ?? 0;
  const start = parts.gridStarts[placement] ?? 0;
  const row = number(7);
  const grid = (first: number): number[] => [first, first + 1, first + row, first + row + 1].map((k) => parts.grids[start + k] ?? 0);
  const place = { at: grid(number(0)), weights: weights(number(1), number(2)) };
  const direction = { at: grid(number(4)), weights: weights(number(5), number(6)) };
  const sum = ({ at, weights: by }: typeof place, values: Float32Array, width: number, part: number): number =>
    at.reduce((total, index, k) => total + (values[width * index + part] ?? 0) * (by[k] ?? 0), 0);
  const height = parts.factors.reduce((h, values) => h * sum(place, values, 1, 0), factor * number(3));
  const side = height < 0 && parts.inward ? parts.inward : parts.outward;
  const along = [0, 1, 2].map((axis) => sum(direction, side, 4, axis));
  let stretch = 1;
  if (parts.isUnit) {
    const length = Math.hypot(...along);
    stretch = length > CANCELLED ? sum(direction, side, 4, 3) / length : 0;
  }
  return [0, 1, 2].map((axis) => sum(place, parts.positions, 3, axis) + height * stretch * (along[axis] ?? 0)) as Vec3;
}

/** Weights of the four grid vertices about a place. */
function weights(f: number, g: number): number[] {
  return [(1 - f) * (1 - g), f * (1 - g), (1 - f) * g, f * g];
}

/** What heights are multiplied by at a value: on lines between the samples, and on beyond them. */
export function factorAt(samples: [number, number][], value: number): number {
  const after = samples.findIndex(([sample]) => sample >= value);
  const right = Math.max(1, after === -1 ? samples.length - 1 : after);
  const [from, low] = samples[right - 1] ?? [0, 1];
  const [to, high] = samples[right] ?? [from, low];
  return to === from ? low : low + ((high - low) * (value - from)) / (to - from);
}
