// The middle of the page: the picture and what lies over it.
import { button, element, setHidden, setText } from "./core/dom.ts";
import type { Action } from "./core/keys.ts";
import type { Shown, Status } from "./core/protocol.ts";
import { lengthUnit, type Store } from "./core/store.ts";
import { formatTime } from "./core/units.ts";
import { Readout } from "./panels/dialogs.ts";
import type { BufferSource } from "./view/buffers.ts";
import { Gizmo } from "./view/gizmo.ts";
import { ScaleBar } from "./view/scale.ts";
import { Still } from "./view/still.ts";
import { Viewer } from "./view/viewer.ts";

export class Stage {
  readonly root = element("main", { class: "stage" });
  readonly readout = new Readout();
  /** Missing where the browser gives no WebGL2: the page works without a picture. */
  readonly viewer: Viewer | undefined;
  /** There instead. */
  readonly still: Still | undefined;
  private readonly empty = element("p", { class: "empty", hidden: true });
  private readonly scaleBar = new ScaleBar();
  private readonly gizmo: Gizmo;
  private readonly offScreen: HTMLButtonElement;

  constructor(
    private readonly store: Store,
    act: (action: Action) => void,
    source: BufferSource,
  ) {
    this.gizmo = new Gizmo(act);
    this.offScreen = button("The model is off screen: F fits it", "Fit the whole model (F)", () => act("fit"), { class: "off-screen" });
    this.offScreen.hidden = true;
    const smooth = (): boolean => !window.matchMedia("(prefers-reduced-motion: reduce)").matches;
    try {
      this.viewer = new Viewer(this.root, source, smooth);
      this.viewer.onFrame = () => this.follow();
    } catch (error) {
      // The page says so where a picture is missing; the server draws meanwhile.
      console.info(String(error));
      this.still = new Still(store, source, this.root);
      this.root.append(this.still.root, element("p", { class: "no-webgl" }, "This browser gives no WebGL2: tessgraph draws the picture. 1, 3 and 7 turn it; parameters work as ever."));
    }
    this.root.append(this.gizmo.root, this.scaleBar.root, this.empty, this.offScreen, this.readout.root);
    this.say("Connecting to tessgraph…");
    store.on("status", (status) => this.progress(status));
  }

  /** A sentence in the middle, or none. */
  say(text: string | undefined): void {
    setHidden(this.empty, text === undefined);
    setText(this.empty, text ?? "");
  }

  private progress(status: Status): void {
    this.root.classList.toggle("stale", status.state === "stale" || status.state === "waiting");
    this.root.classList.toggle("busy", status.state === "computing");
    if (this.store.get("shown")) return;
    if (status.state === "computing") this.say(`Computing ${status.done ?? 0} of ${status.total ?? "?"}${status.node ? `: ${status.node}` : ""}${status.ms ? ` (${formatTime(status.ms)})` : ""}`);
    if (status.state === "stale") this.say("Nothing to show yet: the messages below say why.");
    if (status.state === "waiting") this.say(`Waiting for ${status.waiting_for ?? "a file"}.`);
  }

  /** What the middle says about a result. */
  describe(shown: Shown): void {
    if (shown.empty) this.say(shown.empty);
    else if (!shown.mesh && !this.viewer?.hasModel && !this.still) this.say(`${shown.node} is no mesh; it stands in the table below.`);
    else this.say(undefined);
  }

  /** Called before each frame, for what else follows the camera. */
  onFollow: () => void = () => {};

  /** Overlays follow the camera. */
  private follow(): void {
    const { viewer } = this;
    if (!viewer) return;
    this.onFollow();
    this.gizmo.update(viewer.camera.camera);
    const scale = this.store.get("shown")?.mesh?.scale ?? 1;
    this.scaleBar.update(viewer.camera.metresPerPixel(this.root.clientWidth), scale, lengthUnit(this.store.get("document")));
    setHidden(this.offScreen, !viewer.isOffScreen());
  }
}
