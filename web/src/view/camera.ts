// The camera: Z up, perspective or orthographic, moved by camera-controls in the
// manner people know from Rhino, Blender or a trackpad. It is never moved by an
// update of the model.
import CameraControls from "camera-controls";
import * as THREE from "three";
import type { Vec3 } from "../core/protocol.ts";
import { fitPoints } from "./fit.ts";

CameraControls.install({ THREE });

export type Profile = "rhino" | "blender" | "trackpad";
export const PROFILES: Profile[] = ["rhino", "blender", "trackpad"];
export const PROFILE_LABELS: Record<Profile, string> = {
  rhino: "Rhino: right drag orbits, Shift pans",
  blender: "Blender: middle drag orbits, Shift pans",
  trackpad: "Trackpad: two fingers orbit, Shift pans, pinch zooms",
};

export type StandardView = "front" | "back" | "right" | "left" | "top" | "bottom" | "corner";

/** Azimuth from the front counted towards +X, and polar angle from +Z. */
const VIEWS: Record<StandardView, [number, number]> = {
  front: [0, Math.PI / 2],
  back: [Math.PI, Math.PI / 2],
  right: [Math.PI / 2, Math.PI / 2],
  left: [-Math.PI / 2, Math.PI / 2],
  top: [0, 0],
  bottom: [0, Math.PI],
  corner: [Math.PI / 5, Math.PI / 2.9],
};

/**
 * Half the picture's width as a tangent. The width is what is fixed, not the
 * height: when the drawer opens, the model stays as large as it was.
 */
const TANGENT = Math.tan((26 * Math.PI) / 180);

/** How much larger the view is than what is fitted into it. */
const FIT_ROOM = 1.1;

/** What is kept of a camera between pages: absolute metres. */
export type CameraState = { position: Vec3; target: Vec3; offset: Vec3; zoom: number; orthographic: boolean };

export class ViewCamera {
  readonly controls: CameraControls;
  private readonly perspective = new THREE.PerspectiveCamera(50, 1, 0.01, 1000);
  private readonly orthographic = new THREE.OrthographicCamera(-1, 1, 1, -1, -1000, 1000);
  private aspect = 1;
  private bounds = new THREE.Sphere(new THREE.Vector3(), 1);
  private pinching = false;
  private pressedAt: { x: number; y: number } | undefined;
  profile: Profile = "rhino";
  /** Finds the scene point under the pointer, to orbit about it. */
  pointUnder: (x: number, y: number) => THREE.Vector3 | undefined = () => undefined;

  constructor(
    private readonly canvas: HTMLElement,
    private readonly smooth: () => boolean,
  ) {
    for (const camera of [this.perspective, this.orthographic]) camera.up.set(0, 0, 1);
    this.perspective.position.set(6, -8, 5);
    this.controls = new CameraControls(this.perspective, canvas);
    this.controls.updateCameraUp();
    this.controls.dollyToCursor = true;
    this.controls.smoothTime = 0.12;
    this.controls.draggingSmoothTime = 0.03;
    this.controls.minDistance = 1e-4;
    canvas.addEventListener("pointerdown", (event) => this.prepareDrag(event), { capture: true });
    window.addEventListener("pointermove", (event) => this.beginDrag(event), { capture: true });
    window.addEventListener("pointerup", () => {
      this.pressedAt = undefined;
    }, { capture: true });
    canvas.addEventListener("wheel", (event) => this.prepareWheel(event), { capture: true, passive: false });
  }

  get camera(): THREE.PerspectiveCamera | THREE.OrthographicCamera {
    return this.controls.camera as THREE.PerspectiveCamera | THREE.OrthographicCamera;
  }

  get isOrthographic(): boolean {
    return this.camera === this.orthographic;
  }

  resize(width: number, height: number): void {
    this.aspect = width / Math.max(height, 1);
    this.perspective.aspect = this.aspect;
    this.perspective.fov = (360 / Math.PI) * Math.atan(TANGENT / this.aspect);
    this.orthographic.top = 1 / this.aspect;
    this.orthographic.bottom = -1 / this.aspect;
    this.camera.updateProjectionMatrix();
  }

  /** Keeps near and far planes about the model, so that depth has digits where it needs them. */
  clip(bounds: THREE.Sphere): void {
    this.bounds.copy(bounds);
    const distance = this.camera.position.distanceTo(bounds.center);
    const reach = 3 * bounds.radius;
    if (this.isOrthographic) {
      this.orthographic.near = -distance - reach;
      this.orthographic.far = distance + reach;
    } else {
      this.perspective.near = Math.max(distance - reach, bounds.radius / 2000, 1e-5);
      this.perspective.far = distance + reach;
    }
    this.camera.updateProjectionMatrix();
  }

