// The content of an answer of the server.

/**
 * All bytes of an answer, written where they belong as they come. Browsers that
 * gather them for `arrayBuffer()` copy them once more at the end: twice the time for
 * the positions of a million vertices.
 *
 * Throws where fewer or more come than were announced.
 */
export async function bytesOf(response: Response): Promise<ArrayBuffer> {
  const announced = response.headers.get("content-length");
  // What is packed has another length when it is unpacked.
  if (announced === null || response.headers.has("content-encoding") || !response.body) return response.arrayBuffer();
  const content = new Uint8Array(Number(announced));
  const reader = response.body.getReader();
  let count = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    if (count + value.length > content.length) throw new Error(`more than the ${announced} bytes that were announced`);
    content.set(value, count);
    count += value.length;
  }
  if (count < content.length) throw new Error(`${count} bytes came instead of ${announced}`);
  return content.buffer;
}
