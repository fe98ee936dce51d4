// The one mesh of the picture: a draw of 3 x triangles vertices without attributes.
import {
  BufferGeometry,
  Color,
  DataTexture,
  DoubleSide,
  GLSL3,
  Group,
  LineSegments,
  Mesh,
  RawShaderMaterial,
  RedFormat,
  RedIntegerFormat,
  UnsignedByteType,
  FloatType,
  RGBAFormat,
  type IUniform,
  type Texture,
  Vector2,
  Vector4,
} from "three";
import { CLASSES, type MapName, mapBytes } from "../core/colour.ts";
import type { ColourRange } from "../core/legend.ts";
import type { Shown, ShownField } from "../core/protocol.ts";
import { type Buffers, type Format, ROW } from "./buffers.ts";
import {
  ARROW_FRAGMENT,
  ARROW_VERTEX,
  PICK_FRAGMENT,
  PICK_VERTEX,
  SURFACE_FRAGMENT,
  SURFACE_VERTEX,
} from "./shaders.ts";
import type { ViewTheme } from "./theme.ts";

/** Arrows beyond this number are thinned out evenly. */
export const MOST_ARROWS = 60_000;

export type EdgeMode = "none" | "polygons" | "triangles";

type Uniforms = Record<string, IUniform>;

/** The buffers a picture needs. */
export function neededBuffers(shown: Shown, field: ShownField | undefined): { digest: string; format: Format }[] {
  const { mesh, directions } = shown;
  if (!mesh) return [];
  const needed: { digest: string; format: Format }[] = [
    { digest: mesh.positions, format: "vec3" },
    { digest: mesh.triangles_buffer, format: "uvec3" },
    { digest: mesh.triangle_faces, format: "uint" },
    { digest: mesh.edges, format: "byte" },
  ];
  if (mesh.base_faces) needed.push({ digest: mesh.base_faces, format: "uint" });
  if (directions) needed.push({ digest: directions.outward, format: "vec3" });
  if (field) needed.push({ digest: field.values, format: "float" });
  return needed;
}

/** Mesh, pick mesh and arrows of what is shown. They share geometry and uniforms. */
export class Surface {
  readonly group = new Group();
  readonly pickGroup = new Group();
  private readonly geometry = new BufferGeometry();
  private readonly arrowGeometry = new BufferGeometry();
  private readonly mesh: Mesh;
  private readonly pickMesh: Mesh;
  private readonly arrows: LineSegments;
  private readonly uniforms: Uniforms;
  private readonly noValues = new DataTexture(new Float32Array(1), 1, 1, RedFormat, FloatType);
  private panelStates = stateTexture(new Uint8Array(1), 1, 1);
  private maps = new Map<MapName, DataTexture>();
  private hasDirections = false;
  private wantsArrows = true;

  constructor() {
    this.noValues.needsUpdate = true;
    this.uniforms = this.makeUniforms();
    this.mesh = new Mesh(this.geometry, this.material(SURFACE_VERTEX, SURFACE_FRAGMENT));
    this.pickMesh = new Mesh(this.geometry, this.material(PICK_VERTEX, PICK_FRAGMENT));
    this.arrows = new LineSegments(this.arrowGeometry, this.material(ARROW_VERTEX, ARROW_FRAGMENT));
    this.arrowGeometry.setDrawRange(0, 0);
    this.geometry.setDrawRange(0, 0);
    for (const object of [this.mesh, this.pickMesh, this.arrows]) {
      // There is no attribute to take bounds from; the viewer knows them.
      object.frustumCulled = false;
      object.visible = false;
    }
    this.group.add(this.mesh, this.arrows);
    this.pickGroup.add(this.pickMesh);
  }

  /** Takes what is shown; its buffers must be loaded. */
  show(shown: Shown, field: ShownField | undefined, buffers: Buffers): void {
    const { mesh, directions } = shown;
    const visible = mesh !== undefined && mesh.triangles > 0;
    this.mesh.visible = visible;
    this.pickMesh.visible = visible;
    this.hasDirections = false;
    if (mesh && visible) {
      this.set("positions", buffers.texture(mesh.positions, "vec3"));
      this.set("triangles", buffers.texture(mesh.triangles_buffer, "uvec3"));
      this.set("triangleFaces", buffers.texture(mesh.triangle_faces, "uint"));
      this.set("edges", buffers.texture(mesh.edges, "byte"));
      this.set("hasPanels", mesh.base_faces !== undefined);
      this.set("baseFaces", buffers.texture(mesh.base_faces ?? mesh.triangle_faces, "uint"));
      this.geometry.setDrawRange(0, 3 * mesh.triangles);
      if (directions) this.showArrows(mesh.vertices, buffers.texture(directions.outward, "vec3"));
    }
    this.setField(field, field && visible ? buffers.texture(field.values, "float") : undefined);
    this.showDirections(this.wantsArrows);
  }

  /** Other positions of the same vertices, for a while: until the next result is shown. */
  usePositions(positions: Texture): void {
    this.set("positions", positions);
  }

