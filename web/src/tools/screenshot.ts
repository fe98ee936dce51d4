// A picture to keep: what is seen, with the parameters it was made from under it
// and in it.
import { withTexts } from "../core/png.ts";
import type { Document, Hello, Shown } from "../core/protocol.ts";
import type { PictureOptions } from "../core/settings.ts";
import { valueText } from "../panels/checks.ts";
import type { ThemeName } from "../view/theme.ts";

/** Lines under a picture: what it shows and each parameter with its value. */
export function captionLines(hello: Hello | undefined, graph: Document | undefined, shown: Shown | undefined): string[] {
  const what = [hello?.file ?? "tessgraph", shown ? shown.node : ""].filter(Boolean).join(" · ");
  const values = (graph?.parameters ?? []).map((p) => `${p.name} ${valueText({ value: p.value, unit: p.unit })}`);
  return [what, ...values];
}

/** What a picture says of itself, as `tessgraph render` writes it too: parameters with all digits, in the file's units. */
export function pictureTexts(hello: Hello | undefined, graph: Document | undefined, shown: Shown | undefined): [string, string][] {
  const [title = "tessgraph"] = captionLines(hello, undefined, shown);
  const parameters = (graph?.parameters ?? []).map((p) => `${p.name} = ${String(p.value)}`);
  const texts: [string, string][] = [["Software", `tessgraph ${hello?.version ?? ""}`.trim()], ["Title", title]];
  if (parameters.length > 0) texts.push(["Parameters", parameters.join("\n")]);
  return texts;
}

/** Puts words together into lines no wider than `most`. */
export function wrap(parts: string[], separator: string, most: number, width: (text: string) => number): string[] {
  const lines: string[] = [];
  for (const part of parts) {
    const last = lines.at(-1);
    const joined = last === undefined ? part : `${last}${separator}${part}`;
    if (last !== undefined && width(joined) <= most) lines[lines.length - 1] = joined;
    else lines.push(part);
  }
  return lines;
}

/** The picture with its caption and texts as a PNG; a transparent one stays so around the model. */
export async function compose(picture: HTMLCanvasElement, caption: string[], texts: [string, string][], theme: ThemeName, { scale, transparent }: PictureOptions): Promise<Blob | undefined> {
  const canvas = document.createElement("canvas");
  const context = canvas.getContext("2d");
  if (!context) return undefined;
  const size = 13 * scale;
  const pad = 10 * scale;
  const [title = "", ...values] = caption;
  context.font = `${size}px sans-serif`;
  const lines = wrap(values, "   ", picture.width - 2 * pad, (text) => context.measureText(text).width);
  canvas.width = picture.width;
  canvas.height = picture.height + 2 * pad + (lines.length + 1) * size * 1.5;
  context.fillStyle = theme === "dark" ? "#1b1e22" : "#ffffff";
  const top = transparent ? picture.height : 0;
  context.fillRect(0, top, canvas.width, canvas.height - top);
  context.drawImage(picture, 0, 0);
  context.fillStyle = theme === "dark" ? "#e6e8eb" : "#1d2025";
  context.textBaseline = "top";
  context.font = `600 ${size}px sans-serif`;
  context.fillText(title, pad, picture.height + pad);
  context.font = `${size}px sans-serif`;
  lines.forEach((line, i) => context.fillText(line, pad, picture.height + pad + (i + 1) * size * 1.5));
  const blob = await new Promise<Blob | null>((resolve) => canvas.toBlob(resolve, "image/png"));
  if (!blob) return undefined;
  const bytes = withTexts(new Uint8Array(await blob.arrayBuffer()), texts);
  return new Blob([bytes], { type: "image/png" });
}

/** Offers a file to be saved. */
export function download(blob: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
