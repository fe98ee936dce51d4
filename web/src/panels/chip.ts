// The state chip: one short sentence that is always true of the picture.
import type { Diagnostics, Status } from "../core/protocol.ts";
import type { Link } from "../core/store.ts";
import { formatTime } from "../core/units.ts";

export type Chip = {
  sign: string;
  text: string;
  kind: "good" | "busy" | "bad" | "waiting" | "idle";
  /** What a click offers: to stop the run, or to see the messages. */
  act?: "cancel" | "messages" | "run" | undefined;
};

/** Whether the picture is drawn from parts before it is evaluated: exactly, or nearly. */
export type Preview = undefined | "exact" | "approximate";

/** How long a run takes by now, and how long the last one took, in milliseconds. */
export type Clocked = { elapsed: number; last?: number | undefined };

/** A run that is shorter than this is not timed in the chip: numbers would only flicker. */
const SHORT_MS = 500;

/** The chip for what is known; the connection says more than the last run. */
export function chipOf(link: Link, readOnly: boolean, status: Status | undefined, diagnostics: Diagnostics | undefined, clocked?: Clocked, preview?: Preview): Chip {
  if (link === "refused") {
    return { sign: "⊘", text: "Server restarted with a new address: open the one it printed", kind: "bad" };
  }
  if (link === "retrying") return { sign: "⊘", text: "Disconnected: retrying", kind: "bad" };
  if (link === "offline") return { sign: "⎙", text: "Offline page: as it was when it was saved", kind: "idle" };
  if (link === "connecting" || !status) return { sign: "◌", text: "Connecting", kind: "idle" };
  if (preview) return { sign: "◐", text: preview === "exact" ? "Preview (instanced)" : "Preview (instanced, approximate)", kind: "busy" };
  const chip = chipOfStatus(status, diagnostics, clocked);
  return readOnly ? { ...chip, text: `${chip.text} · Read only (shared)`, act: chip.act === "messages" ? chip.act : undefined } : chip;
}

function chipOfStatus(status: Status, diagnostics: Diagnostics | undefined, clocked: Clocked | undefined): Chip {
  const cause = status.cause ? ` · ${status.cause}` : "";
  switch (status.state) {
    case "up_to_date":
      return { sign: "✓", text: `Up to date${status.ms === undefined ? "" : ` ${formatTime(status.ms)}`}`, kind: "good" };
    case "computing": {
      const place = status.total ? ` ${status.done ?? 0}/${status.total}` : "";
      const part = status.fraction === undefined ? "" : ` ${Math.round(100 * status.fraction)} %`;
      return { sign: "↻", text: `Computing${place}${status.node ? ` ${status.node}` : ""}${part}${timeOf(clocked)}`, kind: "busy", act: "cancel" };
    }
    case "stale": {
      const errors = status.errors ?? diagnostics?.items.filter((d) => d.severity === "error").length ?? 0;
      const line = status.line === undefined ? "" : ` (line ${status.line})`;
      return { sign: "!", text: `Stale: ${errors === 1 ? "1 error" : `${errors} errors`}${line}`, kind: "bad", act: "messages" };
    }
    case "waiting":
      return { sign: "…", text: `Waiting for ${status.waiting_for ?? "a file"}`, kind: "waiting", act: "messages" };
    case "cancelled":
      return { sign: "■", text: `Stopped${cause}`, kind: "waiting", act: "run" };
  }
}

function timeOf(clocked: Clocked | undefined): string {
  if (!clocked || clocked.elapsed < SHORT_MS) return "";
  const { elapsed, last } = clocked;
  const of = last !== undefined && last > SHORT_MS ? ` of ~${formatTime(last)}` : "";
  return ` · ${(elapsed / 1000).toFixed(1)} s${of}`;
}
