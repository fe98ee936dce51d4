// The page: its parts, and what each action does.
import type { Action } from "./core/keys.ts";
import { actionOf } from "./core/keys.ts";
import { viewFragment } from "./core/link.ts";
import { element } from "./core/dom.ts";
import type { GraphNode, Shown, Span } from "./core/protocol.ts";
import type { DrawerSize, DrawerTab, PictureOptions } from "./core/settings.ts";
import type { Store } from "./core/store.ts";
import { formatBytes, formatTime } from "./core/units.ts";
import { ChecksPanel } from "./panels/checks.ts";
import { DetailsPanel } from "./panels/details.ts";
import { commandEntries, type Entry, helpDialog, Palette } from "./panels/dialogs.ts";
import { Drawer, nextSize } from "./panels/drawer.ts";
import { GraphPanel } from "./panels/graph.ts";
import { Legend } from "./panels/legend.ts";
import { Banner, MessagesPanel } from "./panels/messages.ts";
import { ParametersPanel } from "./panels/parameters.ts";
import { ShareDialog } from "./panels/share.ts";
import { SourcePanel } from "./panels/source.ts";
import { StudyPanel } from "./panels/study.ts";
import { TablePanel } from "./panels/table.ts";
import { Topbar, choices } from "./panels/topbar.ts";
import { Viewbar } from "./panels/viewbar.ts";
import { Look } from "./look.ts";
import { Stage } from "./stage.ts";
import { ColourTool } from "./tools/colours.ts";
import { Faults } from "./tools/faults.ts";
import { PickTool } from "./tools/pick.ts";
import { PreviewTool } from "./tools/preview.ts";
import { SectionTool } from "./tools/section.ts";
import { savePage } from "./tools/save.ts";
import { captionLines, compose, download, pictureTexts } from "./tools/screenshot.ts";
import type { BufferSource, LoadTimes } from "./view/buffers.ts";

export class App {
  private readonly look: Look;
  private session: string | undefined;
  private readonly stage: Stage;
  private readonly topbar: Topbar;
  private readonly viewbar: Viewbar;
  private readonly drawer: Drawer;
  private readonly legend: Legend;
  private readonly parameters: ParametersPanel;
  private readonly graph: GraphPanel;
  private readonly details: DetailsPanel;
  private readonly source: SourcePanel;
  private readonly table: TablePanel;
  private readonly study: StudyPanel;
  private readonly messages: MessagesPanel;
  private readonly banner: Banner;
  private readonly help = helpDialog();
  private readonly faults: Faults;
  private readonly palette = new Palette();
  private readonly share: ShareDialog;
  private readonly colours: ColourTool | undefined;
  private readonly pick: PickTool | undefined;
  private section: SectionTool | undefined;
  private readonly preview: PreviewTool | undefined;

