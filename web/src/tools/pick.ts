// Picking and measuring with the pointer. Ids come from the picture, every number
// from the server, which has the model in double precision.
import type { Selection } from "../core/link.ts";
import type { Place, Vec3 } from "../core/protocol.ts";
import { element } from "../core/dom.ts";
import type { Store } from "../core/store.ts";
import { formatCount } from "../core/units.ts";
import type { Readout } from "../panels/dialogs.ts";
import { nextPick, type Picked } from "./picking.ts";
import { Panels, type PanelsState } from "./panels.ts";
import type { Hit, Viewer } from "../view/viewer.ts";

/** A press that moves further than this many pixels is a drag. */
const CLICK_PIXELS = 4;

export class PickTool {
  readonly panels = new Panels();
  private request = 0;
  private picked: Picked | undefined;
  private outline: Vec3[] = [];
  /** Places of what was selected before the last pick. */
  private places: Vec3[] = [];
  /** Drawn while a rectangle is. */
  readonly rectangle = element("div", { class: "rectangle", hidden: true });
  /** Whether the next drag draws a rectangle. */
  private boxing = false;
  onBoxing: (boxing: boolean) => void = () => {};
  /** Whether the view is to be fitted to what is picked next. */
  private fitting = false;
  private from: Place | undefined;
  measuring = false;
  /** The place of a section's cut that a click means, if it means one. */
  onCut: (x: number, y: number, hit: Hit | undefined) => Place | undefined = () => undefined;
  onMeasuring: (measuring: boolean) => void = () => {};
  /** Called when panels were hidden, isolated or shown. */
  onPanels: () => void = () => {};

  constructor(
    private readonly store: Store,
    private readonly viewer: Viewer,
    private readonly readout: Readout,
  ) {
    this.listen();
    store.on("picked", (picked) => {
      if (picked.request !== this.request || this.measuring || !this.picked) return;
      const { level, panel } = this.picked;
      this.outline = picked.vertices ?? [];
      if (this.fitting) viewer.fit(around(this.outline));
      this.fitting = false;
      viewer.marks.setOutline(level === "panel" ? [] : this.outline.map((point) => viewer.toScene(point)));
      viewer.invalidate();
      const names = { panel: `Panel ${formatCount(panel)}`, face: `Face ${formatCount(picked.face ?? 0)}`, vertex: `Vertex ${formatCount(picked.vertex ?? 0)}` };
      this.readout.show(names[level], picked.lines);
    });
    store.on("measured", (measured) => {
      if (measured.request !== this.request) return;
      viewer.marks.setLine([measured.from, measured.to].map((point) => viewer.toScene(point)));
      viewer.invalidate();
      const [x, y, z] = measured.delta;
      this.readout.show("Distance", [["", measured.distance], ["dx", x], ["dy", y], ["dz", z]]);
    });
  }

