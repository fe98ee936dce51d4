// Picking and measuring with the pointer. Ids come from the picture, every number
// from the server, which has the model in double precision.
import type { Selection } from "../core/link.ts";
import type { Place, Vec3 } from "../core/protocol.ts";
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
  private from: Place | undefined;
  measuring = false;
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
    let pressed: { x: number; y: number } | undefined;
    canvas.addEventListener("pointerdown", (event) => {
      pressed = event.button === 0 && event.isPrimary ? { x: event.clientX, y: event.clientY } : undefined;
    });
    canvas.addEventListener("pointerup", (event) => {
      if (!pressed || Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) > CLICK_PIXELS) return;
      const box = canvas.getBoundingClientRect();
      this.click(this.viewer.hit(event.clientX - box.left, event.clientY - box.top), event.shiftKey);
    });
  }

  private click(hit: Hit | undefined, adding: boolean): void {
    if (this.measuring) {
      if (hit) this.measureAt(hit);
      return;
    }
    if (!hit) {
      this.clear();
      return;
    }
    const hasPanels = this.store.get("shown")?.mesh?.base_faces !== undefined;
    this.picked = nextPick(adding ? undefined : this.picked, hit, hasPanels);
    this.panels.select(hit.panel, adding);
    this.viewer.setPicked(this.picked.level === "panel" ? undefined : hit.face);
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

  private measureAt(hit: Hit): void {
    const place: Place = { vertex: hit.vertex };
    if (!this.from) {
      this.from = place;
      this.readout.show("Measure", [["from", `vertex ${formatCount(hit.vertex)}`], ["to", "click the second point"]]);
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
    if (this.measuring) this.readout.show("Measure", [["from", "click the first point (it snaps to a vertex)"]]);
  }

  /** Leaves the tool or lets the pick go; says whether there was anything to leave. */
  cancel(): boolean {
    if (this.measuring) {
      this.toggleMeasure();
      return true;
    }
    const had = this.picked !== undefined;
    this.clear();
    return had;
  }

  /** Lets the pick go. */
  clear(): void {
    this.picked = undefined;
    this.outline = [];
    this.panels.selected.clear();
    this.viewer.setPicked(undefined);
    this.viewer.marks.setOutline([]);
    this.viewer.marks.setLine([]);
    this.drawPanels();
    this.readout.hide();
  }

  /** The picked face's corners, to fit the view to. */
  get points(): Vec3[] {
    return this.outline;
  }

  /** Asks again for the same ids after the model changed, as long as they exist. */
  refresh(faces: number): void {
    if (!this.picked || this.measuring) return;
    if (this.picked.face >= faces) this.clear();
    else this.ask();
  }
}
