// The parameters of the graph: slider, box, unit and reset for each.
import { Alternatives } from "../core/alternatives.ts";
import { button, element, setHidden, setText } from "../core/dom.ts";
import type { Document, Parameter } from "../core/protocol.ts";
import { isReadOnly, type Store } from "../core/store.ts";
import { isLive, type Live } from "../core/throttle.ts";
import { type Row, makeRow } from "./parameter_row.ts";

/** More parameters than this get a search box and groups that fold. */
export const MANY = 20;

export type ParameterGroup = { title: string; names: string[] };

/**
 * Groups by the first word of a name, in file order: `roof_width` and `roof_height`
 * are "roof". Words of one name only go together under "other".
 */
export function groupParameters(names: string[]): ParameterGroup[] {
  const counts = new Map<string, number>();
  const word = (name: string): string => name.split("_")[0] ?? name;
  for (const name of names) counts.set(word(name), (counts.get(word(name)) ?? 0) + 1);
  const groups = new Map<string, string[]>();
  for (const name of names) {
    const title = (counts.get(word(name)) ?? 0) > 1 ? word(name) : "other";
    groups.set(title, [...(groups.get(title) ?? []), name]);
  }
  return [...groups].map(([title, members]) => ({ title, names: members }));
}

export class ParametersPanel {
  readonly root = element("section", { class: "panel parameters", "aria-label": "Parameters" });
  private readonly list = element("div", { class: "parameter-list" });
  private readonly search = element("input", { type: "search", placeholder: "Search parameters", "aria-label": "Search parameters" });
  private readonly undo: HTMLButtonElement;
  private readonly redo: HTMLButtonElement;
  private readonly alternatives: Alternatives;
  private rows = new Map<string, Row>();
  private shape = "";

  constructor(
    private readonly store: Store,
    live: { get(): Live; set(live: Live): void },
  ) {
    this.undo = button("↶", "Take back the last edit made here (Ctrl Z)", () => store.send({ type: "undo" }), { class: "icon" });
    this.redo = button("↷", "Make it again (Ctrl Shift Z)", () => store.send({ type: "redo" }), { class: "icon" });
    this.alternatives = new Alternatives((message) => store.send(message));
    this.alternatives.onChange = () => {
      const document = store.get("document");
      if (document) this.update(document);
    };
    const { select, tell } = liveSwitch(live);
    store.on("status", ({ ms }) => tell(ms));
    const header = element("header", {}, element("h2", {}, "Parameters"), select, this.undo, this.redo);
    this.search.addEventListener("input", () => this.filter());
    this.root.append(header, this.search, this.list);
    this.live = live.get;
    store.on("document", (document) => this.update(document));
    for (const type of ["hello", "access"] as const) {
      store.on(type, () => {
        const document = store.get("document");
        if (document) this.update(document);
      });
    }
    store.onLink((link) => this.root.toggleAttribute("inert", link !== "open" && link !== "offline"));
  }

  private readonly live: () => Live;

  private update(document: Document): void {
    const { parameters } = document;
    const readOnly = isReadOnly(this.store);
    this.undo.disabled = !document.can_undo || readOnly;
    this.redo.disabled = !document.can_redo || readOnly;
    const shape = JSON.stringify(parameters.map((p) => [p.name, p.kind, p.of, p.unit]));
    if (shape !== this.shape) {
      this.shape = shape;
      this.build(parameters);
    }
    for (const parameter of parameters) this.rows.get(parameter.name)?.update(parameter, readOnly);
  }

  private build(parameters: Parameter[]): void {
    this.rows = new Map(parameters.map((p) => [p.name, makeRow(p, this.store, this.live, this.alternatives)]));
    const many = parameters.length > MANY;
    setHidden(this.search, !many);
    if (parameters.length === 0) {
      this.list.replaceChildren(element("p", { class: "hint" }, "This graph has no parameters. Name one under `params` and it gets a slider here."));
      return;
    }
    const rowsOf = (names: string[]): HTMLElement[] => names.flatMap((name) => this.rows.get(name)?.root ?? []);
    const names = parameters.map((p) => p.name);
    if (!many) {
      this.list.replaceChildren(...rowsOf(names));
      return;
    }
    this.list.replaceChildren(
      ...groupParameters(names).map(({ title, names: members }, index) =>
        element("details", { class: "group", open: index === 0 }, element("summary", {}, `${title} (${members.length})`), ...rowsOf(members)),
      ),
    );
    this.filter();
  }

  private filter(): void {
    const wanted = this.search.hidden ? "" : this.search.value.trim().toLowerCase();
    for (const [name, row] of this.rows) {
      setHidden(row.root, wanted !== "" && !`${name} ${row.about}`.toLowerCase().includes(wanted));
    }
    for (const group of this.list.querySelectorAll("details")) {
      const some = [...group.querySelectorAll<HTMLElement>(".parameter")].some((row) => !row.hidden);
      setHidden(group, !some);
      if (wanted !== "" && some) group.open = true;
    }
  }

  /** Shows the values kept as B, or those of the file again; says whether any are kept. */
  flip(toB: boolean): boolean {
    if (isReadOnly(this.store)) return false;
    return this.alternatives.flip(toB, this.store.get("document")?.parameters ?? []);
  }

  /** Puts the keyboard on a parameter. */
  focus(name: string): void {
    const row = this.rows.get(name);
    row?.root.closest("details")?.setAttribute("open", "");
    row?.root.scrollIntoView({ block: "nearest" });
    row?.root.querySelector<HTMLElement>("input, select")?.focus();
  }
}

type LiveSwitch = { select: HTMLElement; tell(lastRunMs: number | undefined): void };

/** When a moved slider is evaluated; "auto" says which of both it is now. */
function liveSwitch(live: { get(): Live; set(live: Live): void }): LiveSwitch {
  const labels: [Live, string][] = [
    ["auto", "live: auto"],
    ["always", "live: always"],
    ["release", "on release"],
  ];
  const select = element("select", {
    class: "small",
    "aria-label": "When a moved slider is evaluated",
    title: "When a moved slider is evaluated. Auto: while it moves if the last run took less than 0.3 s, else on release",
  });
  const options = labels.map(([value, label]) => element("option", { value, selected: live.get() === value }, label));
  select.append(...options);
  select.addEventListener("change", () => live.set(select.value as Live));
  const tell = (lastRunMs: number | undefined): void => {
    const [auto] = options;
    if (auto && lastRunMs !== undefined) setText(auto, isLive("auto", lastRunMs) ? "auto: live" : "auto: on release");
  };
  return { select, tell };
}
