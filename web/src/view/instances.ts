// An array drawn from its parts: a pass over the vertices computes X(u, v, w) on the
// graphics card into a texture, which stands in for the positions of the exact mesh.
// So faces, edges, ids and colours are those of the mesh, and everything that draws
// it draws the preview, while one uniform is all that changes.
import {
  BufferGeometry,
  Camera,
  FloatType,
  GLSL3,
  Mesh,
  NearestFilter,
  RawShaderMaterial,
  RGBAFormat,
  Scene,
  type Texture,
  WebGLRenderTarget,
  type WebGLRenderer,
} from "three";
import { CANCELLED } from "../core/instances.ts";
import type { Instances } from "../core/protocol.ts";
import { type Buffers, type Format, ROW } from "./buffers.ts";

const VERTEX = /* glsl */ `
precision highp float;
// One triangle over all texels.
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }
`;

const FRAGMENT = /* glsl */ `
precision highp float;
precision highp int;
uniform highp usampler2D vertices;
uniform highp sampler2D points;
uniform highp usampler2D grids;
uniform highp usampler2D gridStarts;
uniform highp sampler2D positions;
uniform highp sampler2D outward;
uniform highp sampler2D inward;
uniform highp sampler2D factor0;
uniform highp sampler2D factor1;
uniform bool isUnit;
uniform bool hasInward;
uniform int factorCount;
uniform int count;
uniform float factor;
out vec4 position;

ivec2 at(int index) { return ivec2(index & 4095, index >> 12); }

// Base vertices about a place in the grid that begins at \`start\`.
ivec4 grid(int start, float first, int row) {
  int k = start + int(first);
  return ivec4(
    texelFetch(grids, at(k), 0).x, texelFetch(grids, at(k + 1), 0).x,
    texelFetch(grids, at(k + row), 0).x, texelFetch(grids, at(k + row + 1), 0).x);
}

vec4 weights(vec2 f) { return vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y); }

float blend(highp sampler2D values, ivec4 k, vec4 by) {
  return dot(by, vec4(texelFetch(values, at(k.x), 0).x, texelFetch(values, at(k.y), 0).x, texelFetch(values, at(k.z), 0).x, texelFetch(values, at(k.w), 0).x));
}

vec4 blend4(highp sampler2D values, ivec4 k, vec4 by) {
  return by.x * texelFetch(values, at(k.x), 0) + by.y * texelFetch(values, at(k.y), 0) + by.z * texelFetch(values, at(k.z), 0) + by.w * texelFetch(values, at(k.w), 0);
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  int vertex = texel.y * 4096 + texel.x;
  if (vertex >= count) discard;
  int placement = int(texelFetch(vertices, at(2 * vertex), 0).x);
  int point = int(texelFetch(vertices, at(2 * vertex + 1), 0).x);
  vec4 place = texelFetch(points, at(2 * point), 0);
  vec4 way = texelFetch(points, at(2 * point + 1), 0);
  int start = int(texelFetch(gridStarts, at(placement), 0).x);
  int row = int(way.w);
  ivec4 corners = grid(start, place.x, row);
  vec4 by = weights(place.yz);
  float height = factor * place.w;
  if (factorCount > 0) height *= blend(factor0, corners, by);
  if (factorCount > 1) height *= blend(factor1, corners, by);
  vec4 foot = blend4(positions, corners, by);
  corners = grid(start, way.x, row);
  by = weights(way.yz);
  vec4 direction = hasInward && height < 0.0 ? blend4(inward, corners, by) : blend4(outward, corners, by);
  float stretch = 1.0;
  if (isUnit) {
    float length = length(direction.xyz);
    stretch = length > ${CANCELLED} ? direction.w / length : 0.0;
  }
  position = vec4(foot.xyz + height * stretch * direction.xyz, 1.0);
}
`;

/** Most factors that the shader multiplies; the server sends no more. */
const FACTORS = 2;

/** The buffers a preview needs. */
export function instanceBuffers(instances: Instances): { digest: string; format: Format }[] {
  const needed: { digest: string; format: Format }[] = [
    { digest: instances.vertices, format: "uint" },
    { digest: instances.points, format: "vec4" },
    { digest: instances.grids, format: "uint" },
    { digest: instances.grid_starts, format: "uint" },
    { digest: instances.positions, format: "vec3" },
    { digest: instances.outward, format: "vec4" },
  ];
  if (instances.inward) needed.push({ digest: instances.inward, format: "vec4" });
  for (const digest of instances.factors) needed.push({ digest, format: "float" });
  return needed;
}

/** Parts of an array on the graphics card, and the positions made of them. */
export class InstancedPositions {
  private readonly target: WebGLRenderTarget;
  private readonly material: RawShaderMaterial;
  private readonly scene = new Scene();
  private readonly camera = new Camera();
  private readonly geometry = new BufferGeometry();
  /** How far from the base the heights reach at a factor of 1. */
  readonly reach: number;

  /** The buffers of `instances` must be loaded; `count` is the number of vertices. */
  constructor(
    private readonly renderer: WebGLRenderer,
    instances: Instances,
    buffers: Buffers,
    count: number,
  ) {
    this.reach = instances.reach;
    if (!renderer.extensions.has("EXT_color_buffer_float")) throw new Error("this graphics driver draws no numbers");
    if (instances.factors.length > FACTORS) throw new Error(`more than ${FACTORS} factors`);
    this.target = new WebGLRenderTarget(ROW, Math.max(1, Math.ceil(count / ROW)), {
      format: RGBAFormat,
      type: FloatType,
      internalFormat: "RGBA32F",
      minFilter: NearestFilter,
      magFilter: NearestFilter,
      depthBuffer: false,
    });
    const { positions, outward, factors } = instances;
    const float = (digest: string | undefined): Texture => (digest ? buffers.texture(digest, "float") : buffers.texture(positions, "vec3"));
    const uniforms: Record<string, unknown> = {
      vertices: buffers.texture(instances.vertices, "uint"),
      points: buffers.texture(instances.points, "vec4"),
      grids: buffers.texture(instances.grids, "uint"),
      gridStarts: buffers.texture(instances.grid_starts, "uint"),
      positions: buffers.texture(positions, "vec3"),
      outward: buffers.texture(outward, "vec4"),
      inward: buffers.texture(instances.inward ?? outward, "vec4"),
      factor0: float(factors[0]),
      factor1: float(factors[1]),
      isUnit: instances.is_unit,
      hasInward: instances.inward !== undefined,
      factorCount: factors.length,
      count,
      factor: 1,
    };
    this.material = new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: Object.fromEntries(Object.entries(uniforms).map(([name, value]) => [name, { value }])),
      depthTest: false,
      depthWrite: false,
    });
    this.geometry.setDrawRange(0, 3);
    const triangle = new Mesh(this.geometry, this.material);
    triangle.frustumCulled = false;
    this.scene.add(triangle);
  }

  /** The positions when all heights are multiplied by `factor`. */
  at(factor: number): Texture {
    const { renderer } = this;
    const uniform = this.material.uniforms["factor"];
    if (uniform) uniform.value = factor;
    const before = renderer.getRenderTarget();
    renderer.setRenderTarget(this.target);
    renderer.render(this.scene, this.camera);
    renderer.setRenderTarget(before);
    return this.target.texture;
  }

  dispose(): void {
    this.target.dispose();
    this.material.dispose();
    this.geometry.dispose();
  }
}
