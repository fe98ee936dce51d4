// Marks over the model: the outline of what is picked and the line of a measurement.
import { BufferGeometry, Group, Line, LineBasicMaterial, LineLoop, Points, PointsMaterial, type Vector3 } from "three";
import type { ViewTheme } from "./theme.ts";

export class Marks {
  readonly group = new Group();
  private readonly outline = new LineLoop(new BufferGeometry(), new LineBasicMaterial({ depthTest: false }));
  private readonly line = new Line(new BufferGeometry(), new LineBasicMaterial({ depthTest: false }));
  private readonly points = new Points(new BufferGeometry(), new PointsMaterial({ depthTest: false, sizeAttenuation: false, size: 9 }));

  constructor() {
    for (const object of [this.outline, this.line, this.points]) {
      object.frustumCulled = false;
      object.visible = false;
      object.renderOrder = 5;
      this.group.add(object);
    }
  }

  /** Outlines a face, marks a vertex (one point), or neither. */
  setOutline(points: Vector3[]): void {
    this.outline.visible = points.length > 1;
    if (points.length > 1) replace(this.outline, points);
    this.setPoints(points.length === 1 ? points : []);
  }

  /** Draws a measurement's line between its ends, or none. */
  setLine(points: Vector3[]): void {
    this.line.visible = points.length > 1;
    if (points.length > 1) replace(this.line, points);
    this.setPoints(points);
  }

  private setPoints(points: Vector3[]): void {
    this.points.visible = points.length > 0;
    if (points.length > 0) replace(this.points, points);
  }

  setTheme(theme: ViewTheme): void {
    for (const object of [this.outline, this.line, this.points]) object.material.color.set(theme.pick);
  }
}

function replace(object: Line | Points, points: Vector3[]): void {
  object.geometry.dispose();
  object.geometry = new BufferGeometry().setFromPoints(points);
}
