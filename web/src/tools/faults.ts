// The faces that failing checks mark: what `[` and `]` walk through.
import type { Checks, Shown, ShownField } from "../core/protocol.ts";
import type { BufferSource } from "../view/buffers.ts";

export type Marked = { label: string; faces: number[]; panelOf(face: number): number };

/** The field of faces on which a failing check counts its faults: a bare number, never below zero, above it somewhere. */
export function faultField(fields: ShownField[], checks: Checks | undefined): ShownField | undefined {
  const failing = new Set((checks?.items ?? []).filter((check) => check.ok === false).map((check) => check.node));
  return fields.find((field) => field.on === "face" && field.unit === "" && field.min >= 0 && field.max > 0 && failing.has(field.node));
}

/** Faces that a field counts faults on, the lowest first. */
export function faultyFaces(values: Float32Array): number[] {
  return [...values.keys()].filter((face) => (values[face] as number) > 0);
}

export class Faults {
  private last: { of: string; marked: Marked } | undefined;

  constructor(private readonly source: BufferSource) {}

  /** What is marked on what is shown; nothing where no failing check marks faces. */
  async marked(shown: Shown | undefined, checks: Checks | undefined): Promise<Marked | undefined> {
    const field = faultField(shown?.fields ?? [], checks);
    if (!field || !shown?.mesh) return undefined;
    const base = shown.mesh.base_faces;
    const of = `${field.values} ${base ?? ""}`;
    if (this.last?.of === of) return this.last.marked;
    const [values, panels] = await Promise.all([this.source(field.values), base ? this.source(base) : undefined]);
    const panelIds = panels && new Uint32Array(panels);
    const marked = { label: field.label, faces: faultyFaces(new Float32Array(values)), panelOf: (face: number) => panelIds?.[face] ?? face };
    this.last = { of, marked };
    return marked;
  }
}