  constructor(
    private readonly store: Store,
    host: HTMLElement,
    address: URL,
    source: BufferSource,
  ) {
    const act = (action: Action): void => this.act(action);
    const show = (node: string, result?: string): void => this.show(node, result);
    const openSource = (node: GraphNode): void => this.openSource(node.span, node.line);
    this.stage = new Stage(store, act, source);
    this.faults = new Faults(source);
    const { viewer } = this.stage;
    this.colours = viewer ? new ColourTool(viewer, () => this.legend) : undefined;
    this.pick = viewer ? new PickTool(store, viewer, this.stage.readout) : undefined;
    this.legend = new Legend({
      range: (range) => this.colours?.hold(range) ?? false,
      map: (map) => this.colours?.chooseMap(map),
      lock: (locked) => this.lock(locked),
      release: () => this.colours?.release(),
    });
    this.stage.root.append(this.legend.root);
    this.viewbar = new Viewbar(act, (at) => this.look.moveSection(at));
    this.banner = new Banner(store);
    this.look = new Look(store, viewer, this.viewbar, this.banner);
    this.connectSection(source);
    this.look.onStandard = (view) => this.stage.still?.look(view);
    this.topbar = new Topbar(store, {
      act,
      show,
      colourBy: (field) => this.colourBy(field || undefined),
      messages: () => this.drawer.open("messages"),
    });
    this.parameters = new ParametersPanel(store, {
      get: () => this.look.preferences.live,
      set: (live) => this.look.setPreference({ live }),
    });
    this.preview = viewer ? new PreviewTool(store, viewer, this.parameters.root) : undefined;
    const checks = new ChecksPanel(store, (node) => this.show(node));
    this.details = new DetailsPanel(store, { show, openSource });
    this.graph = new GraphPanel(store, { show, openSource, describe: (node) => this.details.describe(node) });
    this.source = new SourcePanel(store);
    this.table = new TablePanel(store);
    this.study = new StudyPanel(store);
    this.messages = new MessagesPanel(store, (span, line) => this.openSource(span, line), show);
    const panels = {
      graph: element("div", { class: "graph-tab" }, this.graph.root, this.details.root),
      table: this.table.root,
      messages: this.messages.root,
      source: this.source.root,
      study: this.study.root,
    };
    this.share = new ShareDialog(store, { link: () => this.link(), save: () => savePage(address, store.get("shown")?.version ?? 0), picture: () => void this.screenshot(), options: this.pictureOptions });
    this.drawer = new Drawer(panels, (tab, size) => this.keepDrawer(tab, size), this.look.view.tab, this.look.view.drawer);
    const middle = element("div", { class: "middle" }, this.stage.root, this.viewbar.root, this.drawer.root);
    const rail = element("aside", { class: "rail" }, this.parameters.root, checks.root);
    host.append(element("div", { class: "page" }, this.topbar.root, this.banner.root, element("div", { class: "columns" }, rail, middle)), this.help, this.palette.root, this.share.root);
    this.listen();
  }

  private listen(): void {
    const { store } = this;
    document.addEventListener("keydown", (event) => this.key(event));
    // Wherever the key is let go, A comes back.
    for (const end of ["keyup", "blur"] as const) {
      window.addEventListener(end, (event) => {
        if (!(event instanceof KeyboardEvent) || event.key.toLowerCase() === "b") this.parameters.flip(false);
      });
    }
    window.addEventListener("hashchange", () => this.followLink());
    store.on("hello", ({ file, folder, session }) => this.greet(`${folder}/${file}`, session));
    store.on("coming", ({ positions }) => {
      if (!this.preview?.keeps()) this.stage.viewer?.expect(positions);
    });
    store.on("shown", (shown) => void this.showPicture(shown));
    this.study.onStudy = () => this.drawer.setCount("study", "•", false);
    this.messages.onCount = (errors, warnings) => {
      const text = [errors > 0 ? `✗ ${errors}` : "", warnings > 0 ? `⚠ ${warnings}` : ""].filter(Boolean).join(" ");
      this.drawer.setCount("messages", text, errors > 0);
    };
    let failing = false;
    store.on("diagnostics", ({ items }) => {
      const errors = items.some((item) => item.severity === "error");
      // Only when it begins: a panel that people turned away from stays away.
      if (errors && !failing) this.drawer.open("messages");
      failing = errors;
    });
    const { viewer } = this.stage;
    if (viewer) viewer.onPicture = (times) => this.finishPicture(times);
    const { pick, preview } = this;
    if (preview) {
      preview.onState = (state) => this.topbar.setPreview(state);
      preview.showResult = () => {
        const shown = store.get("shown");
        if (shown) void this.showPicture(shown);
      };
    }
    if (!pick) return;
    this.stage.root.append(pick.rectangle);
    pick.onBoxing = (boxing) => {
      if (boxing) this.banner.say("info", "Drag a rectangle over panels; Shift adds them, Esc leaves.");
      else this.banner.hide();
    };
    pick.onMeasuring = (measuring) => this.viewbar.press("measure", measuring);
    pick.onPanels = () => {
      this.section?.draw();
      this.look.change({ panels: pick.panels.state() });
      if (pick.panels.hidesSome) this.banner.say("info", "Some panels are hidden: Shift H shows all.");
    };
  }

