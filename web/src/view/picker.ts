// What lies under pixels: ids of faces, panels and vertices, drawn where nobody sees.
import { type Camera, NearestFilter, type OrthographicCamera, type PerspectiveCamera, RGBAIntegerFormat, Scene, UnsignedIntType, Vector3, WebGLRenderTarget, type Object3D, type WebGLRenderer } from "three";

/** Numbers of each pixel: face + 1 or 0, panel, vertex, bits of the depth. */
export const NUMBERS = 4;

export class Picker {
  private readonly scene = new Scene();
  private readonly target = new WebGLRenderTarget(1, 1, {
    format: RGBAIntegerFormat,
    type: UnsignedIntType,
    internalFormat: "RGBA32UI",
    minFilter: NearestFilter,
    magFilter: NearestFilter,
  });

  constructor(
    private readonly renderer: WebGLRenderer,
    drawn: Object3D,
  ) {
    this.scene.add(drawn);
  }

  /** The numbers of each pixel of a part of the picture, in CSS pixels. */
  ids(camera: PerspectiveCamera | OrthographicCamera, x: number, y: number, columns: number, rows: number): Uint32Array {
    const { width, height } = this.size();
    camera.setViewOffset(width, height, x, y, columns, rows);
    this.target.setSize(columns, rows);
    this.renderer.setRenderTarget(this.target);
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    // An integer target is cleared by its own call.
    gl.clearBufferuiv(gl.COLOR, 0, new Uint32Array(NUMBERS));
    this.renderer.state.buffers.depth.setMask(true);
    gl.clearBufferfv(gl.DEPTH, 0, new Float32Array([1]));
    this.renderer.autoClear = false;
    this.renderer.render(this.scene, camera);
    this.renderer.autoClear = true;
    const ids = new Uint32Array(NUMBERS * columns * rows);
    gl.readPixels(0, 0, columns, rows, gl.RGBA_INTEGER, gl.UNSIGNED_INT, ids);
    this.renderer.setRenderTarget(null);
    camera.clearViewOffset();
    return ids;
  }

  /** The place of the scene at a point of the canvas, from the bits of its depth. */
  place(camera: Camera, x: number, y: number, bits: number): Vector3 {
    const { width, height } = this.size();
    const depth = new Float32Array(new Uint32Array([bits]).buffer)[0] as number;
    return new Vector3((2 * x) / width - 1, 1 - (2 * y) / height, 2 * depth - 1).unproject(camera);
  }

  private size(): DOMRect {
    return this.renderer.domElement.getBoundingClientRect();
  }
}
