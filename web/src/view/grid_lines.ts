// Where the lines of the ground grid lie.
import type { Vec3 } from "../core/protocol.ts";
import { roundStep } from "../core/slider.ts";

/** Minor squares along a major one. */
const MINOR = 5;

/** Lines of a grid along x and y, in metres about `origin`; every fifth is a major one. */
export type GridLines = { step: number; minor: Float32Array; major: Float32Array; z: number };

/**
 * Lays lines over the model's bounds and half as much again. `scale` is file units
 * per metre; the grid lies at height 0, or under the model where 0 is far away.
 */
export function gridLines(bounds: [Vec3, Vec3], origin: Vec3, scale: number): GridLines {
  const [low, high] = bounds;
  const size = Math.max(high[0] - low[0], high[1] - low[1], high[2] - low[2], 1e-9);
  const step = (roundStep((size * scale) / 8) || 1) / scale / MINOR;
  const range = (axis: 0 | 1): [number, number] => {
    const margin = 0.5 * size;
    return [Math.floor((low[axis] - margin) / step / MINOR) * MINOR, Math.ceil((high[axis] + margin) / step / MINOR) * MINOR];
  };
  const [x0, x1] = range(0);
  const [y0, y1] = range(1);
  const near = low[2] - size < 0 && high[2] + size > 0;
  const z = (near ? 0 : low[2]) - origin[2];
  const minor: number[] = [];
  const major: number[] = [];
  for (let i = x0; i <= x1; i += 1) {
    const x = i * step - origin[0];
    (i % MINOR === 0 ? major : minor).push(x, y0 * step - origin[1], z, x, y1 * step - origin[1], z);
  }
  for (let j = y0; j <= y1; j += 1) {
    const y = j * step - origin[1];
    (j % MINOR === 0 ? major : minor).push(x0 * step - origin[0], y, z, x1 * step - origin[0], y, z);
  }
  return { step: MINOR * step, minor: new Float32Array(minor), major: new Float32Array(major), z };
}
