// The messages between `tessgraph view` and this page, as crates/view defines them.
// A later message of a type replaces the earlier one as a whole.

/** Name of an immutable buffer: 32 hex digits of its content. */
export type Digest = string;
export type Value = number | boolean | string;
export type Vec3 = [number, number, number];
/** Bytes [start, end) of the graph's UTF-8 source. */
export type Span = [number, number];

export type Hello = {
  type: "hello";
  version: string;
  file: string;
  folder: string;
  /** Changes when the server restarts. */
  session: string;
  read_only: boolean;
};

export type LengthUnit = "m" | "cm" | "mm" | "ft" | "in";

export type Parameter = {
  name: string;
  kind: "number" | "integer" | "bool" | "text" | "path" | "choice";
  /** What the graph runs with now, in the file's units. */
  value: Value;
  /** What the file says now. */
  in_file: Value;
  /** What the file said when the session began: reset goes here. */
  initial: Value;
  min?: number;
  max?: number;
  unit: string;
  of?: string[];
  about: string;
  /** Set on the command line; the file's value is not used. */
  locked: boolean;
  line: number;
  span: Span;
};

export type GraphNode = {
  name: string;
  kind: string;
  about: string;
  line: number;
  span: Span;
  inputs: { name: string; text: string; from: string[] }[];
  results: { name: string; kind: string; main: boolean }[];
};

export type Output = { path: string; node: string; result: string; kind: string };

export type Document = {
  type: "document";
  source: string;
  units: LengthUnit;
  parameters: Parameter[];
  nodes: GraphNode[];
  outputs: Output[];
  can_undo: boolean;
  can_redo: boolean;
};

export type Status = {
  type: "status";
  state: "up_to_date" | "computing" | "stale" | "waiting" | "cancelled";
  /** Milliseconds of the last run. */
  ms?: number;
  done?: number;
  total?: number;
  node?: string;
  fraction?: number;
  errors?: number;
  line?: number;
  waiting_for?: string;
  cause?: string;
};

export type Outcome =
  | "computed"
  | "cached"
  | "cut_off"
  | "failed"
  | "blocked"
  | "skipped"
  | "running"
  | "stale";

export type NodeOutcome = {
  name: string;
  outcome: Outcome;
  ms: number;
  bytes: number;
  warnings: string[];
  explain?: string;
};
export type Outcomes = { type: "outcomes"; nodes: NodeOutcome[] };

export type Diagnostic = {
  code: string;
  severity: "error" | "warning";
  message: string;
  file: string;
  line: number;
  column: number;
  span: Span;
  labels: { message: string; line: number; column: number; span: Span }[];
  help?: string;
  /** The text the command line shows. */
  rendered: string;
};
export type Diagnostics = { type: "diagnostics"; items: Diagnostic[] };

export type Cell = number | string | boolean | null;
/** What the next picture will need: the positions that its `shown` will name. */
export type Coming = { type: "coming"; positions: Digest };
export type Named = { name: string; value: Cell; unit: string };
export type Check = {
  node: string;
  kind: string;
  values: Named[];
  /** null: only a measurement. */
  ok: boolean | null;
  sentence: string;
};
export type Checks = { type: "checks"; items: Check[] };

export type ShownMesh = {
  vertices: number;
  faces: number;
  triangles: number;
  /** Metres; positions are relative to it. */
  origin: Vec3;
  /** Metres, absolute. */
  bounds: [Vec3, Vec3];
  /** File units per metre. */
  scale: number;
  positions: Digest;
  triangles_buffer: Digest;
  triangle_faces: Digest;
  edges: Digest;
  base_faces?: Digest;
  buffers: Record<Digest, number>;
};
export type ShownField = {
  name: string;
  label: string;
  on: "vertex" | "face";
  unit: string;
  min: number;
  max: number;
  values: Digest;
  categorical: boolean;
  node: string;
};
export type ShownTable = { columns: { name: string; unit: string }[]; rows: Cell[][]; total: number };
export type Shown = {
  type: "shown";
  node: string;
  result: string;
  kind: string;
  version: number;
  /** A sentence when there is nothing to draw. */
  empty?: string;
  mesh?: ShownMesh;
  directions?: { per: "vertex"; outward: Digest; on: "mesh" };
  fields: ShownField[];
  table?: ShownTable;
  report?: Named[];
};

