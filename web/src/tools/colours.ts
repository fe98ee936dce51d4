// Colouring by a field: which, with what map and over what range.
import type { MapName } from "../core/colour.ts";
import { type ColourRange, RangeBook, fullRange, suitableMap } from "../core/legend.ts";
import type { Digest, Shown, ShownField } from "../core/protocol.ts";
import type { Legend } from "../panels/legend.ts";
import type { Viewer } from "../view/viewer.ts";

/** Two fields of one name from different nodes are different fields. */
function nameOf(field: ShownField): string {
  return `${field.node} ${field.name}`;
}

export class ColourTool {
  private readonly ranges = new RangeBook();
  private readonly chosenMaps = new Map<string, MapName>();
  private fields: ShownField[] = [];
  private values: { digest: Digest; values: Float32Array } | undefined;
  /** The name of the field people chose; it stays chosen while a result lacks it. */
  wanted: string | undefined;

  constructor(
    private readonly viewer: Viewer,
    private readonly legend: () => Legend,
  ) {
    viewer.onBuffer = (digest, bytes) => {
      if (this.fields.some((field) => field.values === digest)) this.values = { digest, values: new Float32Array(bytes) };
    };
  }

  get locked(): boolean {
    return this.ranges.locked;
  }

  set locked(locked: boolean) {
    this.ranges.locked = locked;
  }

  /** Takes the fields of what is shown and gives the one to colour by. */
  take(shown: Shown): ShownField | undefined {
    this.fields = shown.fields;
    return this.field;
  }

  get field(): ShownField | undefined {
    return this.fields.find((field) => nameOf(field) === this.wanted) ?? this.fields.find((field) => field.name === this.wanted);
  }

  /** Names and labels for the menu. */
  get choices(): { name: string; label: string }[] {
    return this.fields.map((field) => ({ name: nameOf(field), label: `${field.label} (${field.node})` }));
  }

  get current(): string | undefined {
    return this.field ? nameOf(this.field) : undefined;
  }

  /** The field after the present one; after the last comes none. */
  next(): string | undefined {
    const names = this.fields.map(nameOf);
    const index = this.current === undefined ? -1 : names.indexOf(this.current);
    return names[index + 1];
  }

  /** Draws colours and legend anew. */
  apply(): void {
    const { field } = this;
    if (!field) {
      this.legend().hide();
      return;
    }
    const name = nameOf(field);
    const values = this.values?.digest === field.values ? this.values.values : undefined;
    const map = this.mapOf(field, values);
    const range = this.ranges.rangeOf(name, field, map);
    this.viewer.setColours(map, range);
    this.legend().show(field, values, map, range, this.ranges.locked);
  }

  /** The map chosen by hand, else the one that suited the field when it was first seen. */
  private mapOf(field: ShownField, values: Float32Array | undefined): MapName {
    const name = nameOf(field);
    const map = this.chosenMaps.get(name) ?? suitableMap(field, values);
    this.chosenMaps.set(name, map);
    return map;
  }

  hold(range: ColourRange): boolean {
    const held = this.field !== undefined && this.ranges.hold(nameOf(this.field), range);
    if (held) this.apply();
    return held;
  }

  chooseMap(map: MapName): void {
    const { field } = this;
    if (!field) return;
    this.chosenMaps.set(nameOf(field), map);
    this.ranges.hold(nameOf(field), fullRange(field, map));
    this.apply();
  }

  /** Lets the range be that of this result. */
  release(): void {
    const { field } = this;
    if (!field) return;
    this.ranges.release(nameOf(field));
    this.chosenMaps.delete(nameOf(field));
    this.apply();
  }
}
