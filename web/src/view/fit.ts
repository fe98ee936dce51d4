// Fitting a camera to a box.
import { type Box3, Vector3 } from "three";

/** The least distance from a box's centre at which a camera sees all its corners. */
export function fitDistance(corners: Vector3[], right: Vector3, up: Vector3, back: Vector3, tangentX: number, tangentY: number): number {
  let distance = 0;
  for (const corner of corners) {
    const depth = corner.dot(back);
    distance = Math.max(distance, depth + Math.abs(corner.dot(right)) / tangentX, depth + Math.abs(corner.dot(up)) / tangentY);
  }
  return distance;
}

/** The eight corners of a box. */
export function boxCorners(box: Box3): Vector3[] {
  return Array.from({ length: 8 }, (_, i) => new Vector3(
    i & 1 ? box.max.x : box.min.x,
    i & 2 ? box.max.y : box.min.y,
    i & 4 ? box.max.z : box.min.z,
  ));
}
