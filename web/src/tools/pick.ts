// Picking and measuring with the pointer. Ids come from the picture, every number
// from the server, which has the model in double precision.
import type { Place, Vec3 } from "../core/protocol.ts";
import type { Store } from "../core/store.ts";
import { formatCount } from "../core/units.ts";
import type { Readout } from "../panels/dialogs.ts";
import type { Hit, Viewer } from "../view/viewer.ts";

/** A press that moves further than this many pixels is a drag. */
const CLICK_PIXELS = 4;

export class PickTool {
  private request = 0;
  private selected: { face: number; vertex?: number } | undefined;
  private outline: Vec3[] = [];
  private from: Place | undefined;
  measuring = false;
  onMeasuring: (measuring: boolean) => void = () => {};

  constructor(
    private readonly store: Store,
    private readonly viewer: Viewer,
    private readonly readout: Readout,
  ) {
    this.listen();
    store.on("picked", (picked) => {
      if (picked.request !== this.request || this.measuring) return;
      this.outline = picked.vertices ?? [];
      viewer.marks.setOutline(this.outline.map((point) => viewer.toScene(point)));
      viewer.invalidate();
      const name = picked.vertex !== undefined ? `Vertex ${formatCount(picked.vertex)}` : `Face ${formatCount(picked.face ?? 0)}`;
      this.readout.show(name, picked.lines);
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
      this.click(this.viewer.hit(event.clientX - box.left, event.clientY - box.top));
    });
  }

  private click(hit: Hit | undefined): void {
    if (this.measuring) {
      if (hit) this.measureAt(hit);
      return;
    }
    if (!hit) {
      this.clear();
      return;
    }
    // A second click on the face asks for the vertex that is nearest there.
    const again = this.selected?.face === hit.face;
    this.selected = again && this.selected?.vertex !== hit.vertex ? { face: hit.face, vertex: hit.vertex } : { face: hit.face };
    this.viewer.setPicked(hit.face);
    this.request += 1;
    const vertex = this.selected.vertex;
    this.store.send({ type: "pick", request: this.request, ...(vertex === undefined ? { face: hit.face } : { vertex }) });
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
    const had = this.selected !== undefined;
    this.clear();
    return had;
  }

  /** Face and vertex ids mean nothing on another mesh. */
  clear(): void {
    this.selected = undefined;
    this.outline = [];
    this.viewer.setPicked(undefined);
    this.viewer.marks.setOutline([]);
    this.viewer.marks.setLine([]);
    this.viewer.invalidate();
    this.readout.hide();
  }

  /** The picked face's corners, to fit the view to. */
  get points(): Vec3[] {
    return this.outline;
  }

  /** Asks again for the same ids after the model changed, as long as they exist. */
  refresh(faces: number): void {
    if (!this.selected || this.measuring) return;
    if (this.selected.face >= faces) {
      this.clear();
      return;
    }
    this.request += 1;
    const { face, vertex } = this.selected;
    this.store.send({ type: "pick", request: this.request, ...(vertex === undefined ? { face } : { vertex }) });
  }
}
