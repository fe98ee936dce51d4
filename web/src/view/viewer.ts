// The 3D picture: what is shown, drawn only when something changed.
import {
  Box3,
  Timer,
  Color,
  ColorManagement,
  LinearSRGBColorSpace,
  Frustum,
  Line3,
  Matrix4,
  Plane,
  Scene,
  Sphere,
  Vector3,
  WebGLRenderer,
} from "three";
import type { MapName } from "../core/colour.ts";
import type { ColourRange } from "../core/legend.ts";
import type { Instances, Shown, ShownField, Vec3 } from "../core/protocol.ts";
import { dot, type Section } from "../core/section.ts";
import { Buffers, type BufferSource, type LoadTimes } from "./buffers.ts";
import { type CameraState, ViewCamera } from "./camera.ts";
import { boxCorners, samplePoints } from "./fit.ts";
import { Cap } from "./cap.ts";
import { Ground } from "./ground.ts";
import { Marks } from "./marks.ts";
import { NUMBERS, Picker } from "./picker.ts";
import { PreviewedPositions } from "./preview.ts";
import { type EdgeMode, Surface, neededBuffers } from "./surface.ts";
import { type ThemeName, VIEW_THEMES } from "./theme.ts";

// Colours here are those of the screen from end to end; nothing converts them.
ColorManagement.enabled = false;

/** What lies under a pixel. */
export type Hit = { face: number; panel: number; vertex: number; point: Vector3 };

/** Places that stand for what a rectangle shows, beside one of each panel. */
const MOST_PLACES = 2000;

/** More triangles than this are drawn at one pixel per pixel while the camera moves. */
const HEAVY_TRIANGLES = 3_000_000;

export class Viewer {
  readonly camera: ViewCamera;
  readonly marks = new Marks();
  readonly cap = new Cap();
  /** Called before each frame: overlays follow the camera. */
  onFrame: () => void = () => {};
  /** Called with the bytes of each buffer fetched. */
  onBuffer: (digest: string, bytes: ArrayBuffer) => void = () => {};
  /** Called when a picture of something new was drawn. */
  onPicture: (times: LoadTimes) => void = () => {};
  onMoved: () => void = () => {};
  private readonly renderer: WebGLRenderer;
  private readonly buffers: Buffers;
  private readonly preview: PreviewedPositions;
  private readonly surface = new Surface();
  private readonly ground = new Ground();
  private readonly scene = new Scene();
  private readonly picker: Picker;
  private readonly timer = new Timer();
  private scheduled = false;
  private sequence = 0;
  private moving = false;
  private shown: Shown | undefined;
  private field: ShownField | undefined;
  /** Absolute metres of the scene's zero; fixed by the first model, so that the camera keeps its numbers small. */
  private origin: Vec3 | undefined;
  private edgeMode: EdgeMode = "polygons";
  private section: Section | undefined;
  private fitted = false;
  private samples: { digest: string; points: Vec3[] } | undefined;

