// The picture where the browser gives no WebGL2: drawn by the server, anew whenever
// the model changes.
import { element } from "../core/dom.ts";
import type { Rendered, Shown, Vec3 } from "../core/protocol.ts";
import type { Store } from "../core/store.ts";
import type { BufferSource } from "./buffers.ts";
import type { StandardView } from "./camera.ts";

/** From the model towards the eye. */
const TOWARDS: Record<StandardView, Vec3> = {
  front: [0, -1, 0],
  back: [0, 1, 0],
  right: [1, 0, 0],
  left: [-1, 0, 0],
  top: [0, 0, 1],
  bottom: [0, 0, -1],
  corner: [1, -1, 1],
};

/** Sides of a picture that the server draws. */
const [LEAST, MOST] = [64, 2400];

export class Still {
  readonly root = element("img", { class: "still", alt: "The model, as tessgraph draws it", hidden: true });
  private towards = TOWARDS.corner;
  private request = 0;
  private url: string | undefined;

  constructor(
    private readonly store: Store,
    private readonly source: BufferSource,
    private readonly host: HTMLElement,
  ) {
    store.on("shown", (shown) => this.ask(shown));
    store.on("rendered", (rendered) => void this.take(rendered));
    new ResizeObserver(() => this.ask(store.get("shown"))).observe(host);
  }

  look(view: StandardView): void {
    this.towards = TOWARDS[view];
    this.ask(this.store.get("shown"));
  }

  private ask(shown: Shown | undefined): void {
    const { clientWidth, clientHeight } = this.host;
    if (!shown?.mesh || clientWidth === 0 || clientHeight === 0) return;
    const side = (pixels: number): number => Math.round(Math.min(MOST, Math.max(LEAST, pixels)));
    this.request += 1;
    this.store.send({ type: "render", request: this.request, size: [side(clientWidth), side(clientHeight)], towards: this.towards });
  }

  private async take({ request, picture }: Rendered): Promise<void> {
    if (request !== this.request) return;
    const bytes = await this.source(picture);
    if (request !== this.request) return;
    const url = URL.createObjectURL(new Blob([bytes], { type: "image/png" }));
    this.root.src = url;
    this.root.hidden = false;
    if (this.url) URL.revokeObjectURL(this.url);
    this.url = url;
  }
}
