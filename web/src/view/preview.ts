// What is drawn from parts until its result has been evaluated: heights times a factor.
import type { Texture, WebGLRenderer } from "three";
import type { Instances } from "../core/protocol.ts";
import type { Buffers, Format } from "./buffers.ts";
import { InstancedPositions, instanceBuffers } from "./instances.ts";

export class PreviewedPositions {
  /** Buffers of the parts; kept, for much of them stays from one result to the next. */
  parts: { digest: string; format: Format }[] = [];
  private instanced: InstancedPositions | undefined;
  /** The factor on heights that is wanted, and the one that positions were computed with. */
  private wanted: number | undefined;
  private computed: number | undefined;

  constructor(
    private readonly renderer: WebGLRenderer,
    private readonly buffers: Buffers,
  ) {}

  /**
   * Makes the parts ready; `vertices` says how many there are, and nothing when what is
   * shown is another result by then. Throws where the graphics card cannot.
   */
  async prepare(instances: Instances, vertices: () => number | undefined): Promise<boolean> {
    this.drop();
    // Older parts go when the next result is shown: until then it may need some of them.
    this.parts = instanceBuffers(instances);
    const { parts } = this;
    await this.buffers.load(parts, () => {});
    const count = vertices();
    if (parts !== this.parts || count === undefined) return false;
    this.instanced = new InstancedPositions(this.renderer, instances, this.buffers, count);
    return true;
  }

  /** Wants all heights multiplied by `factor`; says whether there are parts. */
  ask(factor: number): boolean {
    if (!this.instanced) return false;
    this.wanted = factor;
    return true;
  }

  /** Positions that are another than before, computed now, once for each frame that needs them. */
  next(): Texture | undefined {
    const { instanced, wanted } = this;
    if (!instanced || wanted === undefined || wanted === this.computed) return undefined;
    this.computed = wanted;
    return instanced.at(wanted);
  }

  /** Whether what is drawn is made of parts. */
  get isShown(): boolean {
    return this.wanted !== undefined;
  }

  /** How far beyond what was evaluated it may reach. */
  get reach(): number {
    return Math.abs(this.wanted ?? 0) * (this.instanced?.reach ?? 0);
  }

  /** A result is shown instead; the buffers of the parts stay. */
  end(): void {
    this.wanted = undefined;
    this.computed = undefined;
    this.instanced?.dispose();
    this.instanced = undefined;
  }

  /** Lets the parts go, too. */
  drop(): void {
    this.end();
    this.parts = [];
  }
}
