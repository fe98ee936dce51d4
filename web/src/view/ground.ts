// The ground grid: lines at round distances in the file's unit, around the model.
import { BufferAttribute, BufferGeometry, Group, LineBasicMaterial, LineSegments } from "three";
import type { Vec3 } from "../core/protocol.ts";
import { gridLines } from "./grid_lines.ts";
import type { ViewTheme } from "./theme.ts";

export class Ground {
  readonly group = new Group();
  private readonly minor = new LineSegments(new BufferGeometry(), new LineBasicMaterial());
  private readonly major = new LineSegments(new BufferGeometry(), new LineBasicMaterial());
  private drawn = "";

  constructor() {
    for (const lines of [this.minor, this.major]) {
      lines.frustumCulled = false;
      this.group.add(lines);
    }
    this.minor.renderOrder = -2;
    this.major.renderOrder = -1;
    (this.minor.material as LineBasicMaterial).depthWrite = false;
  }

  update(bounds: [Vec3, Vec3], origin: Vec3, scale: number): void {
    const lines = gridLines(bounds, origin, scale);
    const name = `${lines.step} ${lines.z} ${lines.minor.length} ${lines.major.join(" ")}`;
    if (name === this.drawn) return;
    this.drawn = name;
    this.minor.geometry.dispose();
    this.major.geometry.dispose();
    this.minor.geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(lines.minor, 3));
    this.major.geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(lines.major, 3));
  }

  setTheme(theme: ViewTheme): void {
    (this.minor.material as LineBasicMaterial).color.set(theme.gridMinor);
    (this.major.material as LineBasicMaterial).color.set(theme.gridMajor);
  }
}