  private listen(): void {
    const { canvas } = this.viewer;
    canvas.parentElement?.addEventListener("pointerdown", (event) => this.beginRectangle(event), { capture: true });
    let pressed: { x: number; y: number } | undefined;
    canvas.addEventListener("pointerdown", (event) => {
      pressed = event.button === 0 && event.isPrimary ? { x: event.clientX, y: event.clientY } : undefined;
    });
    canvas.addEventListener("pointerup", (event) => {
      if (!pressed || Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) > CLICK_PIXELS) return;
      const box = canvas.getBoundingClientRect();
      const [x, y] = [event.clientX - box.left, event.clientY - box.top];
      const hit = this.viewer.hit(x, y);
      if (this.measuring) this.measureAt(this.onCut(x, y, hit) ?? (hit && { vertex: hit.vertex }));
      else this.click(hit, event.shiftKey);
    });
  }

  private click(hit: Hit | undefined, adding: boolean): void {
    if (!hit) {
      this.clear();
      return;
    }
    const hasPanels = this.store.get("shown")?.mesh?.base_faces !== undefined;
    this.picked = nextPick(adding ? undefined : this.picked, hit, hasPanels);
    this.places = adding ? [...this.places, ...this.outline] : [];
    this.panels.select(hit.panel, adding);
    this.viewer.setPicked(this.picked.level === "panel" ? undefined : hit.face);
    this.drawPanels();
    this.ask();
  }

  /** The next drag draws a rectangle, or not. */
  toggleRectangle(): void {
    this.boxing = !this.boxing;
    this.viewer.canvas.classList.toggle("boxing", this.boxing);
    this.onBoxing(this.boxing);
  }

  /** With Alt, or after the key, a drag selects what a rectangle shows. */
  private beginRectangle(event: PointerEvent): void {
    const { canvas } = this.viewer;
    if (event.target !== canvas || event.button !== 0 || !(this.boxing || event.altKey) || this.measuring) return;
    // The camera is not to hear of it.
    event.stopPropagation();
    event.preventDefault();
    canvas.focus();
    canvas.setPointerCapture(event.pointerId);
    const box = canvas.getBoundingClientRect();
    const sides = ({ clientX, clientY }: PointerEvent): [number, number, number, number] => {
      const [left, top] = [Math.max(box.left, Math.min(event.clientX, clientX)), Math.max(box.top, Math.min(event.clientY, clientY))];
      const [right, bottom] = [Math.min(box.right, Math.max(event.clientX, clientX)), Math.min(box.bottom, Math.max(event.clientY, clientY))];
      return [left - box.left, top - box.top, right - left, bottom - top];
    };
    const draw = (moved: PointerEvent): void => {
      const [x, y, width, height] = sides(moved);
      Object.assign(this.rectangle.style, { left: `${x}px`, top: `${y}px`, width: `${width}px`, height: `${height}px` });
      this.rectangle.hidden = false;
    };
    const end = (ended: PointerEvent): void => {
      canvas.removeEventListener("pointermove", draw);
      this.rectangle.hidden = true;
      if (this.boxing) this.toggleRectangle();
      if (ended.type === "pointerup") this.selectIn(sides(ended), ended.shiftKey);
    };
    canvas.addEventListener("pointermove", draw);
    canvas.addEventListener("pointerup", end, { once: true });
  }

  private selectIn([x, y, width, height]: [number, number, number, number], adding: boolean): void {
    const { panels, places } = this.viewer.panelsIn(x, y, width, height);
    const before = adding ? [...this.places, ...this.outline] : [];
    if (!adding) this.clear();
    this.panels.selectAll(panels, adding);
    this.places = [...before, ...places];
    this.outline = [];
    this.drawPanels();
    this.tellCount();
  }

  private tellCount(): void {
    const count = this.panels.selected.size;
    if (count > 0) this.readout.show(count === 1 ? "1 panel" : `${formatCount(count)} panels`, [["", "H hides them, I leaves only them, Z fits them"]]);
  }

  /** Picks a face as a click does, and turns the view to it. */
  goTo(face: number, panel: number): void {
    this.clear();
    this.picked = { face, panel, vertex: 0, level: "face" };
    this.fitting = true;
    this.panels.select(panel, false);
    this.viewer.setPicked(face);
    this.drawPanels();
    this.ask();
  }

  /** Asks the server about what is picked. */
  private ask(): void {
    if (!this.picked) return;
    this.request += 1;
    const { face, vertex, level } = this.picked;
    this.store.send({ type: "pick", request: this.request, ...(level === "vertex" ? { vertex } : { face }) });
  }

  private drawPanels(): void {
    this.viewer.setPanels(this.panels.states(), this.panels.isIsolating);
  }

  hide(): void {
    if (this.panels.hide() > 0) this.clear();
    this.changePanels();
  }

  isolate(): void {
    this.panels.isolate();
    this.changePanels();
  }

  showAll(): void {
    this.panels.showAll();
    this.changePanels();
  }

  private changePanels(): void {
    this.drawPanels();
    this.onPanels();
  }

  /** Brings back what was hidden on an earlier page, and what was picked. */
  restorePanels(state: PanelsState | undefined, selection?: Selection): void {
    this.panels.restore(state);
    for (const panel of selection?.panels ?? []) this.panels.selected.add(panel);
    this.picked = selection?.picked;
    this.viewer.setPicked(this.picked && this.picked.level !== "panel" ? this.picked.face : undefined);
    this.drawPanels();
  }

  /** What is picked, for a link. */
  get selection(): Selection {
    return { panels: [...this.panels.selected], picked: this.picked };
  }

  private measureAt(place: Place | undefined): void {
    if (!place) return;
    if (!this.from) {
      this.from = place;
      this.readout.show("Measure", [["from", place.vertex === undefined ? "a place on the cut" : `vertex ${formatCount(place.vertex)}`], ["to", "click the second point"]]);
      return;
    }
    this.request += 1;
    this.store.send({ type: "measure", request: this.request, from: this.from, to: place });
    this.from = undefined;
  }

  toggleMeasure(): void {
    this.clear();
    this.measuring = !this.measuring;
    this.from = undefined;
    this.onMeasuring(this.measuring);
    if (this.measuring) this.readout.show("Measure", [["from", "click the first point (it snaps to a vertex, or to a corner of the cut)"]]);
  }

  /** Leaves the tool or lets the pick go; says whether there was anything to leave. */
  cancel(): boolean {
    if (this.measuring) {
      this.toggleMeasure();
      return true;
    }
    if (this.boxing) {
      this.toggleRectangle();
      return true;
    }
    const had = this.picked !== undefined || this.panels.selected.size > 0;
    this.clear();
    return had;
  }

  /** Lets the pick go. */
  clear(): void {
    this.picked = undefined;
    this.outline = [];
    this.places = [];
    this.panels.selected.clear();
    this.viewer.setPicked(undefined);
    this.viewer.marks.setOutline([]);
    this.viewer.marks.setLine([]);
    this.drawPanels();
    this.readout.hide();
  }

  /** The picked face's corners. */
  get corners(): Vec3[] {
    return this.outline;
  }

  /** Places of all that is selected, to fit the view to. */
  get points(): Vec3[] {
    return [...this.places, ...this.outline];
  }

  /** Asks again for the same ids after the model changed, as long as they exist. */
  refresh(faces: number): void {
    if (!this.picked || this.measuring) return;
    if (this.picked.face >= faces) this.clear();
    else this.ask();
  }
}

/** A frame four times as large around some places, so that a single face is seen among its neighbours. */
function around(places: Vec3[]): Vec3[] {
  const middle = [0, 1, 2].map((k) => places.reduce((sum, p) => sum + p[k as 0] / places.length, 0));
  return places.map((p) => p.map((c, k) => (middle[k] ?? 0) + 4 * (c - (middle[k] ?? 0))) as Vec3);
}
