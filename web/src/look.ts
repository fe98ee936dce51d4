// How the model is looked at: camera, theme, edges, section. Kept between pages;
// nothing here changes a result.
import { readFragment, type Selection } from "./core/link.ts";
import type { Vec3 } from "./core/protocol.ts";
import { nextSection, type Section } from "./core/section.ts";
import type { Store } from "./core/store.ts";
import { lengthUnit } from "./core/store.ts";
import {
  INITIAL_VIEW,
  type Preferences,
  type ViewState,
  loadPreferences,
  loadView,
  savePreferences,
  saveView,
} from "./core/settings.ts";
import type { Banner } from "./panels/messages.ts";
import type { Viewbar } from "./panels/viewbar.ts";
import { PROFILES, PROFILE_LABELS, type Profile, type StandardView } from "./view/camera.ts";
import type { EdgeMode } from "./view/surface.ts";
import type { Viewer } from "./view/viewer.ts";

const EDGE_MODES: EdgeMode[] = ["polygons", "triangles", "none"];

export class Look {
  readonly preferences: Preferences = loadPreferences();
  view: ViewState = { ...INITIAL_VIEW };
  private graph: string | undefined;

  constructor(
    private readonly store: Store,
    private readonly viewer: Viewer | undefined,
    private readonly viewbar: Viewbar,
    private readonly banner: Banner,
  ) {
    if (viewer) viewer.onMoved = () => this.save();
    window.addEventListener("pagehide", () => this.save());
    this.applyPreferences();
  }

  /** Brings back how a graph was looked at; says whether it is another graph than before. */
  turnTo(graph: string): boolean {
    if (this.graph === graph) return false;
    this.graph = graph;
    this.view = loadView(graph);
    // Kept by another version, it may be none.
    if (!this.view.section?.normal) this.view.section = undefined;
    if (this.view.camera) this.viewer?.restoreCamera(this.view.camera);
    this.apply();
    return true;
  }

  /** Takes over the view that the address names, and the address forgets it; gives what is picked there. */
  takeLink(): Selection | undefined {
    const linked = readFragment(window.location.hash);
    if (!linked) return undefined;
    // A reload keeps how the page is looked at by then.
    history.replaceState(null, "", window.location.pathname + window.location.search);
    const { selection, ...view } = linked;
    if (view.camera) this.viewer?.restoreCamera(view.camera);
    // Also what the link does not name: there was no section, say.
    this.change({ field: undefined, section: undefined, panels: undefined, ...view });
    return selection ?? { panels: [] };
  }

  save(): void {
    if (this.graph === undefined) return;
    this.view.camera = this.viewer?.cameraState() ?? this.view.camera;
    saveView(this.graph, this.view);
  }

  /** Changes a part of the view, draws it and keeps it. */
  change(part: Partial<ViewState>): void {
    Object.assign(this.view, part);
    this.apply();
    this.save();
  }

  apply(): void {
    const { viewer, viewbar } = this;
    const { edges, ghost, grid, directions } = this.view;
    viewer?.setEdges(edges);
    viewer?.setGhost(ghost);
    viewer?.setGrid(grid);
    viewer?.setDirections(directions);
    viewbar.press("edges", edges !== "none", edges === "triangles" ? "Triangles" : "Edges");
    viewbar.press("ghost", ghost);
    viewbar.press("grid", grid);
    viewbar.press("directions", directions);
    viewbar.press("projection", viewer?.camera.isOrthographic ?? false);
    this.applySection();
  }

  private applyPreferences(): void {
    const { theme, profile } = this.preferences;
    document.documentElement.dataset["theme"] = theme;
    this.viewer?.setTheme(theme);
    if (this.viewer) this.viewer.camera.profile = profile;
    this.viewbar.setProfile(PROFILE_LABELS[profile]);
    savePreferences(this.preferences);
  }

  setPreference(part: Partial<Preferences>): void {
    Object.assign(this.preferences, part);
    this.applyPreferences();
  }

  toggleTheme(): void {
    this.setPreference({ theme: this.preferences.theme === "dark" ? "light" : "dark" });
  }

  nextProfile(): void {
    const index = PROFILES.indexOf(this.preferences.profile) + 1;
    this.setPreference({ profile: PROFILES[index % PROFILES.length] as Profile });
  }

  nextEdges(): void {
    const index = EDGE_MODES.indexOf(this.view.edges) + 1;
    this.change({ edges: EDGE_MODES[index % EDGE_MODES.length] as EdgeMode });
  }

  /** Where there is no viewer. */
  onStandard: (view: StandardView) => void = () => {};

  from(view: StandardView): void {
    this.onStandard(view);
    this.viewer?.camera.look(view);
    this.viewer?.invalidate();
  }

  toggleProjection(): void {
    this.viewer?.camera.toggleProjection();
    this.viewer?.invalidate();
    this.apply();
    this.save();
  }

  fromSaved(): void {
    if (this.view.saved) this.viewer?.restoreCamera(this.view.saved);
    else this.from("corner");
    this.apply();
  }

  keepView(): void {
    this.view.saved = this.viewer?.cameraState();
    this.save();
    this.banner.say("info", "View saved: 0 comes back to it.");
  }

  toggleDirections(): void {
    if (!this.view.directions && !this.store.get("shown")?.directions) {
      this.banner.say("info", "What is shown carries no directions: show a node that gives some, such as SmoothNormals.");
    }
    this.change({ directions: !this.view.directions });
  }

  /** Draws the section; its slider spans the model shown now. */
  applySection(): void {
    const mesh = this.store.get("shown")?.mesh;
    this.viewer?.setSection(this.view.section);
    this.viewbar.setSection(this.view.section, mesh?.bounds, mesh?.scale ?? 1, lengthUnit(this.store.get("document")));
    this.onSection(this.view.section);
  }

  /** Called with the plane whenever it, or the model, may be another. */
  onSection: (section: Section | undefined) => void = () => {};

  /** Across X, then Y, then Z through the middle of the model, then along the picked face, then none. */
  nextSection(picked: Vec3[]): void {
    const bounds = this.store.get("shown")?.mesh?.bounds;
    this.change({ section: bounds && nextSection(this.view.section, bounds, picked) });
  }

  moveSection(at: number): void {
    if (this.view.section) this.change({ section: { ...this.view.section, at } });
  }

  flipSection(): void {
    const { section } = this.view;
    if (section) this.change({ section: { ...section, flipped: !section.flipped } });
  }
}
