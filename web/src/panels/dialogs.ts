// The sheet of keys and the list of commands.
import { element, setText } from "../core/dom.ts";
import { type Action, GROUPS, KEYS, keyLabel } from "../core/keys.ts";
import type { Amount } from "../core/protocol.ts";

/** The sheet of all keys, made from their table. */
export function helpDialog(): HTMLDialogElement {
  const close = element("button", { type: "submit", class: "icon", "aria-label": "Close" }, "×");
  const groups = GROUPS.map((group) =>
    element(
      "section",
      {},
      element("h3", {}, group),
      element("dl", {}, ...KEYS.filter((b) => b.group === group).flatMap((b) => [element("dt", {}, ...b.keys.map((key) => element("kbd", {}, keyLabel(key)))), element("dd", {}, b.title)])),
    ),
  );
  const notes = element("p", { class: "hint" }, "The wheel zooms to the pointer. Dragging orbits about the point under it; Shift pans, Ctrl zooms. A click picks a face, a second one its nearest vertex. On a slider: arrows one step, Shift ten, Alt a tenth. Boxes take 120mm, 1/8 in, +10%.");
  return element("dialog", { class: "help", "aria-label": "Keys" }, element("form", { method: "dialog" }, element("h2", {}, "Keys"), close), element("div", { class: "groups" }, ...groups), notes);
}

export type Entry = { label: string; hint: string; run: () => void };

/** How well an entry fits what was typed: 0 is best, undefined not at all. */
export function rank(label: string, typed: string): number | undefined {
  const text = label.toLowerCase();
  const wanted = typed.trim().toLowerCase();
  if (wanted === "") return 0;
  const at = text.indexOf(wanted);
  if (at >= 0) return at === 0 ? 0 : /[\s_/.]/.test(text[at - 1] ?? "") ? 1 : 2;
  let from = 0;
  for (const letter of wanted.replaceAll(" ", "")) {
    from = text.indexOf(letter, from) + 1;
    if (from === 0) return undefined;
  }
  return 3;
}

const MOST_ENTRIES = 60;

export class Palette {
  readonly root = element("dialog", { class: "palette", "aria-label": "Search" });
  private readonly input = element("input", { type: "search", role: "combobox", "aria-expanded": "true", "aria-controls": "palette-list", autocomplete: "off" });
  private readonly list = element("ul", { id: "palette-list", role: "listbox" });
  private entries: Entry[] = [];
  private found: Entry[] = [];
  private current = 0;

  constructor() {
    this.root.append(this.input, this.list);
    this.input.addEventListener("input", () => this.filter());
    this.input.addEventListener("keydown", (event) => this.key(event));
    this.root.addEventListener("click", (event) => {
      if (event.target === this.root) this.root.close();
    });
  }

  open(entries: Entry[], placeholder: string): void {
    this.entries = entries;
    this.input.placeholder = placeholder;
    this.input.value = "";
    this.root.showModal();
    this.filter();
  }

  private filter(): void {
    const ranked = this.entries.flatMap((entry) => {
      const r = rank(entry.label, this.input.value);
      return r === undefined ? [] : [{ entry, r }];
    });
    ranked.sort((a, b) => a.r - b.r);
    this.found = ranked.slice(0, MOST_ENTRIES).map(({ entry }) => entry);
    this.current = 0;
    this.draw();
  }

  private draw(): void {
    const items = this.found.map((entry, i) => {
      const item = element("li", { role: "option", id: `entry-${i}`, "aria-selected": i === this.current }, element("span", {}, entry.label), element("span", { class: "hint" }, entry.hint));
      item.setAttribute("aria-selected", String(i === this.current));
      item.addEventListener("click", () => this.choose(i));
      return item;
    });
    if (items.length === 0) items.push(element("li", { class: "hint" }, "Nothing of that name"));
    this.list.replaceChildren(...items);
    this.input.setAttribute("aria-activedescendant", `entry-${this.current}`);
    items[this.current]?.scrollIntoView({ block: "nearest" });
  }

  private key(event: KeyboardEvent): void {
    const step = event.key === "ArrowDown" ? 1 : event.key === "ArrowUp" ? -1 : 0;
    if (step !== 0 && this.found.length > 0) {
      event.preventDefault();
      this.current = (this.current + step + this.found.length) % this.found.length;
      this.draw();
    }
    if (event.key === "Enter") {
      event.preventDefault();
      this.choose(this.current);
    }
  }

  private choose(index: number): void {
    this.root.close();
    this.found[index]?.run();
  }
}

/** What can be done, as entries of the command list. */
export function commandEntries(act: (action: Action) => void): Entry[] {
  return KEYS.map(({ action, title, keys }) => ({ label: title, hint: keys.map(keyLabel).join(", "), run: () => act(action) }));
}

function valueNode(value: string | Amount): HTMLElement {
  const { text, exact } = typeof value === "string" ? { text: value, exact: value } : value;
  return element("dd", { title: exact === text ? undefined : exact }, text);
}

/** The readout of a pick or a measurement at the bottom of the picture. */
export class Readout {
  readonly root = element("div", { class: "readout", role: "status", hidden: true });
  private readonly title = element("strong", {});
  private readonly list = element("dl", {});

  constructor() {
    this.root.append(this.title, this.list);
  }

  /** Numbers have their exact values as tooltips. */
  show(title: string, lines: [string, string | Amount][]): void {
    setText(this.title, title);
    // Many lines stand in two columns: the model is not to be covered.
    this.list.classList.toggle("wide", lines.length > 7);
    this.list.replaceChildren(...lines.flatMap(([label, value]) => [element("dt", {}, label), valueNode(value)]));
    this.root.hidden = false;
  }

  hide(): void {
    this.root.hidden = true;
  }
}
