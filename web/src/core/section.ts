// Section planes and what is known of a cut, without a browser.
import type { Vec3 } from "./protocol.ts";

/** The places x with `normal · x = at`, in absolute metres; what lies beyond is cut away, or what lies before it if flipped. */
export type Section = { normal: Vec3; at: number; flipped: boolean };

export const AXES: Vec3[] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];

export function dot(a: Vec3, b: Vec3): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

export function cross(a: Vec3, b: Vec3): Vec3 {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

function unit(v: Vec3): Vec3 | undefined {
  const length = Math.hypot(...v);
  return length > 0 ? (v.map((c) => c / length) as Vec3) : undefined;
}

/** The axis a plane stands across: 0, 1, 2, or undefined where it is free. */
export function axisOf({ normal }: Section): number | undefined {
  const axis = AXES.findIndex((a) => dot(a, normal) === 1);
  return axis < 0 ? undefined : axis;
}

/** What people call a plane. */
export function planeName(section: Section): string {
  const axis = axisOf(section);
  return axis === undefined ? "free" : ("XYZ"[axis] ?? "");
}

/** How far a box reaches along a direction. */
export function reach(normal: Vec3, [low, high]: [Vec3, Vec3]): [number, number] {
  let [least, most] = [0, 0];
  normal.forEach((n, k) => {
    const ends = [n * (low[k] ?? 0), n * (high[k] ?? 0)];
    least += Math.min(...ends);
    most += Math.max(...ends);
  });
  return [least, most];
}

/** The plane of a polygon, by Newell's normal about its middle; undefined where it has none. */
export function planeThrough(corners: Vec3[]): { normal: Vec3; at: number } | undefined {
  const first = corners[0];
  if (corners.length < 3 || !first) return undefined;
  const middle = [0, 1, 2].map((k) => corners.reduce((sum, c) => sum + ((c[k] ?? 0) - first[k as 0]) / corners.length, 0) + first[k as 0]) as Vec3;
  let sum: Vec3 = [0, 0, 0];
  corners.forEach((a, i) => {
    const b = corners[(i + 1) % corners.length] ?? a;
    const turn = cross(a.map((c, k) => c - middle[k as 0]) as Vec3, b.map((c, k) => c - middle[k as 0]) as Vec3);
    sum = sum.map((c, k) => c + turn[k as 0]) as Vec3;
  });
  const normal = unit(sum);
  return normal && { normal, at: dot(normal, middle) };
}

/**
 * The plane after this one: across X, Y, Z through the middle of the box, then
 * through the picked face if there is one, then none.
 */
export function nextSection(section: Section | undefined, box: [Vec3, Vec3], picked: Vec3[]): Section | undefined {
  const flipped = section?.flipped ?? false;
  const axis = section ? axisOf(section) : -1;
  if (axis === undefined) return undefined;
  const normal = AXES[axis + 1];
  if (normal) {
    const [low, high] = reach(normal, box);
    return { normal, at: (low + high) / 2, flipped };
  }
  const plane = planeThrough(picked);
  return plane && { ...plane, flipped };
}

/** Two directions that span a plane, so that seen against the normal the second is to the left of the first. */
export function basisOf(normal: Vec3): [Vec3, Vec3] {
  const least = normal.map(Math.abs).indexOf(Math.min(...normal.map(Math.abs)));
  const u = unit(cross(AXES[least] ?? [1, 0, 0], normal)) ?? [1, 0, 0];
  return [u, cross(normal, u)];
}

/** Segments of a cut as the server sends them: both ends of each, about an origin. */
export type CutLines = { origin: Vec3; ends: Float32Array; panels: Uint32Array; closedCount: number };

/** How a place of the plane lies to the outlines. */
export type CutPlace = {
  /** How often closed outlines go around it; 0 is outside of every body. */
  winding: number;
  /** Metres to the nearest outline. */
  distance: number;
};

/** Looks a place up among the outlines of visible panels. */
export function placeOnCut(cut: CutLines, normal: Vec3, place: Vec3, isVisible: (panel: number) => boolean): CutPlace {
  const [u, v] = basisOf(normal);
  const about = place.map((c, k) => c - cut.origin[k as 0]) as Vec3;
  let winding = 0;
  let least = Number.POSITIVE_INFINITY;
  for (let i = 0; i < cut.panels.length; i += 1) {
    if (!isVisible(cut.panels[i] as number)) continue;
    const end = (k: number): Vec3 => [0, 1, 2].map((axis) => (cut.ends[6 * i + k + axis] ?? 0) - about[axis as 0]) as Vec3;
    const [from, to] = [end(0), end(3)];
    const [ax, ay, bx, by] = [dot(from, u), dot(from, v), dot(to, u), dot(to, v)];
    if (i < cut.closedCount && ay <= 0 !== by <= 0) {
      // A ray along u: crossings to the left of it turn one way, to the right the other.
      const side = ax * by - ay * bx;
      if (by > ay && side > 0) winding += 1;
      if (by < ay && side < 0) winding -= 1;
    }
    const [dx, dy] = [bx - ax, by - ay];
    const share = Math.min(1, Math.max(0, -(ax * dx + ay * dy) / (dx * dx + dy * dy || 1)));
    least = Math.min(least, Math.hypot(ax + share * dx, ay + share * dy));
  }
  return { winding, distance: least };
}

/** Corners of the triangles from one place to every closed segment of a visible panel: what they go around once more than back is inside. */
export function capFan(cut: CutLines, isVisible: (panel: number) => boolean): Float32Array {
  const corners: number[] = [];
  for (let i = 0; i < cut.closedCount; i += 1) {
    if (isVisible(cut.panels[i] as number)) corners.push(0, 0, 0, ...cut.ends.subarray(6 * i, 6 * i + 6));
  }
  return Float32Array.from(corners);
}

/** Both ends of every segment of a visible panel. */
export function capOutline(cut: CutLines, isVisible: (panel: number) => boolean): Float32Array {
  const ends: number[] = [];
  cut.panels.forEach((panel, i) => {
    if (isVisible(panel)) ends.push(...cut.ends.subarray(6 * i, 6 * i + 6));
  });
  return Float32Array.from(ends);
}
