// What comes of an answer that arrives in pieces.
import assert from "node:assert/strict";
import { test } from "node:test";
import { bytesOf } from "../../src/core/bytes.ts";

function answer(pieces: number[][], headers: Record<string, string>): Response {
  const body = new ReadableStream<Uint8Array>({
    start(controller) {
      for (const piece of pieces) controller.enqueue(Uint8Array.from(piece));
      controller.close();
    },
  });
  return new Response(body, { headers });
}

const pieces = [[1, 2], [3], [4, 5, 6]];

test("pieces stand one after another", async () => {
  for (const headers of [{ "content-length": "6" }, {}, { "content-length": "2", "content-encoding": "x" }] as Record<string, string>[]) {
    const bytes = await bytesOf(answer(pieces, headers));
    assert.deepEqual([...new Uint8Array(bytes)], [1, 2, 3, 4, 5, 6]);
  }
});

test("an answer that breaks off, or goes on, is none", async () => {
  await assert.rejects(bytesOf(answer(pieces, { "content-length": "7" })), /6 bytes came instead of 7/);
  await assert.rejects(bytesOf(answer(pieces, { "content-length": "5" })), /more than the 5 bytes/);
});
