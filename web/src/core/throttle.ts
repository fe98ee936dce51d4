// Live values while a slider moves: at most one run under way, and no faster than
// the last run took, so that a slow graph is not asked for what nobody will see.

export type Clock = { now(): number; after(ms: number, act: () => void): () => void };

export const systemClock: Clock = {
  now: () => performance.now(),
  after: (ms, act) => {
    const timer = setTimeout(act, ms);
    return () => clearTimeout(timer);
  },
};

/** Live evaluation: by the time of the last run, always, or only on release. */
export type Live = "auto" | "always" | "release";

/** Above this a run is too slow to follow a drag. */
export const LIVE_LIMIT_MS = 300;

/** Whether values are sent while a slider moves. */
export function isLive(live: Live, lastRunMs: number): boolean {
  return live === "always" || (live === "auto" && lastRunMs < LIVE_LIMIT_MS);
}

/** Sends the newest value at once if the pause has passed, else when it has. */
export class Throttle<T> {
  private last = Number.NEGATIVE_INFINITY;
  private waiting: { value: T; cancel: () => void } | undefined;

  constructor(
    private readonly send: (value: T) => void,
    private readonly pause: () => number,
    private readonly clock: Clock = systemClock,
  ) {}

  push(value: T): void {
    if (this.waiting) {
      this.waiting.value = value;
      return;
    }
    const wait = this.last + this.pause() - this.clock.now();
    if (wait <= 0) {
      this.deliver(value);
      return;
    }
    const waiting = { value, cancel: () => {} };
    waiting.cancel = this.clock.after(wait, () => {
      this.waiting = undefined;
      this.deliver(waiting.value);
    });
    this.waiting = waiting;
  }

  /** Forgets a value not sent yet: the release sends its own. */
  cancel(): void {
    this.waiting?.cancel();
    this.waiting = undefined;
  }

  private deliver(value: T): void {
    this.last = this.clock.now();
    this.send(value);
  }
}
