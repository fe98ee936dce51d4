// What comes of an answer that arrives in pieces.
import assert from "node:assert/strict";
import { test } from "node:test";
import { bytesOf } from "../../src/core/bytes.ts";

/** An answer that can be read into the reader's own memory, or only piece by piece. */
function answer(pieces: number[][], headers: Record<string, string>, direct = false): Response {
  const start = (controller: ReadableByteStreamController | ReadableStreamDefaultController<Uint8Array>): void => {
    for (const piece of pieces) controller.enqueue(Uint8Array.from(piece));
    controller.close();
  };
  const body = direct ? new ReadableStream({ type: "bytes", start }) : new ReadableStream<Uint8Array>({ start });
  return new Response(body, { headers });
}

const pieces = [[1, 2], [3], [4, 5, 6]];

test("pieces stand one after another", async () => {
  for (const headers of [{ "content-length": "6" }, {}, { "content-length": "2", "content-encoding": "x" }] as Record<string, string>[]) {
    for (const direct of [false, true]) {
      const bytes = await bytesOf(answer(pieces, headers, direct));
      assert.deepEqual([...new Uint8Array(bytes)], [1, 2, 3, 4, 5, 6]);
    }
  }
});

test("an answer that breaks off, or goes on, is none", async () => {
  for (const direct of [false, true]) {
    await assert.rejects(bytesOf(answer(pieces, { "content-length": "7" }, direct)), /6 bytes came instead of 7/);
  }
  // Browsers themselves end an answer at its announced length; then nothing more is looked for.
  await assert.rejects(bytesOf(answer(pieces, { "content-length": "5" })), /more than the 5 bytes/);
});