  /** The section's plane, its handle and its cut. */
  private connectSection(source: BufferSource): void {
    const { viewer } = this.stage;
    if (!viewer) return;
    const tool = new SectionTool(this.store, viewer, source);
    this.stage.root.append(tool.handle);
    this.stage.onFollow = () => tool.follow();
    tool.onMove = (at) => this.look.moveSection(at);
    tool.onTold = (text, title) => this.viewbar.setCut(text, title);
    tool.isVisible = (panel) => this.pick?.panels.isVisible(panel) ?? true;
    this.look.onSection = (section) => tool.update(section);
    this.section = tool;
    if (this.pick) this.pick.onCut = (x, y, hit) => tool.placeAt(x, y, hit);
  }

  /** The first hello brings back how this graph was looked at; a later one only a new session. */
  private greet(graph: string, session: string): void {
    const again = this.session !== undefined;
    if (again && this.session !== session) this.banner.say("info", "tessgraph was started again; the page went on.");
    this.session = session;
    // To the server this is a page that has chosen nothing yet.
    if (again) this.restoreShown = true;
    if (!this.look.turnTo(graph)) return;
    const selection = this.look.takeLink();
    const { view } = this.look;
    this.restoreShown = view.node !== undefined;
    this.restoreColours();
    this.pick?.restorePanels(view.panels, selection);
    this.drawer.open(view.tab, view.drawer);
  }

  /** A link was opened in the page it leads to. */
  private followLink(): void {
    const selection = this.look.takeLink();
    if (!selection) return;
    const { view } = this.look;
    this.restoreColours();
    this.pick?.restorePanels(view.panels, selection);
    const shown = this.store.get("shown");
    if (view.node && (view.node.node !== shown?.node || view.node.result !== shown.result)) this.show(view.node.node, view.node.result);
    else if (shown) void this.showPicture(shown);
  }

  private restoreColours(): void {
    if (!this.colours) return;
    this.colours.wanted = this.look.view.field;
    this.colours.locked = this.look.view.locked;
  }

  private readonly pictureOptions = {
    get: (): PictureOptions => this.look.preferences.picture,
    set: (picture: PictureOptions): void => this.look.setPreference({ picture }),
  };

  /** The address of what is seen now. */
  private link(): string {
    this.look.save();
    const address = new URL(window.location.href);
    address.hash = viewFragment(this.look.view, this.pick?.selection ?? { panels: [] });
    return address.href;
  }

  /** After a reload, or when the connection came back, the server shows its own choice; ask once for ours. */
  private restoreShown = false;

  private show(node: string, result?: string): void {
    const known = this.store.get("document")?.nodes.find((n) => n.name === node);
    const main = result ?? known?.results.find((r) => r.main)?.name;
    this.store.send({ type: "show", node, ...(main === undefined ? {} : { result: main }) });
  }

  private async showPicture(shown: Shown): Promise<void> {
    const arrived = performance.now();
    // The hand at a slider sees what it does; the result comes when it lets go.
    if (this.preview?.keeps()) return;
    const before = this.look.view.node;
    if (this.restoreShown && before) {
      this.restoreShown = false;
      const exists = this.store.get("document")?.nodes.some((n) => n.name === before.node);
      if (exists && (before.node !== shown.node || before.result !== shown.result)) {
        this.show(before.node, before.result);
        return;
      }
    }
    this.restoreShown = false;
    if (before?.node !== shown.node || before.result !== shown.result) {
      // Other results have other panels; the first picture is of those kept.
      if (before) this.pick?.restorePanels(undefined);
      this.pick?.clear();
      this.look.change({ panels: this.pick?.panels.state(), node: { node: shown.node, result: shown.result } });
    }
    this.stage.describe(shown);
    if (!shown.mesh && !shown.empty && (shown.table || shown.report)) this.drawer.open("table");
    const { viewer, colours } = this.stage.viewer && this.colours ? { viewer: this.stage.viewer, colours: this.colours } : { viewer: undefined, colours: undefined };
    if (!viewer || !colours || (!shown.mesh && !shown.empty)) return;
    const field = colours.take(shown);
    this.topbar.setColours(colours.choices, colours.current);
    this.arrived = arrived;
    try {
      if (await viewer.show(shown, field)) this.preview?.end();
    } catch (error) {
      this.banner.say("error", `The picture could not be made: ${error instanceof Error ? error.message : String(error)}`);
    }
  }

