// Reference pages of nodes: the little Markdown they use, as blocks of plain text.

export type Block =
  | { kind: "heading"; text: string }
  | { kind: "paragraph"; text: string }
  | { kind: "item"; text: string }
  | { kind: "code"; text: string }
  | { kind: "row"; cells: string[]; head: boolean };

/** Reads headings, paragraphs, list items, tables and fenced code; everything else is a paragraph. */
export function blocks(markdown: string): Block[] {
  const list: Block[] = [];
  let paragraph: string[] = [];
  let code: string[] | undefined;
  const flush = (): void => {
    if (paragraph.length > 0) list.push({ kind: "paragraph", text: paragraph.join(" ") });
    paragraph = [];
  };
  for (const line of markdown.split("\n")) {
    if (line.startsWith("```")) {
      flush();
      if (code) list.push({ kind: "code", text: code.join("\n") });
      code = code ? undefined : [];
    } else if (code) {
      code.push(line);
    } else if (/^#+ /.test(line)) {
      flush();
      list.push({ kind: "heading", text: line.replace(/^#+ /, "") });
    } else if (/^\s*[-*] /.test(line)) {
      flush();
      list.push({ kind: "item", text: line.replace(/^\s*[-*] /, "") });
    } else if (/^\|/.test(line)) {
      flush();
      if (/^\|[\s:|-]+$/.test(line)) {
        const previous = list.at(-1);
        if (previous?.kind === "row") previous.head = true;
      } else {
        const cells = line.replaceAll("\\|", "\u0000").split("|").slice(1, -1);
        list.push({ kind: "row", cells: cells.map((cell) => cell.replaceAll("\u0000", "|").trim()), head: false });
      }
    } else if (line.trim() === "") {
      flush();
    } else {
      paragraph.push(line.trim());
    }
  }
  flush();
  if (code) list.push({ kind: "code", text: code.join("\n") });
  return list;
}

/** Splits a line at its code spans: odd parts are code. */
export function spans(text: string): string[] {
  return text.replace(/\[([^\]]*)\]\([^)]*\)/g, "$1").replaceAll("**", "").split("`");
}
