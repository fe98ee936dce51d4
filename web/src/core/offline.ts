// A page that was saved: the last messages and the buffers they name are part of
// it, and nobody answers. What can be read off the drawn numbers still is.
import type { Amount, Digest, FromServer, Measured, Picked, Place, ShownMesh, ToServer, Vec3 } from "./protocol.ts";
import { lengthUnit, type Store } from "./store.ts";
import { formatNumber } from "./units.ts";

/** What a saved page carries: messages, and buffers by name as base64 of gzip. */
export type Saved = { messages: FromServer[]; buffers: Record<Digest, string> };

/** The saved part of this page, if it is one. */
export function savedPart(): Saved | undefined {
  const text = document.getElementById("saved")?.textContent;
  return text ? (JSON.parse(text) as Saved) : undefined;
}

/** Unpacks a buffer; throws where the page does not carry it. */
export async function unpack(saved: Saved, digest: Digest): Promise<ArrayBuffer> {
  const packed = saved.buffers[digest];
  if (packed === undefined) throw new Error(`buffer ${digest} is not part of this page`);
  const bytes = Uint8Array.from(atob(packed), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

/** Gives the page its messages, and answers what can be answered. */
export function replay(store: Store, saved: Saved): void {
  store.setLink("offline");
  for (const message of saved.messages) store.receive(message);
  store.send = (message) => void answer(store, saved, message);
}

async function answer(store: Store, saved: Saved, message: ToServer): Promise<void> {
  const mesh = store.get("shown")?.mesh;
  if (!mesh || (message.type !== "pick" && message.type !== "measure")) return;
  const positions = new Float32Array(await unpack(saved, mesh.positions));
  const told = { mesh, positions, unit: lengthUnit(store.get("document")) };
  const reply = message.type === "pick" ? pick(told, message.request, message) : measure(told, message.request, message.from, message.to);
  if (reply) store.receive(reply);
}

type Told = { mesh: ShownMesh; positions: Float32Array; unit: string };

/** Where a vertex is drawn, in metres. */
function placeOf({ mesh, positions }: Told, vertex: number): Vec3 | undefined {
  if (vertex >= mesh.vertices) return undefined;
  return mesh.origin.map((shift, axis) => shift + (positions[3 * vertex + axis] ?? 0)) as Vec3;
}

/** A length in the file's unit, with the digits that drawn numbers have. */
function lengthText({ mesh, unit }: Told, metres: number, size: number): Amount {
  const step = 10 ** (Math.floor(Math.log10(Math.max(size * mesh.scale, 1e-12))) - 4);
  const text = `${formatNumber(Math.round((metres * mesh.scale) / step) * step)} ${unit}`;
  return { text, exact: `${text}, as drawn` };
}

export function pick(told: Told, request: number, { face, vertex }: Place): Picked {
  const place = vertex === undefined ? undefined : placeOf(told, vertex);
  if (!place) return { type: "picked", request, ...(face === undefined ? {} : { face }), lines: face === undefined ? [] : [["face", plain(face)]] };
  const [low, high] = told.mesh.bounds;
  const size = Math.hypot(...low.map((l, k) => (high[k] ?? 0) - l));
  const axes = place.map((c, k): [string, Amount] => ["xyz"[k] ?? "", lengthText(told, c, size)]);
  return { type: "picked", request, vertex: vertex ?? 0, lines: [["vertex", plain(vertex ?? 0)], ...axes], vertices: [place] };
}

export function measure(told: Told, request: number, a: Place, b: Place): Measured | undefined {
  const [from, to] = [a, b].map(({ vertex }) => (vertex === undefined ? undefined : placeOf(told, vertex)));
  if (!from || !to) return undefined;
  const apart = to.map((c, k) => c - (from[k] ?? 0)) as Vec3;
  const distance = Math.hypot(...apart);
  const delta = apart.map((along) => lengthText(told, along, distance)) as Measured["delta"];
  return { type: "measured", request, from, to, distance: lengthText(told, distance, distance), delta };
}

function plain(count: number): Amount {
  return { text: String(count), exact: String(count) };
}