  private arrived = 0;

  /** The new picture is with the graphics card: legend, pick and times follow. */
  private finishPicture(times: LoadTimes): void {
    const shown = this.store.get("shown");
    const { arrived } = this;
    this.colours?.apply();
    this.look.applySection();
    this.pick?.refresh(shown?.mesh?.faces ?? 0);
    const uploaded = performance.now();
    this.stage.viewer?.whenDrawn(() => {
      const now = performance.now();
      performance.clearMeasures("repaint");
      const detail = { ...times, draw: now - uploaded, version: shown?.version };
      performance.measure("repaint", { start: arrived, end: now, detail });
      this.stage.root.dataset["version"] = String(shown?.version ?? "");
      this.viewbar.setTimes(
        `drawn in ${formatTime(now - arrived)}`,
        `fetched ${formatBytes(times.bytes)} in ${formatTime(times.fetch)}, uploaded in ${formatTime(times.upload)}, drawn in ${formatTime(now - uploaded)}; ${formatBytes(this.stage.viewer?.bytes ?? 0)} on the graphics card`,
      );
    });
  }

  private key(event: KeyboardEvent): void {
    const target = event.target as HTMLElement;
    const action = actionOf(event);
    if (!action || document.querySelector("dialog[open]")) return;
    const typing = target.matches("input:not([type=range], [type=checkbox]), textarea");
    if (typing && action !== "cancel") return;
    // Space presses what is focused, and a list's letters choose in it.
    if (target.matches("button, summary, select, [role=button]") && event.key === " ") return;
    if (target.matches("select") && event.key.length === 1 && !event.ctrlKey) return;
    event.preventDefault();
    if (action === "flip" && event.repeat) return;
    this.act(action);
  }

  /** Does what a key, a button or a command names. */
  act(action: Action): void {
    this.actions[action]();
  }

  private readonly actions: Record<Action, () => void> = {
    fit: () => this.stage.viewer?.fit(),
    fit_selection: () => this.stage.viewer?.fit(this.pick?.points),
    front: () => this.look.from("front"),
    back: () => this.look.from("back"),
    right: () => this.look.from("right"),
    left: () => this.look.from("left"),
    top: () => this.look.from("top"),
    bottom: () => this.look.from("bottom"),
    projection: () => this.look.toggleProjection(),
    saved_view: () => this.look.fromSaved(),
    save_view: () => this.look.keepView(),
    navigation: () => this.look.nextProfile(),
    edges: () => this.look.nextEdges(),
    ghost: () => this.look.change({ ghost: !this.look.view.ghost }),
    grid: () => this.look.change({ grid: !this.look.view.grid }),
    directions: () => this.look.toggleDirections(),
    colour: () => this.colourBy(this.colours?.next()),
    lock_range: () => this.lock(!this.colours?.locked),
    section: () => this.look.nextSection(this.pick?.corners ?? []),
    section_flip: () => this.look.flipSection(),
    rectangle: () => this.pick?.toggleRectangle(),
    hide: () => this.pick?.hide(),
    isolate: () => this.pick?.isolate(),
    show_all: () => this.pick?.showAll(),
    measure: () => this.pick?.toggleMeasure(),
    screenshot: () => void this.screenshot(),
    next_output: () => this.stepOutput(1),
    previous_output: () => this.stepOutput(-1),
    previous_check: () => void this.stepCheck(-1),
    next_check: () => void this.stepCheck(1),
    flip: () => {
      if (!this.parameters.flip(true)) this.banner.say("info", "No parameter has a B: Shift-click on its reset dot keeps its value as B.");
    },
    undo: () => this.store.send({ type: "undo" }),
    redo: () => this.store.send({ type: "redo" }),
    run: () => this.store.send({ type: "run" }),
    share: () => this.share.open(),
    search: () => this.palette.open(this.searchEntries(), "Search nodes and parameters"),
    commands: () => this.palette.open([...commandEntries((a) => this.act(a)), ...this.searchEntries()], "Commands, nodes, parameters"),
    drawer: () => this.drawer.open(this.drawer.tab, nextSize(this.drawer.size)),
    theme: () => this.look.toggleTheme(),
    help: () => this.help.showModal(),
    cancel: () => this.cancel(),
  };

