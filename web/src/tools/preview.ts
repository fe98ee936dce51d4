// While a slider moves the picture follows at once, from the parts of the array, and
// the evaluated result takes its place when it is there.
import { factorAt } from "../core/instances.ts";
import type { Previewed } from "../core/protocol.ts";
import type { Store } from "../core/store.ts";
import type { Preview } from "../panels/chip.ts";
import type { Viewer } from "../view/viewer.ts";

/** After a run the result follows its status at once, if there is a new one. */
const RESULT_PAUSE_MS = 150;

/** And after a value was sent a run begins, if it is another one. */
const RUN_PAUSE_MS = 2000;

type Aim = { name: string; version: number; request: number; answer?: Previewed; ready: boolean };

export class PreviewTool {
  onState: (state: Preview) => void = () => {};
  /** Shows the result that the server told last. */
  showResult: () => void = () => {};
  private aim: Aim | undefined;
  private request = 0;
  /** The slider that is held, and the value it stands at. */
  private held: string | undefined;
  private value: number | undefined;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly store: Store,
    private readonly viewer: Viewer,
    sliders: HTMLElement,
  ) {
    const on = (type: string, act: (name: string, slider: HTMLInputElement) => void): void => {
      sliders.addEventListener(type, ({ target }) => {
        if (!(target instanceof HTMLInputElement) || target.type !== "range") return;
        const name = target.closest<HTMLElement>(".parameter")?.dataset["name"];
        if (name !== undefined) act(name, target);
      });
    };
    // As soon as a hand comes near: then all is there when it moves.
    for (const type of ["pointerover", "pointerdown", "focusin"]) on(type, (name, slider) => this.ask(name, slider));
    on("pointerdown", (name) => this.hold(name));
    on("input", (name, slider) => this.move(name, slider));
    // Of a slider that has come back to its value nothing else is told.
    for (const type of ["pointerup", "pointercancel"]) document.addEventListener(type, () => this.release(RESULT_PAUSE_MS));
    on("change", () => this.release(RUN_PAUSE_MS));
    store.on("previewed", (answer) => void this.take(answer));
    store.on("status", ({ state }) => {
      clearTimeout(this.timer);
      if (state !== "computing") this.timer = setTimeout(() => this.settle(), RESULT_PAUSE_MS);
    });
  }

  /** Whether a new result waits, because a hand is still at the slider. */
  keeps(): boolean {
    return this.viewer.isPreview && this.held !== undefined;
  }

  /** A result is shown; its parts are asked for when they are needed. */
  end(): void {
    this.aim = undefined;
    this.onState(undefined);
  }

  private ask(name: string, slider: HTMLInputElement): void {
    const version = this.store.get("shown")?.version;
    if (version === undefined || this.held !== undefined || this.viewer.isPreview) return;
    if (this.aim?.name === name && this.aim.version === version) return;
    if (this.store.get("document")?.parameters.find((p) => p.name === name)?.locked) return;
    this.request += 1;
    const { request } = this;
    this.aim = { name, version, request, ready: false };
    this.store.send({ type: "preview", request, name, from: Number(slider.min), to: Number(slider.max) });
  }

  private async take(answer: Previewed): Promise<void> {
    const { aim } = this;
    if (!aim || answer.request !== aim.request) return;
    if (answer.version !== aim.version || this.store.get("shown")?.version !== aim.version) {
      // Of another result than the one on the screen.
      this.aim = undefined;
      return;
    }
    aim.answer = answer;
    if (!answer.instances) return;
    try {
      aim.ready = await this.viewer.prepareInstances(answer.instances);
    } catch {
      // Then the picture follows when it has been evaluated.
      return;
    }
    if (aim === this.aim) this.follow();
  }

  private hold(name: string): void {
    this.held = name;
    this.value = undefined;
  }

  private move(name: string, slider: HTMLInputElement): void {
    this.held ??= name;
    this.value = slider.valueAsNumber;
    this.follow();
  }

  /** Draws what the slider says. */
  private follow(): void {
    const { aim, value } = this;
    if (!aim?.ready || !aim.answer || aim.name !== this.held || value === undefined) return;
    const follows = this.viewer.previewHeights(factorAt(aim.answer.factors, value));
    if (follows) this.onState(aim.answer.is_exact ? "exact" : "approximate");
  }

  private release(pause: number): void {
    this.held = undefined;
    this.value = undefined;
    // What was evaluated meanwhile may be all that comes.
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.settle(), pause);
  }

  /** The last run is over: its result, even if it is the one from before. */
  private settle(): void {
    if (!this.viewer.isPreview || this.held !== undefined || this.store.get("status")?.state === "computing") return;
    this.showResult();
  }
}
