// Second values of parameters, to compare with: A is what the file says, B what was
// kept here. B is shown while a key is held, and never written.
import type { Parameter, ToServer, Value } from "./protocol.ts";

export class Alternatives {
  private values = new Map<string, Value>();
  private shown = false;
  /** Called when a value was kept or forgotten. */
  onChange: () => void = () => {};

  constructor(private readonly send: (message: ToServer) => void) {}

  /** Keeps a parameter's value as B; kept again it is forgotten. */
  store({ name, value }: Parameter): void {
    if (this.values.get(name) === value) this.values.delete(name);
    else this.values.set(name, value);
    this.onChange();
  }

  of(name: string): Value | undefined {
    return this.values.get(name);
  }

  /** Shows B, or A again; says whether there is a B at all. */
  flip(toB: boolean, parameters: Parameter[]): boolean {
    const free = parameters.filter((p) => this.values.has(p.name) && !p.locked);
    if (toB === this.shown || free.length === 0) return free.length > 0;
    this.shown = toB;
    for (const { name, in_file } of free) this.send({ type: "set", name, value: toB ? (this.values.get(name) as Value) : in_file });
    return true;
  }
}
