// What the person chose about looking: kept across reloads and restarts. The model
// is never part of it, and neither is anything that changes a result.
import type { PanelsState } from "../tools/panels.ts";
import type { Section } from "./section.ts";
import type { CameraState, Profile } from "../view/camera.ts";
import type { EdgeMode } from "../view/surface.ts";
import type { ThemeName } from "../view/theme.ts";
import type { MapName } from "./colour.ts";
import type { Live } from "./throttle.ts";

export type DrawerTab = "graph" | "table" | "messages" | "source" | "study";
export type DrawerSize = "closed" | "part" | "full";

/** For every graph: in the browser's local storage. */
export type Preferences = { theme: ThemeName; profile: Profile; live: Live; picture: PictureOptions };

/** How pictures are saved: pixels per pixel of the screen, and whether only the model is on them. */
export type PictureOptions = { scale: number; transparent: boolean };

/** What can be chosen. */
export const PICTURE_SCALES = [1, 2, 4];

/** For one graph and one tab: in session storage. */
export type ViewState = {
  camera?: CameraState | undefined;
  saved?: CameraState | undefined;
  edges: EdgeMode;
  grid: boolean;
  directions: boolean;
  ghost: boolean;
  field?: string | undefined;
  map?: MapName | undefined;
  locked: boolean;
  section?: Section | undefined;
  panels?: PanelsState | undefined;
  drawer: DrawerSize;
  tab: DrawerTab;
  node?: { node: string; result: string } | undefined;
};

export const INITIAL_VIEW: ViewState = {
  edges: "polygons",
  grid: true,
  directions: false,
  ghost: false,
  locked: true,
  drawer: "part",
  tab: "graph",
};

function read<T>(storage: Storage, key: string, initial: T): T {
  try {
    return { ...initial, ...(JSON.parse(storage.getItem(key) ?? "{}") as Partial<T>) };
  } catch {
    // A storage that is closed to us or was written by something else: begin anew.
    return { ...initial };
  }
}

function write(storage: Storage, key: string, value: unknown): void {
  try {
    storage.setItem(key, JSON.stringify(value));
  } catch {
    // Full or forbidden: the page works without remembering.
  }
}

export function loadPreferences(): Preferences {
  const light = window.matchMedia("(prefers-color-scheme: light)").matches;
  return read(localStorage, "tessgraph", { theme: light ? "light" : "dark", profile: "rhino", live: "auto", picture: { scale: 2, transparent: false } });
}

export function savePreferences(preferences: Preferences): void {
  write(localStorage, "tessgraph", preferences);
}

export function loadView(graph: string): ViewState {
  return read(sessionStorage, `tessgraph ${graph}`, INITIAL_VIEW);
}

export function saveView(graph: string, view: ViewState): void {
  write(sessionStorage, `tessgraph ${graph}`, view);
}
