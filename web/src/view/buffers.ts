// Buffers of the server as textures that shaders read by index. A buffer is named
// by its content, so that one already here is never fetched or uploaded again.
import { ExternalTexture, type WebGLRenderer } from "three";
import { bytesOf } from "../core/bytes.ts";
import type { Digest } from "../core/protocol.ts";

/** Texels of a row; shaders take it apart as `index & 4095, index >> 12`. */
export const ROW = 4096;

export type Format = "vec3" | "vec4" | "uvec3" | "uint" | "byte" | "float";

type Layout = { internal: number; format: number; type: number; bytes: number; view: "f32" | "u32" | "u8" };

type Held = { texture: ExternalTexture; handle: WebGLTexture; bytes: number };

/** What was spent on the last loading, in milliseconds, and how much travelled. */
export type LoadTimes = { fetch: number; upload: number; bytes: number; fetched: number };

/** Where the bytes of a buffer come from. */
export type BufferSource = (digest: Digest) => Promise<ArrayBuffer>;

/** Buffers as `tessgraph view` serves them below its address. */
export function fromServer(address: URL): BufferSource {
  return async (digest) => {
    // Past the browser's cache: a slider would fill it with models nobody sees again,
    // and from this machine a buffer comes as fast as from a disk.
    const response = await fetch(new URL(`buffer/${digest}`, address), { cache: "no-store" });
    if (!response.ok) throw new Error(`buffer ${digest} is not to be had: ${response.status} ${response.statusText}`);
    return bytesOf(response);
  };
}

export class Buffers {
  private held = new Map<string, Held>();
  /** A buffer on its way that nothing has named yet. */
  private early: { digest: Digest; content: Promise<ArrayBuffer> } | undefined;
  private gl: WebGL2RenderingContext;

  constructor(
    private readonly renderer: WebGLRenderer,
    private readonly read: BufferSource,
  ) {
    this.gl = renderer.getContext() as WebGL2RenderingContext;
  }

  /** Bytes of textures held now. */
  get bytes(): number {
    let sum = 0;
    for (const held of this.held.values()) sum += held.bytes;
    return sum;
  }

  /** Begins to fetch what will be named soon, unless it is here. */
  expect(digest: Digest, format: Format): void {
    if (this.early?.digest === digest || this.held.has(key(digest, format))) return;
    const content = this.read(digest);
    // Whoever loads it is told why it cannot be had.
    content.catch(() => {});
    this.early = { digest, content };
  }

  private fetch(digest: Digest): Promise<ArrayBuffer> {
    const { early } = this;
    if (early?.digest !== digest) return this.read(digest);
    this.early = undefined;
    return early.content;
  }

  /**
   * Makes the named buffers ready. `inspect` sees the bytes of those fetched now,
   * which are let go afterwards. Throws with a sentence when one cannot be had.
   */
  async load(
    wanted: { digest: Digest; format: Format }[],
    inspect: (digest: Digest, bytes: ArrayBuffer) => void,
  ): Promise<LoadTimes> {
    const missing = wanted.filter(({ digest, format }) => !this.held.has(key(digest, format)));
    const start = performance.now();
    const fetched = await Promise.all(missing.map(({ digest }) => this.fetch(digest)));
    const between = performance.now();
    let bytes = 0;
    missing.forEach(({ digest, format }, index) => {
      const content = fetched[index] as ArrayBuffer;
      bytes += content.byteLength;
      inspect(digest, content);
      const name = key(digest, format);
      if (!this.held.has(name)) this.held.set(name, this.upload(content, format));
    });
    if (missing.length > 0) this.renderer.resetState();
    return { fetch: between - start, upload: performance.now() - between, bytes, fetched: missing.length };
  }

  /** The texture of a buffer that was loaded. */
  texture(digest: Digest, format: Format): ExternalTexture {
    const held = this.held.get(key(digest, format));
    if (!held) throw new Error(`buffer ${digest} was not loaded`);
    return held.texture;
  }

  /** Frees every buffer but the named ones. */
  keep(wanted: { digest: Digest; format: Format }[]): void {
    const names = new Set(wanted.map(({ digest, format }) => key(digest, format)));
    for (const [name, held] of this.held) {
      if (names.has(name)) continue;
      this.gl.deleteTexture(held.handle);
      held.texture.dispose();
      this.held.delete(name);
    }
  }

  /** Forgets all textures after the context was lost: they are gone already. */
  forget(): void {
    this.held.clear();
    this.gl = this.renderer.getContext() as WebGL2RenderingContext;
  }

  private upload(content: ArrayBuffer, format: Format): Held {
    const { gl } = this;
    const layout = this.layout(format);
    const count = Math.floor(content.byteLength / layout.bytes);
    const rows = Math.max(1, Math.ceil(count / ROW));
    const limit = gl.getParameter(gl.MAX_TEXTURE_SIZE) as number;
    if (rows > limit) {
      throw new Error(`the model is too large for this graphics driver: ${count} elements, ${ROW * limit} fit`);
    }
    const handle = gl.createTexture();
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, handle);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, false);
    gl.pixelStorei(gl.UNPACK_ROW_LENGTH, 0);
    gl.texStorage2D(gl.TEXTURE_2D, 1, layout.internal, ROW, rows);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    // Whole rows straight from the buffer, then the rest: no padded copy is made.
    const full = Math.floor(count / ROW);
    const rest = count - full * ROW;
    const values = viewOf(content, layout.view);
    const perTexel = values.length / Math.max(count, 1);
    if (full > 0) {
      gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, ROW, full, layout.format, layout.type, values, 0);
    }
    if (rest > 0) {
      gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, full, rest, 1, layout.format, layout.type, values, Math.round(full * ROW * perTexel));
    }
    return { texture: new ExternalTexture(handle), handle, bytes: rows * ROW * layout.bytes };
  }

  private layout(format: Format): Layout {
    const { gl } = this;
    switch (format) {
      case "vec3":
        return { internal: gl.RGB32F, format: gl.RGB, type: gl.FLOAT, bytes: 12, view: "f32" };
      case "vec4":
        return { internal: gl.RGBA32F, format: gl.RGBA, type: gl.FLOAT, bytes: 16, view: "f32" };
      case "uvec3":
        return { internal: gl.RGB32UI, format: gl.RGB_INTEGER, type: gl.UNSIGNED_INT, bytes: 12, view: "u32" };
      case "uint":
        return { internal: gl.R32UI, format: gl.RED_INTEGER, type: gl.UNSIGNED_INT, bytes: 4, view: "u32" };
      case "byte":
        return { internal: gl.R8UI, format: gl.RED_INTEGER, type: gl.UNSIGNED_BYTE, bytes: 1, view: "u8" };
      case "float":
        return { internal: gl.R32F, format: gl.RED, type: gl.FLOAT, bytes: 4, view: "f32" };
    }
  }
}

function key(digest: Digest, format: Format): string {
  return `${format} ${digest}`;
}

function viewOf(content: ArrayBuffer, view: Layout["view"]): Float32Array | Uint32Array | Uint8Array {
  if (view === "f32") return new Float32Array(content);
  return view === "u32" ? new Uint32Array(content) : new Uint8Array(content);
}
