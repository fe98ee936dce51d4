// The axes at the top right: they turn with the camera, and a click looks along one.
import { type Camera, Vector3 } from "three";
import { svg } from "../core/dom.ts";
import { type Action, tooltip } from "../core/keys.ts";

const AXES: { action: Action; label: string; direction: [number, number, number]; axis: "x" | "y" | "z" }[] = [
  { action: "right", label: "X", direction: [1, 0, 0], axis: "x" },
  { action: "left", label: "", direction: [-1, 0, 0], axis: "x" },
  { action: "back", label: "Y", direction: [0, 1, 0], axis: "y" },
  { action: "front", label: "", direction: [0, -1, 0], axis: "y" },
  { action: "top", label: "Z", direction: [0, 0, 1], axis: "z" },
  { action: "bottom", label: "", direction: [0, 0, -1], axis: "z" },
];

const REACH = 34;

export class Gizmo {
  readonly root: SVGSVGElement;
  private readonly parts: { line: SVGLineElement; ball: SVGGElement; direction: Vector3 }[] = [];
  private drawn = "";

  constructor(act: (action: Action) => void) {
    this.root = svg("svg", { viewBox: "-48 -48 96 96", class: "gizmo", role: "group", "aria-label": "Standard views" });
    for (const { action, label, direction, axis } of AXES) {
      const line = svg("line", { class: `axis ${axis}` });
      const ball = svg(
        "g",
        { class: `ball ${axis} ${label ? "positive" : "negative"}`, tabindex: 0, role: "button", "aria-label": tooltip(action) },
        svg("title", {}, tooltip(action)),
        svg("circle", { r: label ? 9 : 7 }),
        svg("text", { dy: "0.36em" }, label),
      );
      ball.addEventListener("click", () => act(action));
      ball.addEventListener("keydown", (event) => {
        if (event.key === "Enter" || event.key === " ") act(action);
      });
      this.parts.push({ line, ball, direction: new Vector3(...direction) });
      if (label) this.root.append(line);
    }
    for (const { ball } of this.parts) this.root.append(ball);
  }

  update(camera: Camera): void {
    const places = this.parts.map((part) => ({ part, seen: part.direction.clone().transformDirection(camera.matrixWorldInverse) }));
    const name = places.map(({ seen }) => `${seen.x.toFixed(3)} ${seen.y.toFixed(3)}`).join();
    if (name === this.drawn) return;
    this.drawn = name;
    for (const { part, seen } of places) {
      const [x, y] = [REACH * seen.x, -REACH * seen.y];
      part.line.setAttribute("x2", x.toFixed(2));
      part.line.setAttribute("y2", y.toFixed(2));
      part.ball.setAttribute("transform", `translate(${x.toFixed(2)} ${y.toFixed(2)})`);
      part.ball.classList.toggle("behind", seen.z < -0.05);
    }
    // Nearer ones are drawn later. A focused one stays where it is: moving it would lose the focus.
    const focused = document.activeElement;
    if (focused && this.root.contains(focused)) return;
    places.sort((a, b) => a.seen.z - b.seen.z);
    for (const { part } of places) this.root.append(part.ball);
  }
}
