// The one table of keys: from it come what keys do, tooltips, the help sheet,
// the command list and docs/keys.md.

export type Group = "View" | "Show" | "Measure" | "Graph" | "Page";

export type Binding = {
  action: string;
  /** As `KeyboardEvent` gives them: `code` for digits (so that the number row and pad agree), else `key`. */
  keys: string[];
  title: string;
  group: Group;
};

export const KEYS = [
  { action: "fit", keys: ["f"], title: "Fit the whole model", group: "View" },
  { action: "fit_selection", keys: ["z"], title: "Fit what is selected", group: "View" },
  { action: "front", keys: ["Digit1"], title: "Front view", group: "View" },
  { action: "back", keys: ["Shift+Digit1"], title: "Back view", group: "View" },
  { action: "right", keys: ["Digit3"], title: "Right view", group: "View" },
  { action: "left", keys: ["Shift+Digit3"], title: "Left view", group: "View" },
  { action: "top", keys: ["Digit7"], title: "Top view", group: "View" },
  { action: "bottom", keys: ["Shift+Digit7"], title: "Bottom view", group: "View" },
  { action: "projection", keys: ["Digit5"], title: "Orthographic or perspective", group: "View" },
  { action: "saved_view", keys: ["Digit0"], title: "Saved view, or the corner view", group: "View" },
  { action: "save_view", keys: ["Shift+Digit0"], title: "Save this view", group: "View" },
  { action: "navigation", keys: ["n"], title: "Next mouse profile: Rhino, Blender, trackpad", group: "View" },
  { action: "edges", keys: ["e"], title: "Edges: polygons, triangles, none", group: "Show" },
  { action: "ghost", keys: ["w"], title: "Ghost: see through the model", group: "Show" },
  { action: "grid", keys: ["g"], title: "Ground grid", group: "Show" },
  { action: "directions", keys: ["d"], title: "Directions as arrows", group: "Show" },
  { action: "colour", keys: ["c"], title: "Colour by the next field", group: "Show" },
  { action: "lock_range", keys: ["l"], title: "Lock the colour range", group: "Show" },
  { action: "section", keys: ["x"], title: "Section: across X, Y, Z, along the picked face, none", group: "Show" },
  { action: "section_flip", keys: ["Shift+x"], title: "Section: keep the other side", group: "Show" },
  { action: "rectangle", keys: ["r"], title: "Select by a rectangle (or drag with Alt)", group: "Show" },
  { action: "hide", keys: ["h"], title: "Hide the selected panels", group: "Show" },
  { action: "isolate", keys: ["i"], title: "Only the selected panels, or all again", group: "Show" },
  { action: "show_all", keys: ["Shift+h"], title: "Show all panels", group: "Show" },
  { action: "measure", keys: ["m"], title: "Measure between two picks", group: "Measure" },
  { action: "screenshot", keys: ["s"], title: "Save a picture with its parameters", group: "Measure" },
  { action: "next_output", keys: ["Space"], title: "Show the next output", group: "Graph" },
  { action: "previous_output", keys: ["Shift+Space"], title: "Show the output before", group: "Graph" },
  { action: "previous_check", keys: ["["], title: "Failing face before, or check", group: "Graph" },
  { action: "next_check", keys: ["]"], title: "Next failing face, or check", group: "Graph" },
  { action: "flip", keys: ["b"], title: "While held: the values kept as B (Shift-click on a reset dot keeps one)", group: "Graph" },
  { action: "undo", keys: ["Control+z"], title: "Take back the last edit made here", group: "Graph" },
  { action: "redo", keys: ["Control+Shift+z", "Control+y"], title: "Make it again", group: "Graph" },
  { action: "run", keys: ["Control+Enter"], title: "Run again", group: "Graph" },
  { action: "share", keys: ["Shift+s"], title: "Share: link, offline page, phone", group: "Page" },
  { action: "search", keys: ["/"], title: "Search nodes and parameters", group: "Page" },
  { action: "commands", keys: ["Control+k"], title: "All commands", group: "Page" },
  { action: "drawer", keys: ["q"], title: "Drawer: closed, part, full", group: "Page" },
  { action: "theme", keys: ["t"], title: "Dark or light", group: "Page" },
  { action: "help", keys: ["?"], title: "This sheet of keys", group: "Page" },
  { action: "cancel", keys: ["Escape"], title: "Leave the tool, then the pick, then stop the run", group: "Page" },
] as const satisfies readonly Binding[];

export type Action = (typeof KEYS)[number]["action"];

/** Groups in the order of the help sheet. */
export const GROUPS: Group[] = ["View", "Show", "Measure", "Graph", "Page"];

/** What of a keyboard event decides. */
export type Stroke = {
  key: string;
  code: string;
  ctrlKey: boolean;
  metaKey: boolean;
  shiftKey: boolean;
  altKey: boolean;
};

/** The table's names of a stroke, e.g. `Control+Shift+z`; Command counts as Control. */
export function strokeNames(stroke: Stroke): string[] {
  const code = stroke.code.replace("Numpad", "Digit");
  const control = stroke.ctrlKey || stroke.metaKey ? "Control+" : "";
  const shift = stroke.shiftKey ? "Shift+" : "";
  const key = stroke.key === " " ? "Space" : stroke.key.length === 1 ? stroke.key.toLowerCase() : stroke.key;
  const names = [`${control}${shift}${key}`];
  if (/^Digit\d$/.test(code)) names.push(`${control}${shift}${code}`);
  // A sign such as `?` may need Shift on one keyboard and none on another.
  if (stroke.key.length === 1 && !/[a-z0-9 ]/i.test(stroke.key)) names.push(`${control}${key}`);
  return names;
}

/** The action of a stroke, if there is one. */
export function actionOf(stroke: Stroke): Action | undefined {
  if (stroke.altKey) return undefined;
  const names = strokeNames(stroke);
  return KEYS.find((binding) => binding.keys.some((key) => names.includes(key)))?.action;
}

/** A key as people write it: `Ctrl Shift Z`. */
export function keyLabel(key: string): string {
  return key
    .split("+")
    .map((part) => {
      if (part === "Control") return "Ctrl";
      if (part === "Escape") return "Esc";
      const digit = part.replace("Digit", "");
      return digit.length === 1 ? digit.toUpperCase() : digit;
    })
    .join(" ");
}

/** Title and key of an action, for a tooltip. */
export function tooltip(action: Action): string {
  const binding = KEYS.find((b) => b.action === action);
  return binding ? `${binding.title} (${keyLabel(binding.keys[0] as string)})` : action;
}

/** The table as a page of the documentation. */
export function keysMarkdown(): string {
  const lines = ["# Keys of the live page", "", "Made from the page's own table by `npm run keys` in `web/`. Keys do nothing while you type in a box."];
  for (const group of GROUPS) {
    lines.push("", `## ${group}`, "", "| key | does |", "|---|---|");
    for (const binding of KEYS.filter((b) => b.group === group)) {
      lines.push(`| ${binding.keys.map((key) => `\`${keyLabel(key)}\``).join(" or ")} | ${binding.title} |`);
    }
  }
  return `${lines.join("\n")}\n`;
}
