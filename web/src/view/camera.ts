// The camera: Z up, perspective or orthographic, moved by camera-controls in the
// manner people know from Rhino, Blender or a trackpad. It is never moved by an
// update of the model.
import CameraControls from "camera-controls";
import * as THREE from "three";
import type { Vec3 } from "../core/protocol.ts";
import { boxCorners, fitDistance } from "./fit.ts";

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

const FIELD_OF_VIEW = 35;

/** What is kept of a camera between pages: absolute metres. */
export type CameraState = { position: Vec3; target: Vec3; offset: Vec3; zoom: number; orthographic: boolean };

export class ViewCamera {
  readonly controls: CameraControls;
  private readonly perspective = new THREE.PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 1000);
  private readonly orthographic = new THREE.OrthographicCamera(-1, 1, 1, -1, -1000, 1000);
  private aspect = 1;
  private bounds = new THREE.Sphere(new THREE.Vector3(), 1);
  private pinching = false;
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
    this.orthographic.left = -this.aspect;
    this.orthographic.right = this.aspect;
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

  /** Moves along the present direction until the box fills the view. */
  fit(box: THREE.Box3, animate = true): void {
    if (box.isEmpty()) return;
    const centre = box.getCenter(new THREE.Vector3());
    const size = box.getSize(new THREE.Vector3());
    if (size.length() < 1e-9) box = box.clone().expandByScalar(0.5);
    const corners = boxCorners(box).map((corner) => corner.sub(centre));
    this.controls.update(0);
    this.camera.updateMatrixWorld();
    const [right, up, back] = [0, 1, 2].map((k) => new THREE.Vector3().setFromMatrixColumn(this.camera.matrixWorld, k)) as [THREE.Vector3, THREE.Vector3, THREE.Vector3];
    const tangent = Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
    const room = 1.08;
    const distance = Math.max(1e-3, fitDistance(corners, right, up, back, (tangent * this.aspect) / room, tangent / room));
    const transition = animate && this.smooth();
    void this.controls.setFocalOffset(0, 0, 0, transition);
    void this.controls.moveTo(centre.x, centre.y, centre.z, transition);
    void this.controls.dollyTo(distance, transition);
    const extent = Math.max(...corners.map((c) => Math.max(Math.abs(c.dot(right)) / this.aspect, Math.abs(c.dot(up)))));
    void this.controls.zoomTo(this.isOrthographic ? 1 / (room * extent) : 1, transition);
  }

  look(view: StandardView): void {
    const [azimuth, polar] = VIEWS[view];
    this.controls.normalizeRotations();
    void this.controls.rotateTo(azimuth, polar, this.smooth());
  }

  /** Changes the projection and keeps the size of what is at the target. */
  toggleProjection(): void {
    const tangent = Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
    if (this.isOrthographic) {
      const distance = 1 / this.orthographic.zoom / tangent;
      this.controls.camera = this.perspective;
      void this.controls.zoomTo(1, false);
      void this.controls.dollyTo(distance, false);
    } else {
      const height = this.controls.distance * tangent;
      this.controls.camera = this.orthographic;
      void this.controls.zoomTo(1 / height, false);
    }
    this.controls.update(0);
    this.clip(this.bounds);
  }

  /** Metres of one CSS pixel at the target. */
  metresPerPixel(height: number): number {
    if (this.isOrthographic) return 2 / this.orthographic.zoom / height;
    const tangent = Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
    const distance = this.camera.position.distanceTo(this.bounds.center);
    return (2 * distance * tangent) / height;
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
    if (event.pointerType !== "touch" && pressed !== ACTION.ROTATE) return;
    const rectangle = this.canvas.getBoundingClientRect();
    const point = this.pointUnder(event.clientX - rectangle.left, event.clientY - rectangle.top);
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
