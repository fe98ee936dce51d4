import assert from "node:assert/strict";
import { test } from "node:test";
import { deflateSync } from "node:zlib";
import { Alternatives } from "../../src/core/alternatives.ts";
import { draggedRange } from "../../src/core/legend.ts";
import { crc32, withTexts } from "../../src/core/png.ts";
import type { Checks, Parameter, ShownField, ToServer } from "../../src/core/protocol.ts";
import { faultField, faultyFaces } from "../../src/tools/faults.ts";
import { Panels } from "../../src/tools/panels.ts";
import { pictureTexts } from "../../src/tools/screenshot.ts";

function parameter(name: string, value: number, more: Partial<Parameter> = {}): Parameter {
  return { name, kind: "number", value, in_file: value, initial: value, unit: "m", about: "", locked: false, line: 1, span: [0, 1], ...more };
}

test("B is sent once while it is held, and A once when it is let go", () => {
  const sent: ToServer[] = [];
  const alternatives = new Alternatives((message) => sent.push(message));
  const [depth, gap, held] = [parameter("depth", 1), parameter("gap", 2), parameter("held", 3, { locked: true })];
  assert.equal(alternatives.flip(true, [depth, gap]), false, "nothing is kept yet");
  alternatives.store({ ...depth, value: 5 });
  alternatives.store({ ...held, value: 9 });
  alternatives.flip(true, [depth, gap, held]);
  alternatives.flip(true, [depth, gap, held]);
  alternatives.flip(false, [depth, gap, held]);
  alternatives.flip(false, [depth, gap, held]);
  assert.deepEqual(sent, [{ type: "set", name: "depth", value: 5 }, { type: "set", name: "depth", value: 1 }]);
  alternatives.store({ ...depth, value: 5 });
  assert.equal(alternatives.of("depth"), undefined, "kept again it is forgotten");
});

test("ends of a range are dragged and never meet", () => {
  assert.deepEqual(draggedRange({ min: 0, max: 10 }, "low", 0.25), { min: 2.5, max: 10 });
  assert.deepEqual(draggedRange({ min: 0, max: 10 }, "high", 0.5), { min: 0, max: 15 });
  assert.deepEqual(draggedRange({ min: 0, max: 10 }, "low", 3), { min: 9.9, max: 10 });
  assert.deepEqual(draggedRange({ min: 0, max: 10 }, "high", -3), { min: 0, max: 0.1 });
});

test("checksums are those of the standard", () => {
  assert.equal(crc32(new TextEncoder().encode("123456789")), 0xcbf43926);
  assert.equal(crc32(new TextEncoder().encode("IEND")), 0xae426082);
});

/** The chunks of a PNG whose checksums are right. */
function chunksOf(png: Uint8Array): [string, string][] {
  const view = new DataView(png.buffer, png.byteOffset);
  const chunks: [string, string][] = [];
  for (let at = 8; at < png.length; ) {
    const length = view.getUint32(at);
    const body = png.subarray(at + 4, at + 8 + length);
    assert.equal(view.getUint32(at + 8 + length), crc32(body));
    chunks.push([Buffer.from(body.subarray(0, 4)).toString(), Buffer.from(body.subarray(4)).toString()]);
    at += length + 12;
  }
  return chunks;
}

test("texts stand behind the head of a PNG, in every script", () => {
  const chunk = (name: string, body: Uint8Array): Buffer => {
    const whole = Buffer.concat([Buffer.alloc(4), Buffer.from(name), body, Buffer.alloc(4)]);
    whole.writeUInt32BE(body.length, 0);
    whole.writeUInt32BE(crc32(whole.subarray(4, 8 + body.length)), 8 + body.length);
    return whole;
  };
  const head = Buffer.from([0, 0, 0, 1, 0, 0, 0, 1, 8, 0, 0, 0, 0]);
  const png = Buffer.concat([Buffer.from("\x89PNG\r\n\x1a\n", "latin1"), chunk("IHDR", head), chunk("IDAT", deflateSync(Buffer.from([0, 7]))), chunk("IEND", Buffer.alloc(0))]);
  const texts: [string, string][] = [["Title", "façade.ron · 屋根"], ["Parameters", "a = 1\nb = 2"]];
  const chunks = chunksOf(withTexts(png, texts));
  assert.deepEqual(chunks.map(([name]) => name), ["IHDR", "iTXt", "iTXt", "IDAT", "IEND"]);
  assert.deepEqual(chunks.slice(1, 3).map(([, body]) => body), texts.map(([keyword, text]) => `${keyword}\0\0\0\0\0${text}`));
});

test("a picture says its parameters with all digits", () => {
  const hello = { type: "hello", version: "1.2", file: "f.ron", folder: "", session: "", read_only: false } as const;
  const graph = { type: "document", source: "", units: "m", parameters: [parameter("depth", 1 / 3), parameter("n", 2)], nodes: [], outputs: [], can_undo: false, can_redo: false } as const;
  assert.deepEqual(pictureTexts(hello, { ...graph, parameters: [...graph.parameters], nodes: [], outputs: [] }, undefined), [["Software", "tessgraph 1.2"], ["Title", "f.ron"], ["Parameters", "depth = 0.3333333333333333\nn = 2"]]);
});

test("a failing check's count on faces says where to go", () => {
  const field = (more: Partial<ShownField>): ShownField => ({ name: "f", label: "f", on: "face", unit: "", min: 0, max: 3, values: "0", categorical: false, node: "check", ...more });
  const checks = (ok: boolean | null): Checks => ({ type: "checks", items: [{ node: "check", kind: "CheckIntersections", values: [], ok, sentence: "" }] });
  const crossings = field({});
  const others = [field({ on: "vertex" }), field({ unit: "m" }), field({ min: -1 }), field({ max: 0 }), field({ node: "other" })];
  assert.equal(faultField([...others, crossings], checks(false)), crossings);
  assert.equal(faultField([...others], checks(false)), undefined);
  assert.equal(faultField([crossings], checks(true)), undefined);
  assert.equal(faultField([crossings], checks(null)), undefined);
  assert.deepEqual(faultyFaces(Float32Array.from([0, 2, Number.NaN, 0, 1])), [1, 4]);
});

test("rectangles select, add, and what is hidden is not visible", () => {
  const panels = new Panels();
  panels.selectAll([3, 4], false);
  panels.selectAll([5], true);
  assert.deepEqual([...panels.selected], [3, 4, 5]);
  panels.selectAll([9], false);
  assert.equal(panels.hide(), 1);
  assert.deepEqual([panels.isVisible(9), panels.isVisible(3)], [false, true]);
  panels.selectAll([3], false);
  panels.isolate();
  assert.deepEqual([panels.isVisible(3), panels.isVisible(4)], [true, false]);
});
