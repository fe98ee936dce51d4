// Fitting a camera to points.
import { type Box3, Vector3 } from "three";
import type { Vec3 } from "../core/protocol.ts";

/** Directions a camera looks along, and half its opening across and up as tangents. */
export type Lens = { right: Vector3; up: Vector3; back: Vector3; tangentX: number; tangentY: number };

/**
 * Where a camera looks and from how far. Parallel lines of sight look at `middle`
 * and need `extent` as half their width.
 */
export type Fit = { target: Vector3; distance: number; middle: Vector3; extent: number };

/**
 * The place from which a camera sees all points, and no farther than needed: the
 * four sides of its pyramid each touch a point. With a point p, its side to the
 * right is touched where x + z t is largest (z towards the camera, t the tangent),
 * and alike for the others; opposite sides meet at the sought place.
 */
export function fitPoints(points: Vector3[], lens: Lens): Fit {
  const { right, up, back, tangentX, tangentY } = lens;
  const most = { right: -Infinity, left: -Infinity, top: -Infinity, bottom: -Infinity };
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (const point of points) {
    const place = [point.dot(right), point.dot(up), point.dot(back)] as const;
    const [x, y, z] = place;
    most.right = Math.max(most.right, x + z * tangentX);
    most.left = Math.max(most.left, -x + z * tangentX);
    most.top = Math.max(most.top, y + z * tangentY);
    most.bottom = Math.max(most.bottom, -y + z * tangentY);
    place.forEach((c, k) => {
      low[k] = Math.min(low[k] as number, c);
      high[k] = Math.max(high[k] as number, c);
    });
  }
  const middle = (k: number): number => ((low[k] as number) + (high[k] as number)) / 2;
  const half = (k: number): number => ((high[k] as number) - (low[k] as number)) / 2;
  const eye = Math.max((most.right + most.left) / (2 * tangentX), (most.top + most.bottom) / (2 * tangentY));
  const x = (most.right - most.left) / 2;
  const y = (most.top - most.bottom) / 2;
  const at = (a: number, b: number): Vector3 => new Vector3().addScaledVector(right, a).addScaledVector(up, b).addScaledVector(back, middle(2));
  return { target: at(x, y), distance: eye - middle(2), middle: at(middle(0), middle(1)), extent: Math.max(half(0), (half(1) * tangentX) / tangentY) };
}

/** At most this many vertices stand for a model when the view is fitted to it. */
const MOST_SAMPLES = 5000;

/** Some of the vertices, evenly through the list. */
export function samplePoints(positions: Float32Array): Vec3[] {
  const count = Math.floor(positions.length / 3);
  const every = Math.max(1, Math.floor(count / MOST_SAMPLES));
  const points: Vec3[] = [];
  for (let i = 0; i < count; i += every) points.push([positions[3 * i] ?? 0, positions[3 * i + 1] ?? 0, positions[3 * i + 2] ?? 0]);
  return points;
}

/** The eight corners of a box. */
export function boxCorners(box: Box3): Vector3[] {
  return Array.from({ length: 8 }, (_, i) => new Vector3(
    i & 1 ? box.max.x : box.min.x,
    i & 2 ? box.max.y : box.min.y,
    i & 4 ? box.max.z : box.min.z,
  ));
}
