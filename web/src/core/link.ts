// How a model is looked at as the end of an address: `#view=...`. A link never
// holds the model, nor anything that changes a result.
import type { Picked } from "../tools/picking.ts";
import type { ViewState } from "./settings.ts";

/** What is picked: the panels, and the one that is read out. */
export type Selection = { panels: number[]; picked?: Picked | undefined };

/** The parts of a view that a link carries. */
export type LinkedView = Partial<Pick<ViewState, (typeof PARTS)[number]>> & { selection?: Selection };

const PARTS = ["camera", "edges", "grid", "directions", "ghost", "field", "section", "panels", "node"] as const;

/** Longer addresses are cut by some programs that pass them on. */
const LONGEST = 8000;

const MARK = "#view=";

/** The end of an address that shows a view; hidden panels are left out where they would make it too long. */
export function viewFragment(view: ViewState, selection: Selection): string {
  const linked: LinkedView = { selection };
  for (const part of PARTS) Object.assign(linked, { [part]: view[part] });
  const whole = encode(linked);
  if (whole.length <= LONGEST) return whole;
  return encode({ ...linked, panels: undefined, selection: { panels: [], picked: selection.picked } });
}

function encode(linked: LinkedView): string {
  const bytes = new TextEncoder().encode(JSON.stringify(linked));
  const text = btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
  return MARK + text.replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

/** The view that an address names; whatever in it is not as expected is left out. */
export function readFragment(fragment: string): LinkedView | undefined {
  if (!fragment.startsWith(MARK)) return undefined;
  let read: unknown;
  try {
    const text = atob(fragment.slice(MARK.length).replaceAll("-", "+").replaceAll("_", "/"));
    read = JSON.parse(new TextDecoder().decode(Uint8Array.from(text, (c) => c.charCodeAt(0))));
  } catch {
    return undefined;
  }
  if (!isRecord(read)) return undefined;
  const view: Record<string, unknown> = {};
  for (const [name, isRight] of Object.entries(SHAPES)) {
    if (name in read && isRight(read[name])) view[name] = read[name];
  }
  return view as LinkedView;
}

type Shape = (value: unknown) => boolean;

const isRecord = (value: unknown): value is Record<string, unknown> => typeof value === "object" && value !== null && !Array.isArray(value);
const isNumber: Shape = (value) => typeof value === "number" && Number.isFinite(value);
const isCount: Shape = (value) => Number.isInteger(value) && (value as number) >= 0 && (value as number) < 2 ** 32;
const isText: Shape = (value) => typeof value === "string";
const isTruth: Shape = (value) => typeof value === "boolean";
const isPlace: Shape = (value) => Array.isArray(value) && value.length === 3 && value.every(isNumber);
const isCounts: Shape = (value) => Array.isArray(value) && value.every(isCount);
const isOneOf = (...words: string[]): Shape => (value) => words.includes(value as string);
const isMaybe = (shape: Shape): Shape => (value) => value === undefined || shape(value);
const isMadeOf = (parts: Record<string, Shape>): Shape => (value) => isRecord(value) && Object.entries(parts).every(([name, shape]) => shape(value[name]));

const SHAPES: Record<(typeof PARTS)[number] | "selection", Shape> = {
  camera: isMadeOf({ position: isPlace, target: isPlace, offset: isPlace, zoom: isNumber, orthographic: isTruth }),
  edges: isOneOf("polygons", "triangles", "none"),
  grid: isTruth,
  directions: isTruth,
  ghost: isTruth,
  field: isText,
  section: isMadeOf({ normal: isPlace, at: isNumber, flipped: isTruth }),
  panels: isMadeOf({ hidden: isCounts, isolated: isMaybe(isCounts) }),
  node: isMadeOf({ node: isText, result: isText }),
  selection: isMadeOf({
    panels: isCounts,
    picked: isMaybe(isMadeOf({ face: isCount, panel: isCount, vertex: isCount, level: isOneOf("panel", "face", "vertex") })),
  }),
};
