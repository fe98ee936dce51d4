// The top bar: which file, in what state, what is shown and by what it is coloured.
import { button, element, setText } from "../core/dom.ts";
import { type Action, tooltip } from "../core/keys.ts";
import type { Document, Shown, Status } from "../core/protocol.ts";
import { isReadOnly, type Store } from "../core/store.ts";
import { formatCount } from "../core/units.ts";
import { chipOf, type Preview } from "./chip.ts";

const PREVIEW_TITLES = {
  exact: "Drawn from the component and the cells it stands in; the evaluated result takes its place when it is there",
  approximate: "Heights follow at once; what else depends on the parameter, as compensated directions, follows when it has been evaluated",
};

export type TopbarEvents = {
  act(action: Action): void;
  show(node: string, result: string): void;
  colourBy(field: string): void;
  messages(): void;
};

export class Topbar {
  readonly root = element("header", { class: "topbar" });
  private readonly file = element("h1", { class: "file" }, "tessgraph");
  private readonly chip = element("button", { type: "button", class: "chip" });
  private readonly chipText = element("span", { class: "chip-text" });
  private readonly chipSign = element("span", { class: "chip-sign", "aria-hidden": "true" });
  private readonly chipHint = element("span", { class: "chip-hint" });
  /** What a screen reader says: the state without the seconds that count up. */
  private readonly spoken = element("span", { role: "status", class: "spoken" });
  private readonly outputs = element("select", { "aria-label": "What is shown", title: tooltip("next_output") });
  private readonly counts = element("span", { class: "counts" });
  private readonly colours = element("select", { "aria-label": "Colour by", title: tooltip("colour") });
  private chipAct: (() => void) | undefined;
  private preview: Preview;
  private started: number | undefined;
  private lastMs: number | undefined;
  private timer: ReturnType<typeof setInterval> | undefined;

  constructor(
    private readonly store: Store,
    private readonly events: TopbarEvents,
  ) {
    this.chip.append(this.chipSign, this.chipText, this.chipHint);
    this.chip.addEventListener("click", () => this.chipAct?.());
    const live = element("span", { class: "chip-holder" }, this.chip, this.spoken);
    const small = (label: string, action: Action): HTMLButtonElement => button(label, tooltip(action), () => events.act(action), { class: "icon" });
    this.root.append(
      this.file,
      live,
      element("label", { class: "field" }, element("span", {}, "Show"), this.outputs),
      this.counts,
      element("span", { class: "spring" }),
      element("label", { class: "field" }, element("span", {}, "Colour"), this.colours),
      button("Share", tooltip("share"), () => events.act("share"), { class: "share-button" }),
      small("⌕", "search"),
      small("◐", "theme"),
      small("?", "help"),
    );
    this.outputs.addEventListener("change", () => {
      const [node = "", result = ""] = JSON.parse(this.outputs.value) as string[];
      events.show(node, result);
    });
    this.colours.addEventListener("change", () => events.colourBy(this.colours.value));
    store.on("hello", ({ file, folder }) => {
      setText(this.file, file);
      this.file.title = `${folder}/${file}`;
      document.title = `${file} · tessgraph`;
    });
    for (const type of ["hello", "access", "diagnostics"] as const) store.on(type, () => this.updateChip());
    store.on("status", (status) => {
      this.clock(status);
      this.updateChip();
    });
    store.onLink(() => this.updateChip());
    store.on("document", () => this.updateOutputs());
    store.on("shown", (shown) => {
      this.updateOutputs();
      this.updateCounts(shown);
    });
  }

  /** Times a run that is under way. */
  private clock(status: Status): void {
    if (status.state === "computing") {
      this.started ??= performance.now();
      this.timer ??= setInterval(() => this.updateChip(), 200);
      return;
    }
    if (status.ms !== undefined) this.lastMs = status.ms;
    clearInterval(this.timer);
    this.timer = undefined;
    this.started = undefined;
  }

  /** Whether the picture runs ahead of its evaluation. */
  setPreview(preview: Preview): void {
    if (preview === this.preview) return;
    this.preview = preview;
    this.updateChip();
  }

  private updateChip(): void {
    const { store } = this;
    const clocked = this.started === undefined ? undefined : { elapsed: performance.now() - this.started, last: this.lastMs };
    const chip = chipOf(store.link, isReadOnly(store), store.get("status"), store.get("diagnostics"), clocked, this.preview);
    this.chip.className = `chip ${chip.kind}`;
    setText(this.chipSign, chip.sign);
    setText(this.chipText, chip.text);
    const state = store.get("status")?.state === "computing" ? "Computing" : chip.text;
    setText(this.spoken, state);
    const cause = store.get("status")?.cause;
    this.chip.title = cause ? `${chip.text} · ${cause}` : chip.text;
    if (this.preview) this.chip.title = PREVIEW_TITLES[this.preview];
    const hints = { cancel: "Esc stops", messages: "see messages", run: "run again" };
    setText(this.chipHint, chip.act ? hints[chip.act] : "");
    this.chipAct = {
      cancel: () => store.send({ type: "cancel" }),
      messages: () => this.events.messages(),
      run: () => store.send({ type: "run" }),
      none: undefined,
    }[chip.act ?? "none"];
    this.chip.disabled = this.chipAct === undefined;
  }

  private updateOutputs(): void {
    const graph = this.store.get("document");
    const shown = this.store.get("shown");
    if (!graph) return;
    const options = choices(graph, shown);
    const current = shown ? JSON.stringify([shown.node, shown.result]) : "";
    const wanted = JSON.stringify([options, current]);
    if (this.outputs.dataset["of"] === wanted) return;
    this.outputs.dataset["of"] = wanted;
    this.outputs.replaceChildren(...options.map(({ value, label }) => element("option", { value, selected: value === current }, label)));
  }

  private updateCounts(shown: Shown): void {
    const { mesh } = shown;
    setText(this.counts, mesh ? `${formatCount(mesh.faces)} faces · ${formatCount(mesh.vertices)} vertices` : shown.kind);
  }

  /** The fields that can colour what is shown. */
  setColours(fields: { name: string; label: string }[], current: string | undefined): void {
    const options = [element("option", { value: "" }, "plain"), ...fields.map(({ name, label }) => element("option", { value: name }, label))];
    this.colours.replaceChildren(...options);
    this.colours.value = current ?? "";
    this.colours.disabled = fields.length === 0;
  }
}

/** Results to choose from: the file's outputs once each, and what is shown if it is none of them. */
export function choices(graph: Document, shown: Shown | undefined): { value: string; label: string }[] {
  const list = new Map<string, string>();
  const name = (node: string, result: string): string => {
    const results = graph.nodes.find((n) => n.name === node)?.results ?? [];
    const main = results.find((r) => r.name === result)?.main ?? true;
    return main ? node : `${node}.${result}`;
  };
  if (shown && !graph.outputs.some((o) => o.node === shown.node && o.result === shown.result)) {
    list.set(JSON.stringify([shown.node, shown.result]), `${name(shown.node, shown.result)} (${shown.kind})`);
  }
  for (const { node, result, kind } of graph.outputs) {
    list.set(JSON.stringify([node, result]), `${name(node, result)} (${kind})`);
  }
  return [...list].map(([value, label]) => ({ value, label }));
}
