// The content of an answer of the server.

/**
 * All bytes of an answer, written where they belong as they come: gathered pieces are
 * copied once more, which takes as long again for the positions of a million vertices.
 *
 * Throws where fewer or more come than were announced.
 */
export async function bytesOf(response: Response): Promise<ArrayBuffer> {
  const announced = response.headers.get("content-length");
  // What is packed has another length when it is unpacked.
  if (announced === null || response.headers.has("content-encoding") || !response.body) return response.arrayBuffer();
  const direct = directReader(response.body);
  return direct ? readInto(direct, Number(announced)) : gather(response.body.getReader(), Number(announced));
}

/** A reader that writes into our memory; older browsers have none. */
function directReader(body: ReadableStream<Uint8Array>): ReadableStreamBYOBReader | undefined {
  try {
    return body.getReader({ mode: "byob" });
  } catch {
    return undefined;
  }
}

async function readInto(reader: ReadableStreamBYOBReader, length: number): Promise<ArrayBuffer> {
  let content = new ArrayBuffer(length);
  let count = 0;
  while (count < length) {
    const { done, value } = await reader.read(new Uint8Array(content, count));
    if (value) content = value.buffer;
    if (done) throw tooFew(count, length);
    count += value.length;
  }
  // That no more come is told late, when the browser has put the connection away.
  return content;
}

async function gather(reader: ReadableStreamDefaultReader<Uint8Array>, length: number): Promise<ArrayBuffer> {
  const content = new Uint8Array(length);
  let count = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    if (count + value.length > length) throw tooMany(length);
    content.set(value, count);
    count += value.length;
  }
  if (count < length) throw tooFew(count, length);
  return content.buffer;
}

function tooFew(count: number, length: number): Error {
  return new Error(`${count} bytes came instead of ${length}`);
}

function tooMany(length: number): Error {
  return new Error(`more than the ${length} bytes that were announced`);
}
