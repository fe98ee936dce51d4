// What a click means, by what was picked before.

export type Level = "panel" | "face" | "vertex";
export type Picked = { face: number; panel: number; vertex: number; level: Level };

/** What the next click means: a panel first, then its face, then the vertex nearest to the pointer. */
export function nextPick(before: Picked | undefined, hit: Omit<Picked, "level">, hasPanels: boolean): Picked {
  const { face, panel, vertex } = hit;
  const first: Level = hasPanels ? "panel" : "face";
  const inside = before !== undefined && before.panel === panel;
  if (!inside || before.level === "vertex") return { face, panel, vertex, level: first };
  if (before.level === "panel") return { face, panel, vertex, level: "face" };
  return { face, panel, vertex, level: before.face === face ? "vertex" : "face" };
}
