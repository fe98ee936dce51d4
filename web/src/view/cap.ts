// The filled cut: outlines come from the server, and the stencil buffer counts how
// often they go around a pixel, for all bodies at once. Open outlines are only drawn.
import {
  AlwaysStencilFunc,
  BackSide,
  BufferAttribute,
  BufferGeometry,
  Color,
  DecrementWrapStencilOp,
  DoubleSide,
  FrontSide,
  GLSL3,
  Group,
  IncrementWrapStencilOp,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  NotEqualStencilFunc,
  PlaneGeometry,
  RawShaderMaterial,
  type Side,
  Vector3,
} from "three";
import type { Vec3 } from "../core/protocol.ts";
import { basisOf } from "../core/section.ts";
import type { ViewTheme } from "./theme.ts";

const HATCH_VERTEX = /* glsl */ `
precision highp float;
in vec3 position;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }
`;

const HATCH_FRAGMENT = /* glsl */ `
precision highp float;
uniform vec3 ground;
uniform vec3 line;
uniform float pixelRatio;
out vec4 colour;
void main() {
  vec2 pixel = gl_FragCoord.xy / pixelRatio;
  float stripe = abs(fract((pixel.x + pixel.y) / 9.0) - 0.5) * 9.0;
  colour = vec4(mix(line, ground, smoothstep(0.4, 1.4, stripe)), 1.0);
}
`;

export class Cap {
  readonly group = new Group();
  private fan = new BufferGeometry();
  private outline = new BufferGeometry();
  private readonly counters: Mesh[];
  private readonly plane: Mesh;
  private readonly lines: LineSegments;
  private readonly uniforms = { ground: { value: new Color() }, line: { value: new Color() }, pixelRatio: { value: 1 } };

  constructor() {
    const counter = (side: Side): Mesh => new Mesh(this.fan, new MeshBasicMaterial({
      side,
      colorWrite: false,
      depthWrite: false,
      depthTest: false,
      stencilWrite: true,
      stencilFunc: AlwaysStencilFunc,
      stencilZPass: side === FrontSide ? IncrementWrapStencilOp : DecrementWrapStencilOp,
    }));
    this.counters = [counter(FrontSide), counter(BackSide)];
    const hatch = new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: HATCH_VERTEX,
      fragmentShader: HATCH_FRAGMENT,
      uniforms: this.uniforms,
      side: DoubleSide,
      stencilWrite: true,
      stencilFunc: NotEqualStencilFunc,
      stencilRef: 0,
    });
    this.plane = new Mesh(new PlaneGeometry(1, 1), hatch);
    this.plane.matrixAutoUpdate = false;
    this.lines = new LineSegments(this.outline, new LineBasicMaterial());
    [...this.counters, this.plane, this.lines].forEach((object, order) => {
      object.frustumCulled = false;
      object.renderOrder = 1 + order;
      this.group.add(object);
    });
    this.group.visible = false;
  }

  /** Shows a cut; `origin` is where its numbers begin in the scene, `size` how far the model reaches at most. */
  show(fan: Float32Array, outline: Float32Array, normal: Vec3, origin: Vector3, size: number): void {
    this.fan.dispose();
    this.fan = new BufferGeometry().setAttribute("position", new BufferAttribute(fan, 3));
    for (const counter of this.counters) counter.geometry = this.fan;
    this.outline.dispose();
    this.outline = new BufferGeometry().setAttribute("position", new BufferAttribute(outline, 3));
    this.lines.geometry = this.outline;
    const [u, v] = basisOf(normal);
    const scaled = (axis: Vec3): Vector3 => new Vector3(...axis).multiplyScalar(4 * size);
    this.plane.matrix = new Matrix4().makeBasis(scaled(u), scaled(v), new Vector3(...normal));
    this.plane.matrixWorldNeedsUpdate = true;
    this.group.position.copy(origin);
    this.group.visible = outline.length > 0;
  }

  hide(): void {
    this.group.visible = false;
  }

  setTheme(theme: ViewTheme): void {
    this.uniforms.ground.value.set(theme.front).multiplyScalar(0.92);
    this.uniforms.line.value.set(theme.edge);
    (this.lines.material as LineBasicMaterial).color.set(theme.edge);
  }

  setPixelRatio(ratio: number): void {
    this.uniforms.pixelRatio.value = ratio;
  }
}
