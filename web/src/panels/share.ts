// Sharing: a link to this view, a page that needs no server, and devices in the
// same network.
import qrcode from "qrcode-generator";
import { button, element, setHidden, setText, svg } from "../core/dom.ts";
import { tooltip } from "../core/keys.ts";
import { PICTURE_SCALES, type PictureOptions } from "../core/settings.ts";
import type { Pairing, Shares } from "../core/protocol.ts";
import type { Store } from "../core/store.ts";
import { formatBytes } from "../core/units.ts";
import { download } from "../tools/screenshot.ts";

/** How often the list of devices is asked for while it is seen. */
const REFRESH_MS = 2000;

/** Whether another device could open an address: none that means "this machine". */
export function isReachable(address: string): boolean {
  const host = new URL(address).hostname;
  return !(host === "localhost" || host.endsWith(".localhost") || host.startsWith("127.") || host === "[::1]" || host === "0.0.0.0" || host === "[::]");
}

/** Rows of a QR code, true where it is dark. */
export function qrModules(text: string): boolean[][] {
  const code = qrcode(0, "M");
  code.addData(text);
  code.make();
  const count = code.getModuleCount();
  return Array.from({ length: count }, (_, row) => Array.from({ length: count }, (_unused, column) => code.isDark(row, column)));
}

/** A picture of a QR code, dark on light in every theme, with the margin readers need. */
function qrPicture(text: string): SVGElement {
  const modules = qrModules(text);
  const path = modules.flatMap((row, y) => row.flatMap((dark, x) => (dark ? [`M${x + 4} ${y + 4}h1v1h-1z`] : []))).join("");
  const size = modules.length + 8;
  return svg("svg", { viewBox: `0 0 ${size} ${size}`, class: "qr", role: "img", "aria-label": "QR code of the address", "shape-rendering": "crispEdges" }, svg("rect", { width: size, height: size, fill: "#fff" }), svg("path", { d: path, fill: "#000" }));
}

export type ShareEvents = {
  /** Saves a picture as the options say. */
  picture(): void;
  options: { get(): PictureOptions; set(options: PictureOptions): void };
  /** The address of this view. */
  link(): string;
  /** Fetches the page that needs no server, or says why there is none. */
  save(): Promise<{ page: Blob } | { refusal: string }>;
};

export class ShareDialog {
  readonly root = element("dialog", { class: "share-dialog", "aria-label": "Share" });
  private readonly address = element("input", { type: "text", readonly: true, "aria-label": "Address of this view" });
  private readonly copied = element("span", { role: "status", class: "hint" });
  private readonly saved = element("span", { role: "status", class: "hint" });
  private readonly save: HTMLButtonElement;
  private readonly phone = element("section", {});
  private timer: ReturnType<typeof setInterval> | undefined;
  private drawn = "";

  /** Devices whose codes are to be seen. */
  private readonly unveiled = new Set<number>();

  constructor(
    private readonly store: Store,
    private readonly events: ShareEvents,
  ) {
    const close = element("button", { type: "submit", class: "icon", "aria-label": "Close" }, "×");
    this.save = button("Save offline page", "Save one file that shows this model without tessgraph", () => void this.savePage());
    const link = element(
      "section",
      {},
      element("h3", {}, "Link to this view"),
      element("p", { class: "hint" }, "Camera, section, colours and what is picked; it opens on this machine while tessgraph view runs."),
      element("div", { class: "line" }, this.address, button("Copy link", "Copy the address of this view", () => this.copy())),
      this.copied,
    );
    const page = element("section", {}, element("h3", {}, "Offline page"), element("p", { class: "hint" }, "One HTML file with the model in it, to look at anywhere; parameters are text, nothing is computed."), this.save, " ", this.saved);
    this.root.append(element("form", { method: "dialog" }, element("h2", {}, "Share"), close), link, this.picture(), page, this.phone);
    this.root.addEventListener("close", () => clearInterval(this.timer));
    store.on("shares", (shares) => this.update(shares));
  }