  private colourBy(field: string | undefined): void {
    const shown = this.store.get("shown");
    if (!this.colours || !shown) return;
    this.colours.wanted = field;
    this.look.change({ field });
    void this.showPicture(shown);
  }

  private lock(locked: boolean): void {
    if (!this.colours) return;
    this.colours.locked = locked;
    this.look.change({ locked });
    this.colours.apply();
  }

  private stepOutput(step: number): void {
    const graph = this.store.get("document");
    if (!graph) return;
    const list = choices(graph, undefined).map(({ value }) => value);
    const { node, result } = this.store.get("shown") ?? {};
    const index = list.indexOf(JSON.stringify([node, result]));
    const next = list[(index + step + list.length) % list.length];
    if (next === undefined) return;
    const [name = "", main = ""] = JSON.parse(next) as string[];
    this.show(name, main);
  }

  private failing = -1;

  /** Walks through the faces that failing checks mark on what is shown, or through the checks where none marks any. */
  private async stepCheck(step: number): Promise<void> {
    const shown = this.store.get("shown");
    const marked = await this.faults.marked(shown, this.store.get("checks"));
    if (marked && this.pick) {
      this.failing = (this.failing + step + marked.faces.length) % marked.faces.length;
      const face = marked.faces[this.failing] ?? 0;
      this.pick.goTo(face, marked.panelOf(face));
      this.banner.say("warning", `${marked.label}: ${this.failing + 1} of ${marked.faces.length} faces`);
      return;
    }
    const failing = (this.store.get("checks")?.items ?? []).filter((check) => check.ok === false);
    if (failing.length === 0) {
      this.banner.say("info", "No check fails.");
      return;
    }
    this.failing = (this.failing + step + failing.length) % failing.length;
    const check = failing[this.failing];
    if (!check) return;
    this.show(check.node);
    this.banner.say("warning", `${check.node}: ${check.sentence}`);
  }

  private searchEntries(): Entry[] {
    const graph = this.store.get("document");
    const nodes = (graph?.nodes ?? []).map((node) => ({
      label: node.name,
      hint: node.kind,
      run: () => {
        this.drawer.open("graph");
        this.show(node.name);
        this.details.describe(node.name);
        this.graph.focus(node.name);
      },
    }));
    const parameters = (graph?.parameters ?? []).map((p) => ({ label: p.name, hint: "parameter", run: () => this.parameters.focus(p.name) }));
    const fields = (this.colours?.choices ?? []).map(({ name, label }) => ({ label: `Colour by ${label}`, hint: "field", run: () => this.colourBy(name) }));
    return [...parameters, ...nodes, ...fields];
  }

  private async screenshot(): Promise<void> {
    const { viewer } = this.stage;
    if (!viewer) return;
    const { store } = this;
    const shown = store.get("shown");
    const { theme, picture } = this.look.preferences;
    const of = [store.get("hello"), store.get("document"), shown] as const;
    const blob = await compose(viewer.picture(picture.scale, picture.transparent), captionLines(...of), pictureTexts(...of), theme, picture);
    if (blob) download(blob, `${(store.get("hello")?.file ?? "tessgraph").replace(/\.ron$/, "")}_${shown?.node ?? "view"}.png`);
  }

  private cancel(): void {
    if (this.pick?.cancel()) return;
    if (this.store.get("status")?.state === "computing") this.store.send({ type: "cancel" });
    else this.banner.hide();
  }

  private openSource(span: Span, line: number): void {
    this.drawer.open("source");
    this.source.reveal(span, line);
  }

  private keepDrawer(tab: DrawerTab, drawer: DrawerSize): void {
    this.look.change({ tab, drawer });
    if (tab === "source") this.source.refresh();
    if (tab === "table") this.table.refresh();
    if (tab === "study") this.study.refresh();
  }
}