  /** Moves along the present direction until the points fill the view. */
  fit(points: THREE.Vector3[], animate = true): void {
    if (points.length === 0) return;
    this.controls.update(0);
    this.camera.updateMatrixWorld();
    const axis = (k: number): THREE.Vector3 => new THREE.Vector3().setFromMatrixColumn(this.camera.matrixWorld, k).normalize();
    const tangentX = TANGENT / FIT_ROOM;
    const lens = { right: axis(0), up: axis(1), back: axis(2), tangentX, tangentY: tangentX / this.aspect };
    const fit = fitPoints(points, lens);
    const { distance, extent } = fit;
    const target = this.isOrthographic ? fit.middle : fit.target;
    const transition = animate && this.smooth();
    // A single point has no size: come no nearer than a part of the model.
    const least = 0.02 * this.bounds.radius;
    void this.controls.setFocalOffset(0, 0, 0, transition);
    void this.controls.moveTo(target.x, target.y, target.z, transition);
    void this.controls.dollyTo(Math.max(distance, least), transition);
    void this.controls.zoomTo(this.isOrthographic ? 1 / (FIT_ROOM * Math.max(extent, least)) : 1, transition);
  }

  look(view: StandardView): void {
    const [azimuth, polar] = VIEWS[view];
    this.controls.normalizeRotations();
    void this.controls.rotateTo(azimuth, polar, this.smooth());
  }

  /** Changes the projection and keeps the size of what is at the target. */
  toggleProjection(): void {
    if (this.isOrthographic) {
      const distance = 1 / this.orthographic.zoom / TANGENT;
      this.controls.camera = this.perspective;
      void this.controls.zoomTo(1, false);
      void this.controls.dollyTo(distance, false);
    } else {
      const halfWidth = this.controls.distance * TANGENT;
      this.controls.camera = this.orthographic;
      void this.controls.zoomTo(1 / halfWidth, false);
    }
    this.controls.update(0);
    this.clip(this.bounds);
  }

  /** Metres of one CSS pixel: at the middle of the model, or everywhere if parallel. */
  metresPerPixel(width: number): number {
    if (this.isOrthographic) return 2 / this.orthographic.zoom / width;
    const distance = this.camera.position.distanceTo(this.bounds.center);
    return (2 * distance * TANGENT) / width;
  }

  state(origin: Vec3): CameraState {
    const read = (vector: THREE.Vector3, shift: Vec3): Vec3 => [vector.x + shift[0], vector.y + shift[1], vector.z + shift[2]];
    return {
      position: read(this.controls.getPosition(new THREE.Vector3()), origin),
      target: read(this.controls.getTarget(new THREE.Vector3()), origin),
      offset: read(this.controls.getFocalOffset(new THREE.Vector3()), [0, 0, 0]),
      zoom: this.camera.zoom,
      orthographic: this.isOrthographic,
    };
  }

  restore(state: CameraState, origin: Vec3): void {
    this.controls.camera = state.orthographic ? this.orthographic : this.perspective;
    const at = (point: Vec3): Vec3 => [point[0] - origin[0], point[1] - origin[1], point[2] - origin[2]];
    void this.controls.setLookAt(...at(state.position), ...at(state.target), false);
    void this.controls.setFocalOffset(...state.offset, false);
    void this.controls.zoomTo(state.zoom, false);
    this.controls.update(0);
  }

  private prepareDrag(event: PointerEvent): void {
    const { ACTION } = CameraControls;
    const orbit = event.shiftKey ? ACTION.TRUCK : event.ctrlKey ? ACTION.DOLLY : ACTION.ROTATE;
    const buttons = this.controls.mouseButtons;
    buttons.left = orbit;
    buttons.middle = this.profile === "rhino" ? ACTION.TRUCK : orbit;
    buttons.right = this.profile === "rhino" ? orbit : ACTION.TRUCK;
    const pressed = [buttons.left, buttons.middle, buttons.right][event.button];
    const orbits = event.pointerType === "touch" || pressed === ACTION.ROTATE;
    this.pressedAt = orbits ? { x: event.clientX, y: event.clientY } : undefined;
  }

  /**
   * When a press becomes a drag it orbits about the point it began on. A mere click
   * leaves the camera alone.
   */
  private beginDrag(event: PointerEvent): void {
    const from = this.pressedAt;
    if (!from || Math.hypot(event.clientX - from.x, event.clientY - from.y) < 2) return;
    this.pressedAt = undefined;
    const rectangle = this.canvas.getBoundingClientRect();
    const point = this.pointUnder(from.x - rectangle.left, from.y - rectangle.top);
    if (point) this.controls.setOrbitPoint(point.x, point.y, point.z);
  }

  private prepareWheel(event: WheelEvent): void {
    const { ACTION } = CameraControls;
    const zoom = this.isOrthographic ? ACTION.ZOOM : ACTION.DOLLY;
    if (event.ctrlKey) {
      // A pinch arrives as a wheel with Ctrl, for which camera-controls would narrow
      // the lens; people mean to come nearer. Pinches count in smaller steps.
      event.preventDefault();
      event.stopImmediatePropagation();
      this.controls.mouseButtons.wheel = zoom;
      this.pinching = true;
      const { clientX, clientY, deltaY, deltaMode } = event;
      this.canvas.dispatchEvent(new WheelEvent("wheel", { clientX, clientY, deltaY: 4 * deltaY, deltaMode, cancelable: true }));
      this.pinching = false;
      return;
    }
    if (this.pinching) return;
    const twoFingers = event.shiftKey || event.altKey ? ACTION.TRUCK : ACTION.ROTATE;
    this.controls.mouseButtons.wheel = this.profile === "trackpad" ? twoFingers : zoom;
  }
}