/** A number with its unit: with the digits people can use, and with all. */
export type Amount = { text: string; exact: string };
export type Picked = {
  type: "picked";
  request: number;
  face?: number;
  vertex?: number;
  lines: [string, Amount][];
  vertices?: Vec3[];
};
export type Measured = {
  type: "measured";
  request: number;
  from: Vec3;
  to: Vec3;
  distance: Amount;
  delta: [Amount, Amount, Amount];
};
/** A plane in absolute metres. */
export type Plane = { normal: Vec3; at: number };
/** The cut of what is shown. */
export type Sectioned = {
  type: "sectioned";
  request: number;
  origin: Vec3;
  /** Two ends of three f32 each per segment, closed outlines first. */
  segments: Digest;
  panels: Digest;
  count: number;
  closed_count: number;
  closed: number;
  open: number;
  length: Amount;
  area: Amount;
};
/** A PNG drawn by the server, for a browser that cannot. */
export type Rendered = { type: "rendered"; request: number; picture: Digest };
export type Described = {
  type: "described";
  node: string;
  markdown: string;
  results: { name: string; summary: string }[];
  warnings: string[];
};
/** What this page may do, told to pages of other machines alone. */
export type Access = { type: "access"; may_edit: boolean };
/** An address that was given to another device. */
export type Pairing = { id: number; url: string; connected: number };
/** With whom the page is shared; told to pages of this machine that ask. */
export type Shares = { type: "shares"; lan: { address: string; edit: boolean } | null; pairings: Pairing[] };
/** The parts of an array: each vertex is a point of a component over a grid of base vertices. */
export type Instances = {
  /** Two u32 per vertex: placement, point. */
  vertices: Digest;
  /** Eight f32 per point: grid place and fractions of (u, v), height; the same of (u', v'), row. */
  points: Digest;
  grids: Digest;
  grid_starts: Digest;
  /** Three f32 per base vertex, about the origin of the shown mesh. */
  positions: Digest;
  /** Four f32 per base vertex: direction, length. */
  outward: Digest;
  inward?: Digest;
  is_unit: boolean;
  factors: Digest[];
  /** How far from the base the heights reach, in metres. */
  reach: number;
  buffers: Record<Digest, number>;
};
export type Previewed = {
  type: "previewed";
  request: number;
  /** Why there is no preview. */
  reason?: string;
  /** Of the result that the instances belong to. */
  version: number;
  instances?: Instances;
  /** Values of the parameter, and what all heights are then multiplied by. */
  factors: [number, number][];
  is_exact: boolean;
};
export type Notice = { type: "notice"; level: "info" | "warning" | "error"; text: string };
/** `pictures` holds the number of each row's picture; missing where no row has one. */
export type Study = { type: "study"; path: string; columns: string[]; rows: (number | string | null)[][]; pictures?: (number | null)[] };

export type FromServer =
  | Hello
  | Document
  | Status
  | Outcomes
  | Diagnostics
  | Checks
  | Coming
  | Shown
  | Picked
  | Measured
  | Sectioned
  | Rendered
  | Described
  | Previewed
  | Notice
  | Study
  | Access
  | Shares;

/** One end of a measurement: a vertex, a face, or the place of a cut that is closest to another; corners within `snap` metres first. */
export type Place = { vertex?: number; face?: number; cut?: { plane: Plane; near: Vec3; snap: number } };

export type ToServer =
  | { type: "set"; name: string; value: Value }
  | { type: "write"; name: string; value: Value }
  | { type: "reset"; name: string }
  | { type: "undo" }
  | { type: "redo" }
  | { type: "show"; node: string; result?: string }
  | { type: "shares" }
  | { type: "pair" }
  | { type: "unpair"; id: number }
  | { type: "cancel" }
  | { type: "run" }
  | { type: "pick"; request: number; vertex?: number; face?: number }
  | { type: "section"; request: number; plane: Plane }
  | { type: "render"; request: number; size: [number, number]; towards: Vec3 }
  | { type: "measure"; request: number; from: Place; to: Place }
  | { type: "describe"; node: string }
  | { type: "preview"; request: number; name: string; from: number; to: number };
