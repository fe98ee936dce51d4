// What the page knows: the latest message of each type and whether there is a
// connection. Panels listen to the types they draw.
import type { Document, FromServer, ToServer } from "./protocol.ts";

/** `offline` is a saved page: nobody will ever answer. */
export type Link = "connecting" | "open" | "retrying" | "refused" | "offline";

type Messages = { [T in FromServer["type"]]: Extract<FromServer, { type: T }> };
type Listener<T> = (message: T) => void;

export class Store {
  private latest: Partial<Messages> = {};
  private listeners = new Map<string, Set<Listener<never>>>();
  /** Sends a message to the server; replaced by the connection. */
  send: (message: ToServer) => void = () => {};
  link: Link = "connecting";

  /** The latest message of a type, or nothing yet. */
  get<T extends keyof Messages>(type: T): Messages[T] | undefined {
    return this.latest[type];
  }

  /** Calls `listener` on every message of a type, and at once if there is one already. */
  on<T extends keyof Messages>(type: T, listener: Listener<Messages[T]>): void {
    this.listen(type, listener);
    const message = this.latest[type];
    if (message) listener(message);
  }

  /** Calls `listener` when the state of the connection changes. */
  onLink(listener: Listener<Link>): void {
    this.listen("link", listener);
    listener(this.link);
  }

  receive(message: FromServer): void {
    (this.latest as Record<string, FromServer>)[message.type] = message;
    this.emit(message.type, message);
  }

  setLink(link: Link): void {
    if (link === this.link) return;
    this.link = link;
    this.emit("link", link);
  }

  private listen(type: string, listener: Listener<never>): void {
    const set = this.listeners.get(type) ?? new Set();
    set.add(listener);
    this.listeners.set(type, set);
  }

  private emit(type: string, value: unknown): void {
    for (const listener of this.listeners.get(type) ?? []) (listener as Listener<unknown>)(value);
  }
}

/** Whether this page may change nothing. */
export function isReadOnly(store: Store): boolean {
  return store.link === "offline" || store.get("hello")?.read_only === true || store.get("access")?.may_edit === false;
}

/** The unit of lengths in the file, metres before a file is known. */
export function lengthUnit(document: Document | undefined): string {
  return document?.units ?? "m";
}
