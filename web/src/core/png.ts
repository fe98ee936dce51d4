// Texts inside a PNG: what a picture is of travels with it (chunk iTXt of the
// standard, so that names of every script are kept).

const SIGNATURE = 8;
/** Length, name and checksum of a chunk, and the 13 bytes of the first one. */
const FIRST_CHUNK = 12 + 13;

const TABLE = Uint32Array.from({ length: 256 }, (_, n) => {
  let c = n;
  for (let k = 0; k < 8; k += 1) c = c & 1 ? 0xedb88320 ^ (c >>> 1) : c >>> 1;
  return c;
});

/** The checksum of chunks: CRC-32 of ISO 3309. */
export function crc32(bytes: Uint8Array): number {
  let c = 0xffffffff;
  for (const byte of bytes) c = (TABLE[(c ^ byte) & 255] ?? 0) ^ (c >>> 8);
  return (c ^ 0xffffffff) >>> 0;
}

function textChunk(keyword: string, text: string): Uint8Array {
  // Keyword, no compression, no language, no translated keyword, the text.
  const body = new TextEncoder().encode(`iTXt${keyword}\0\0\0\0\0${text}`);
  const chunk = new Uint8Array(body.length + 8);
  const view = new DataView(chunk.buffer);
  view.setUint32(0, body.length - 4);
  chunk.set(body, 4);
  view.setUint32(body.length + 4, crc32(body));
  return chunk;
}

/** Puts texts, each with its keyword, behind the head of a PNG. */
export function withTexts(png: Uint8Array, texts: [keyword: string, text: string][]): Uint8Array<ArrayBuffer> {
  const chunks = texts.map(([keyword, text]) => textChunk(keyword, text));
  const place = SIGNATURE + FIRST_CHUNK;
  const whole = new Uint8Array(png.length + chunks.reduce((sum, chunk) => sum + chunk.length, 0));
  whole.set(png.subarray(0, place));
  let at = place;
  for (const chunk of chunks) {
    whole.set(chunk, at);
    at += chunk.length;
  }
  whole.set(png.subarray(place), at);
  return whole;
}