  /** Throws where the browser gives no WebGL2. */
  constructor(
    private readonly host: HTMLElement,
    source: BufferSource,
    smooth: () => boolean,
  ) {
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true, stencil: true, powerPreference: "high-performance" });
    this.renderer.outputColorSpace = LinearSRGBColorSpace;
    const canvas = this.renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", "The model; press ? for keys");
    host.append(canvas);
    this.buffers = new Buffers(this.renderer, source);
    this.preview = new PreviewedPositions(this.renderer, this.buffers);
    this.camera = new ViewCamera(canvas, smooth);
    this.camera.pointUnder = (x, y) => this.hit(x, y)?.point;
    this.scene.add(this.ground.group, this.surface.group, this.cap.group, this.marks.group);
    this.picker = new Picker(this.renderer, this.surface.pickGroup);
    for (const event of ["control", "wake", "transitionstart"] as const) {
      this.camera.controls.addEventListener(event, () => this.invalidate());
    }
    this.camera.controls.addEventListener("rest", () => this.rest());
    canvas.addEventListener("webglcontextrestored", () => this.rebuild());
    new ResizeObserver(() => this.resize()).observe(host);
    this.resize();
  }

  get canvas(): HTMLCanvasElement {
    return this.renderer.domElement;
  }

  /** Whether a mesh was shown already. */
  get hasModel(): boolean {
    return this.shown?.mesh !== undefined;
  }

  /** Bytes of the model on the graphics card. */
  get bytes(): number {
    return this.buffers.bytes;
  }

  /** Begins to fetch the positions of a result that will be shown soon. */
  expect(positions: string): void {
    this.buffers.expect(positions, "vec3");
  }

  /**
   * Shows a result, coloured by one of its fields. The old picture stays until all
   * buffers are here; a newer call overtakes an older one, and then `false` comes
   * back. The camera stays, but for the very first picture.
   */
  async show(shown: Shown, field: ShownField | undefined): Promise<boolean> {
    this.sequence += 1;
    const { sequence } = this;
    const needed = neededBuffers(shown, field);
    const times = await this.buffers.load(needed, (digest, bytes) => {
      if (digest === shown.mesh?.positions) this.samples = { digest, points: samplePoints(new Float32Array(bytes)) };
      this.onBuffer(digest, bytes);
    });
    if (sequence !== this.sequence) return false;
    this.preview.end();
    if (this.shown?.node !== shown.node) this.preview.drop();
    this.buffers.keep([...needed, ...this.preview.parts]);
    this.shown = shown;
    this.field = field;
    this.surface.show(shown, field, this.buffers);
    if (shown.mesh) this.place(shown.mesh);
    this.updateCut();
    this.invalidate();
    this.onPicture(times);
    return true;
  }

  /**
   * Makes the parts of what is shown ready to be drawn in its place. Throws where the
   * graphics card cannot. A newer call, or a newer result, overtakes it.
   */
  prepareInstances(instances: Instances): Promise<boolean> {
    const { shown } = this;
    return this.preview.prepare(instances, () => (shown === this.shown ? shown?.mesh?.vertices : undefined));
  }

  /**
   * Draws the parts with all heights multiplied by `factor`, until a result is shown;
   * says whether there are parts.
   */
  previewHeights(factor: number): boolean {
    if (!this.preview.ask(factor)) return false;
    this.invalidate();
    return true;
  }

  /** Whether what is drawn is made of parts. */
  get isPreview(): boolean {
    return this.preview.isShown;
  }

  private place(mesh: NonNullable<Shown["mesh"]>): void {
    this.origin ??= [...mesh.origin];
    const { origin } = this;
    this.surface.place(mesh.origin[0] - origin[0], mesh.origin[1] - origin[1], mesh.origin[2] - origin[2]);
    this.ground.update(mesh.bounds, origin, mesh.scale);
    if (!this.fitted && mesh.triangles > 0) {
      this.fitted = true;
      void this.camera.controls.rotateTo(Math.PI / 5, Math.PI / 2.9, false);
      this.camera.fit(this.points(), false);
    }
  }

  /** After the graphics card forgot everything: fetched again, by the same names. */
  private rebuild(): void {
    this.buffers.forget();
    this.preview.drop();
    if (this.shown) void this.show(this.shown, this.field);
  }

  /** The model's box in scene coordinates. */
  box(): Box3 {
    const bounds = this.shown?.mesh?.bounds;
    if (!bounds) return new Box3();
    return new Box3(this.toScene(bounds[0]), this.toScene(bounds[1]));
  }

  /** Absolute metres to scene coordinates. */
  toScene(point: Vec3): Vector3 {
    const origin = this.origin ?? [0, 0, 0];
    return new Vector3(point[0] - origin[0], point[1] - origin[1], point[2] - origin[2]);
  }

  /** Scene coordinates to absolute metres. */
  fromScene(point: Vector3): Vec3 {
    const [x, y, z] = this.origin ?? [0, 0, 0];
    return [point.x + x, point.y + y, point.z + z];
  }

  /** Points that stand for the model: some of its vertices, or its box. */
  private points(): Vector3[] {
    const mesh = this.shown?.mesh;
    if (!mesh) return [];
    const corners = boxCorners(this.box());
    if (this.samples?.digest !== mesh.positions || this.samples.points.length === 0) return corners;
    const shift = this.toScene(mesh.origin);
    return this.samples.points.map(([x, y, z]) => new Vector3(x, y, z).add(shift));
  }

  /** Fits the view to some points in absolute metres, or to the model. */
  fit(points?: Vec3[]): void {
    this.camera.fit(points && points.length > 0 ? points.map((p) => this.toScene(p)) : this.points());
    this.invalidate();
  }

  /** Whether no part of the model's box is in the view. */
  isOffScreen(): boolean {
    const box = this.box();
    if (box.isEmpty()) return false;
    const { camera } = this.camera;
    camera.updateMatrixWorld();
    const matrix = new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    return !new Frustum().setFromProjectionMatrix(matrix).intersectsBox(box);
  }

  /** What lies under a point of the canvas, in CSS pixels. */
  hit(x: number, y: number): Hit | undefined {
    const [face = 0, panel = 0, vertex = 0, bits = 0] = this.ids(x, y, 1, 1);
    if (face === 0) return undefined;
    return { face: face - 1, panel, vertex, point: this.picker.place(this.camera.camera, x, y, bits) };
  }

  /** The panels seen within a rectangle of the canvas, and some of their places in absolute metres. */
  panelsIn(x: number, y: number, width: number, height: number): { panels: Set<number>; places: Vec3[] } {
    const [columns, rows] = [Math.max(1, Math.round(width)), Math.max(1, Math.round(height))];
    const ids = this.ids(x, y, columns, rows);
    const panels = new Set<number>();
    const places: Vec3[] = [];
    const every = Math.max(1, Math.floor((columns * rows) / MOST_PLACES));
    for (let i = 0; i < columns * rows; i += 1) {
      const panel = ids[NUMBERS * i + 1] as number;
      if (ids[NUMBERS * i] === 0) continue;
      const isNew = !panels.has(panel);
      panels.add(panel);
      if (!isNew && i % every !== 0) continue;
      // Rows of a picture begin at the bottom.
      const [column, row] = [i % columns, rows - 1 - Math.floor(i / columns)];
      const bits = ids[NUMBERS * i + 3] as number;
      places.push(this.fromScene(this.picker.place(this.camera.camera, x + column, y + row, bits)));
    }
    return { panels, places };
  }

  private ids(x: number, y: number, columns: number, rows: number): Uint32Array {
    this.camera.clip(this.sphere());
    return this.picker.ids(this.camera.camera, x, y, columns, rows);
  }

  setColours(map: MapName, range: ColourRange): void {
    this.surface.setColours(map, range);
    this.invalidate();
  }

  setTheme(name: ThemeName): void {
    const theme = VIEW_THEMES[name];
    this.scene.background = new Color(theme.background);
    this.surface.setTheme(theme);
    this.ground.setTheme(theme);
    this.cap.setTheme(theme);
    this.marks.setTheme(theme);
    this.invalidate();
  }

  setEdges(mode: EdgeMode): void {
    this.edgeMode = mode;
    this.surface.setEdges(mode, this.renderer.getPixelRatio());
    this.invalidate();
  }

  setGhost(ghost: boolean): void {
    this.surface.setGhost(ghost);
    this.invalidate();
  }

  setGrid(visible: boolean): void {
    this.ground.group.visible = visible;
    this.invalidate();
  }

  setDirections(visible: boolean): void {
    this.surface.showDirections(visible);
    this.invalidate();
  }

  setPicked(face: number | undefined): void {
    this.surface.setPicked(face);
    this.invalidate();
  }

  setPanels(states: Uint8Array, isolating: boolean): void {
    this.surface.setPanels(states, isolating);
    this.invalidate();
  }

  setSection(section: Section | undefined): void {
    this.section = section;
    this.updateCut();
    this.invalidate();
  }

  private updateCut(): void {
    const { section } = this;
    if (!section) {
      this.surface.setCut(undefined);
      return;
    }
    const side = section.flipped ? -1 : 1;
    const [x, y, z] = section.normal.map((n) => side * n) as Vec3;
    this.surface.setCut([x, y, z, -side * (section.at - dot(section.normal, this.origin ?? [0, 0, 0]))]);
  }

  /** Where the line of sight through a point of the canvas meets a plane, in the scene. */
  onPlane(x: number, y: number, section: Section): Vector3 | undefined {
    const { width, height } = this.canvas.getBoundingClientRect();
    const { camera } = this.camera;
    const far = (z: number): Vector3 => new Vector3((2 * x) / width - 1, 1 - (2 * y) / height, z).unproject(camera);
    const normal = new Vector3(...section.normal);
    const at = section.at - dot(section.normal, this.origin ?? [0, 0, 0]);
    return new Plane(normal, -at).intersectLine(new Line3(far(-1), far(1)), new Vector3()) ?? undefined;
  }

  /** How far a place of the scene lies before the camera. */
  depthOf(point: Vector3): number {
    return -point.clone().applyMatrix4(this.camera.camera.matrixWorldInverse).z;
  }

  /** Where a place in absolute metres is on the canvas, in CSS pixels. */
  toScreen(point: Vec3): { x: number; y: number } {
    const place = this.toScene(point).project(this.camera.camera);
    const { clientWidth, clientHeight } = this.canvas;
    return { x: ((place.x + 1) / 2) * clientWidth, y: ((1 - place.y) / 2) * clientHeight };
  }

  cameraState(): CameraState | undefined {
    return this.origin ? this.camera.state(this.origin) : undefined;
  }

  /** Looks from where the camera was on an earlier page; then nothing is fitted. */
  restoreCamera(state: CameraState): void {
    this.origin ??= [...state.target];
    this.camera.restore(state, this.origin);
    this.fitted = true;
    this.invalidate();
  }

  /** Draws a frame soon. */
  invalidate(): void {
    if (this.scheduled) return;
    this.scheduled = true;
    requestAnimationFrame(() => this.frame());
  }

  private frame(): void {
    this.scheduled = false;
    if (this.camera.controls.update(Math.min(this.timer.update().getDelta(), 0.1))) {
      this.moving = true;
      this.invalidate();
    }
    this.setSharpness();
    this.draw();
    this.onFrame();
  }

  private rest(): void {
    this.moving = false;
    this.onMoved();
    this.invalidate();
  }

  private sphere(): Sphere {
    const box = this.box();
    if (box.isEmpty()) return new Sphere(new Vector3(), 1);
    const sphere = box.getBoundingSphere(new Sphere());
    sphere.radius = Math.max(sphere.radius, 1e-3);
    // A preview reaches beyond the box of what was evaluated.
    sphere.radius += this.preview.reach;
    return sphere;
  }

  private draw(): void {
    const positions = this.preview.next();
    if (positions) this.surface.usePositions(positions);
    this.camera.clip(this.sphere());
    this.renderer.render(this.scene, this.camera.camera);
  }

  /** Calls back when the graphics card has finished the frames given to it. */
  whenDrawn(done: () => void): void {
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    requestAnimationFrame(() => {
      const fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
      gl.flush();
      const look = (): void => {
        const finished = !fence || gl.isContextLost() || gl.getSyncParameter(fence, gl.SYNC_STATUS) === gl.SIGNALED;
        if (!finished) {
          setTimeout(look, 4);
          return;
        }
        if (fence) gl.deleteSync(fence);
        done();
      };
      look();
    });
  }

  private setSharpness(): void {
    const heavy = (this.shown?.mesh?.triangles ?? 0) > HEAVY_TRIANGLES;
    const wanted = heavy && this.moving ? 1 : Math.min(window.devicePixelRatio, 2);
    if (wanted === this.renderer.getPixelRatio()) return;
    this.renderer.setPixelRatio(wanted);
    this.cap.setPixelRatio(wanted);
    this.surface.setEdges(this.edgeMode, wanted);
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.host;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setSize(clientWidth, clientHeight);
    this.camera.resize(clientWidth, clientHeight);
    // At once: a resized canvas is empty until it is drawn again.
    this.draw();
    this.onFrame();
  }

  /** The picture as it is now, `times` as sharp, drawn on a canvas of its own; transparent it has neither background nor ground. */
  picture(times: number, transparent: boolean): HTMLCanvasElement {
    const before = this.renderer.getPixelRatio();
    const { background } = this.scene;
    const ground = this.ground.group.visible;
    if (transparent) {
      this.scene.background = null;
      this.ground.group.visible = false;
      this.renderer.setClearColor(0x000000, 0);
    }
    this.renderer.setPixelRatio(times);
    this.cap.setPixelRatio(times);
    this.surface.setEdges(this.edgeMode, times);
    this.draw();
    const copy = document.createElement("canvas");
    copy.width = this.canvas.width;
    copy.height = this.canvas.height;
    copy.getContext("2d")?.drawImage(this.canvas, 0, 0);
    this.scene.background = background;
    this.ground.group.visible = ground;
    this.renderer.setPixelRatio(before);
    this.cap.setPixelRatio(before);
    this.surface.setEdges(this.edgeMode, before);
    this.draw();
    return copy;
  }
}