  open(): void {
    this.address.value = this.events.link();
    setText(this.copied, "");
    setText(this.saved, "");
    const isOwner = this.store.get("access") === undefined;
    const { link } = this.store;
    setHidden(this.phone, !isOwner || link === "offline");
    this.save.disabled = link !== "open";
    this.root.showModal();
    if (!isOwner || link === "offline") return;
    const ask = (): void => this.store.send({ type: "shares" });
    ask();
    clearInterval(this.timer);
    this.timer = setInterval(ask, REFRESH_MS);
  }

  private picture(): HTMLElement {
    const { options } = this.events;
    const scale = element("select", { "aria-label": "Sharpness" }, ...PICTURE_SCALES.map((times) => element("option", { value: times, selected: times === options.get().scale }, `${times}×`)));
    const clear = element("input", { type: "checkbox" });
    clear.checked = options.get().transparent;
    const take = (): void => options.set({ scale: Number(scale.value), transparent: clear.checked });
    for (const node of [scale, clear]) node.addEventListener("change", take);
    const save = button("Save picture", tooltip("screenshot"), () => this.events.picture());
    return element(
      "section",
      {},
      element("h3", {}, "Picture"),
      element("p", { class: "hint" }, "A PNG of what is seen, with the parameters under it and in it."),
      element("div", { class: "line" }, scale, element("label", {}, clear, " transparent"), save),
    );
  }

  private copy(): void {
    const done = (): void => setText(this.copied, "Copied.");
    const byHand = (): void => {
      this.address.select();
      setText(this.copied, document.execCommand("copy") ? "Copied." : "Select it and copy it.");
    };
    // Browsers give the clipboard only to pages of this machine or over https.
    if (navigator.clipboard) navigator.clipboard.writeText(this.address.value).then(done, byHand);
    else byHand();
  }

  private async savePage(): Promise<void> {
    setText(this.saved, "Packing…");
    const made = await this.events.save();
    if ("refusal" in made) {
      setText(this.saved, made.refusal);
      return;
    }
    const name = (this.store.get("hello")?.file ?? "tessgraph").replace(/\.ron$/, "");
    download(made.page, `${name}.html`);
    setText(this.saved, `Saved: ${formatBytes(made.page.size)}.`);
  }

  private update(shares: Shares): void {
    const text = JSON.stringify(shares);
    if (text === this.drawn) return;
    this.drawn = text;
    const { lan } = shares;
    const head = element("h3", {}, "Phone, or another machine");
    if (!lan || !isReachable(lan.address)) {
      const file = this.store.get("hello")?.file ?? "GRAPH";
      this.phone.replaceChildren(head, element("p", { class: "hint" }, "Others in your network can look once it is started with ", element("code", {}, `tessgraph view --lan ${file}`), "."));
      return;
    }
    const may = lan.edit ? "look and change parameters" : "only look";
    this.phone.replaceChildren(
      head,
      element("p", { class: "hint" }, `Devices in your network can ${may}, at ${lan.address}, each by an address of its own until you take it back or end tessgraph. The connection is not encrypted.`),
      button("Pair a device", `Make an address at ${lan.address} for another device`, () => this.store.send({ type: "pair" })),
      element("ul", { class: "pairings" }, ...shares.pairings.map((pairing) => this.pairing(pairing))),
    );
  }

  private pairing({ id, url, connected }: Pairing): HTMLElement {
    const open = element("span", { class: "hint" }, connected === 0 ? "nobody there" : connected === 1 ? "1 page open" : `${connected} pages open`);
    const revoke = button("Take back", `Close the address of device ${id}`, () => this.store.send({ type: "unpair", id }));
    const code = element("details", { class: "code", open: connected === 0 }, element("summary", {}, `Device ${id}`), this.veiled(id, url), element("input", { type: "text", readonly: true, value: url, "aria-label": `Address for device ${id}` }));
    return element("li", {}, code, element("div", { class: "line" }, open, revoke));
  }

  /** The code of an address, blurred until somebody wants it: whoever sees it may look. */
  private veiled(id: number, url: string): HTMLElement {
    const veil = button("", `Code for device ${id}`, () => {
      if (!this.unveiled.delete(id)) this.unveiled.add(id);
      show();
    });
    veil.classList.add("veil");
    veil.append(qrPicture(url));
    const show = (): void => veil.setAttribute("aria-pressed", String(this.unveiled.has(id)));
    show();
    return veil;
  }
}
