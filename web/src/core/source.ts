// Places in the graph's text: the server counts UTF-8 bytes, a page UTF-16 units.
import type { Span } from "./protocol.ts";

/** Turns byte offsets of a text into indices of its JavaScript string. */
export class Offsets {
  private readonly bytes: Uint8Array;

  constructor(text: string) {
    this.bytes = new TextEncoder().encode(text);
  }

  /** The string index at a byte offset; an offset beyond the end gives the end. */
  index(byte: number): number {
    const end = Math.min(Math.max(byte, 0), this.bytes.length);
    return new TextDecoder().decode(this.bytes.subarray(0, end)).length;
  }

  range(span: Span): [number, number] {
    return [this.index(span[0]), this.index(span[1])];
  }
}

export type Token = { text: string; kind: "comment" | "text" | "number" | "word" | "plain" };

const TOKEN = /(\/\/.*)|("(?:[^"\\]|\\.)*")|(-?\b\d+(?:\.\d+)?(?:[eE][+-]?\d+)?\b)|(\b[A-Za-z_]\w*\b)/g;

/** Splits one line of RON for colouring. */
export function tokens(line: string): Token[] {
  const kinds = ["comment", "text", "number", "word"] as const;
  const parts: Token[] = [];
  let end = 0;
  for (const match of line.matchAll(TOKEN)) {
    if (match.index > end) parts.push({ text: line.slice(end, match.index), kind: "plain" });
    const kind = kinds.find((_, k) => match[k + 1] !== undefined) ?? "plain";
    parts.push({ text: match[0], kind });
    end = match.index + match[0].length;
  }
  if (end < line.length) parts.push({ text: line.slice(end), kind: "plain" });
  return parts;
}
