// The section's cut: asked of the server when the plane rests, drawn, told, and
// measured on.
import { element } from "../core/dom.ts";
import type { Place, Sectioned, Vec3 } from "../core/protocol.ts";
import { type CutLines, capFan, capOutline, dot, placeOnCut, reach, type Section } from "../core/section.ts";
import type { Store } from "../core/store.ts";
import type { BufferSource } from "../view/buffers.ts";
import type { Hit, Viewer } from "../view/viewer.ts";

/** A plane that rests this long is cut. */
const PAUSE_MS = 120;

/** A click this near to an outline means it. */
const NEAR_PIXELS = 12;

/** Steps of the arrow keys from one end of the model to the other. */
const STEPS = 200;

export class SectionTool {
  /** Drags the plane along its normal. */
  readonly handle = element("button", { type: "button", class: "section-handle", hidden: true, "aria-label": "Section plane: drag, or move it with the arrow keys", title: "Drag the section plane" }, "⇕");
  /** Whether a panel is drawn. */
  isVisible: (panel: number) => boolean = () => true;
  /** Moves the plane. */
  onMove: (at: number) => void = () => {};
  /** Told in words what is cut, or nothing yet. */
  onTold: (text: string | undefined, title?: string) => void = () => {};
  private section: Section | undefined;
  private cut: CutLines | undefined;
  private request = 0;
  private key = "";
  private timer: ReturnType<typeof setTimeout> | undefined;
  private dragging = false;

  constructor(
    private readonly store: Store,
    private readonly viewer: Viewer,
    private readonly source: BufferSource,
  ) {
    store.on("sectioned", (told) => void this.take(told));
    this.listenToHandle();
  }

  private get mesh(): { bounds: [Vec3, Vec3]; positions: string } | undefined {
    return this.store.get("shown")?.mesh;
  }

  /** Takes the plane and the model as they are now. */
  update(section: Section | undefined): void {
    const key = JSON.stringify([section?.normal, section?.at, this.mesh?.positions]);
    this.section = section;
    this.handle.hidden = !section || !this.mesh;
    if (key === this.key) return;
    this.key = key;
    this.forget();
    if (section && this.mesh) this.timer = setTimeout(() => this.ask(), PAUSE_MS);
  }

  private forget(): void {
    clearTimeout(this.timer);
    this.request += 1;
    this.cut = undefined;
    this.viewer.cap.hide();
    this.onTold(undefined);
  }

  private ask(): void {
    const { section } = this;
    if (!section) return;
    if (this.dragging) {
      // Off while dragging: the next rest asks again.
      this.timer = setTimeout(() => this.ask(), PAUSE_MS);
      return;
    }
    this.store.send({ type: "section", request: this.request, plane: { normal: section.normal, at: section.at } });
  }

  private async take(told: Sectioned): Promise<void> {
    if (told.request !== this.request) return;
    try {
      const [ends, panels] = await Promise.all([this.source(told.segments), this.source(told.panels)]);
      if (told.request !== this.request) return;
      this.cut = { origin: told.origin, ends: new Float32Array(ends), panels: new Uint32Array(panels), closedCount: told.closed_count };
    } catch {
      // The model has changed meanwhile; its cut is asked for anew.
      return;
    }
    this.draw();
    const open = told.open === 0 ? "" : ` · ${told.open} open, not filled`;
    const closed = told.closed === 0 ? "" : `, ${told.area.text}`;
    const text = told.count === 0 ? "cuts nothing" : `cut ${told.length.text}${closed}${open}`;
    const outlines = `${told.closed} closed and ${told.open} open outlines, ${told.length.exact} long, ${told.area.exact} within the closed ones.`;
    this.onTold(text, told.open > 0 ? `${outlines} An open outline ends at a border of the mesh: there is no inside to fill.` : outlines);
  }