  private showArrows(vertices: number, outward: Texture): void {
    const every = Math.max(1, Math.ceil(vertices / MOST_ARROWS));
    this.set("outward", outward);
    this.set("every", every);
    this.arrowGeometry.setDrawRange(0, 6 * Math.ceil(vertices / every));
    this.hasDirections = true;
  }

  /** Shows or hides the arrows, where there are any. */
  showDirections(wanted: boolean): void {
    this.wantsArrows = wanted;
    this.arrows.visible = wanted && this.hasDirections;
  }

  private setField(field: ShownField | undefined, values: Texture | undefined): void {
    this.set("values", values ?? this.noValues);
    this.set("valuesOn", !field || !values ? 0 : field.on === "vertex" ? 1 : 2);
    this.set("categorical", field?.categorical ?? false);
  }

  setColours(map: MapName, range: ColourRange): void {
    let texture = this.maps.get(map);
    if (!texture) {
      texture = new DataTexture(mapBytes(map), 256, 1, RGBAFormat);
      texture.needsUpdate = true;
      this.maps.set(map, texture);
    }
    this.set("colours", texture);
    (this.uniforms["range"]?.value as Vector2).set(range.min, range.max);
  }

  setTheme(theme: ViewTheme): void {
    const colour = (name: string, hex: string): void => {
      (this.uniforms[name]?.value as Color).set(hex);
    };
    colour("frontColour", theme.front);
    colour("backColour", theme.back);
    colour("edgeColour", theme.edge);
    colour("unknownColour", theme.unknown);
    colour("pickColour", theme.pick);
    colour("arrowColour", theme.arrow);
  }

  setEdges(mode: EdgeMode, pixelRatio: number): void {
    this.set("edgeMode", ["none", "polygons", "triangles"].indexOf(mode));
    this.set("edgeWidth", 0.55 * pixelRatio);
    this.set("pixelRatio", pixelRatio);
  }

  /** Bits of each panel as the shaders know them; `isolating` hides those without bit 2. */
  setPanels(states: Uint8Array, isolating: boolean): void {
    const rows = Math.max(1, Math.ceil(states.length / ROW));
    const texels = new Uint8Array(rows * ROW);
    texels.set(states);
    this.panelStates.dispose();
    this.panelStates = stateTexture(texels, ROW, rows);
    this.set("panelStates", this.panelStates);
    this.set("panelStateCount", states.length);
    this.set("isolating", isolating);
  }

  setPicked(face: number | undefined): void {
    this.set("pickedFace", face ?? -1);
  }

  /** Cuts away where the plane's side is positive; scene coordinates. */
  setCut(plane: [number, number, number, number] | undefined): void {
    this.set("cut", plane !== undefined);
    if (plane) (this.uniforms["cutPlane"]?.value as Vector4).fromArray(plane);
  }

  setGhost(ghost: boolean): void {
    this.set("ghost", ghost);
    const material = this.mesh.material as RawShaderMaterial;
    material.transparent = ghost;
    material.depthWrite = !ghost;
    material.needsUpdate = true;
  }

  /** Puts the mesh where its own origin lies in the scene. */
  place(x: number, y: number, z: number): void {
    this.group.position.set(x, y, z);
    this.pickGroup.position.set(x, y, z);
  }

  private set(name: string, value: unknown): void {
    const uniform = this.uniforms[name];
    if (uniform) uniform.value = value;
  }

  private material(vertexShader: string, fragmentShader: string): RawShaderMaterial {
    return new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader,
      fragmentShader,
      uniforms: this.uniforms,
      side: DoubleSide,
    });
  }

  private makeUniforms(): Uniforms {
    const values: Record<string, unknown> = {
      positions: null,
      triangles: null,
      triangleFaces: null,
      edges: null,
      baseFaces: null,
      hasPanels: false,
      panelStates: this.panelStates,
      panelStateCount: 0,
      isolating: false,
      outward: null,
      values: this.noValues,
      valuesOn: 0,
      colours: null,
      range: new Vector2(0, 1),
      categorical: false,
      classes: CLASSES.map(([r, g, b]) => new Color(r, g, b)),
      frontColour: new Color(),
      backColour: new Color(),
      edgeColour: new Color(),
      unknownColour: new Color(),
      pickColour: new Color(),
      arrowColour: new Color(),
      edgeMode: 1,
      edgeWidth: 0.55,
      pickedFace: -1,
      cut: false,
      cutPlane: new Vector4(),
      ghost: false,
      pixelRatio: 1,
      every: 1,
      size: 1,
    };
    return Object.fromEntries(Object.entries(values).map(([name, value]) => [name, { value }]));
  }
}

function stateTexture(states: Uint8Array<ArrayBuffer>, width: number, height: number): DataTexture {
  const texture = new DataTexture(states, width, height, RedIntegerFormat, UnsignedByteType);
  texture.unpackAlignment = 1;
  texture.needsUpdate = true;
  return texture;
}