  /** Draws the cut; again when panels are hidden or shown. */
  draw(): void {
    const { cut, section, viewer } = this;
    if (!cut || !section) return;
    const size = viewer.box().min.distanceTo(viewer.box().max);
    viewer.cap.show(capFan(cut, this.isVisible), capOutline(cut, this.isVisible), section.normal, viewer.toScene(cut.origin), size);
    viewer.invalidate();
  }

  /** The place of the cut that a click means, if it means one. */
  placeAt(x: number, y: number, hit: Hit | undefined): Place | undefined {
    const { cut, section, viewer } = this;
    if (!cut || !section) return undefined;
    const point = viewer.onPlane(x, y, section);
    if (!point || (hit && viewer.depthOf(hit.point) < viewer.depthOf(point) - 1e-4 * viewer.depthOf(point))) return undefined;
    const near = viewer.fromScene(point);
    const snap = NEAR_PIXELS * viewer.camera.metresPerPixel(viewer.canvas.clientWidth);
    const { winding, distance } = placeOnCut(cut, section.normal, near, this.isVisible);
    if (winding === 0 && distance > snap) return undefined;
    return { cut: { plane: { normal: section.normal, at: section.at }, near, snap } };
  }

  /** Puts the handle where the plane is, in the middle of the model. */
  follow(): void {
    if (this.handle.hidden || !this.section) return;
    const place = this.viewer.toScreen(this.middle(this.section.at));
    this.handle.style.transform = `translate(${Math.round(place.x)}px, ${Math.round(place.y)}px) translate(-50%, -50%)`;
  }

  private middle(at: number): Vec3 {
    const [low, high] = this.mesh?.bounds ?? [[0, 0, 0], [0, 0, 0]];
    const normal = this.section?.normal ?? [0, 0, 1];
    const centre = low.map((l, k) => (l + high[k as 0]) / 2) as Vec3;
    const step = at - dot(normal, centre);
    return centre.map((c, k) => c + step * normal[k as 0]) as Vec3;
  }

  private move(at: number): void {
    if (!this.section || !this.mesh) return;
    const [low, high] = reach(this.section.normal, this.mesh.bounds);
    this.onMove(Math.min(high, Math.max(low, at)));
  }

  private listenToHandle(): void {
    const { handle } = this;
    handle.addEventListener("pointerdown", (event) => {
      const { section, mesh } = this;
      if (!section || !mesh || event.button !== 0) return;
      event.preventDefault();
      handle.focus();
      handle.setPointerCapture(event.pointerId);
      this.dragging = true;
      const [low, high] = reach(section.normal, mesh.bounds);
      const step = (high - low) / 10 || 1;
      const [from, to] = [this.viewer.toScreen(this.middle(section.at)), this.viewer.toScreen(this.middle(section.at + step))];
      let [alongX, alongY] = [(to.x - from.x) / step, (to.y - from.y) / step];
      // Seen along its normal the plane goes nowhere on the screen: up is then away from it.
      if (Math.hypot(alongX, alongY) * step < 4) [alongX, alongY] = [0, -1 / this.viewer.camera.metresPerPixel(this.viewer.canvas.clientWidth)];
      const square = alongX ** 2 + alongY ** 2;
      const start = section.at;
      const move = (moved: PointerEvent): void => {
        const [dx, dy] = [moved.clientX - event.clientX, moved.clientY - event.clientY];
        this.move(start + (dx * alongX + dy * alongY) / square);
      };
      const end = (): void => {
        this.dragging = false;
        handle.removeEventListener("pointermove", move);
      };
      handle.addEventListener("pointermove", move);
      handle.addEventListener("lostpointercapture", end, { once: true });
    });
    handle.addEventListener("keydown", (event) => {
      const steps: Record<string, number> = { ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1 };
      const count = steps[event.key];
      if (count === undefined || !this.section || !this.mesh) return;
      event.preventDefault();
      const [low, high] = reach(this.section.normal, this.mesh.bounds);
      this.move(this.section.at + (count * (event.shiftKey ? 10 : 1) * (high - low)) / STEPS);
    });
  }
}
