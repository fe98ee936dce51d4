// Panels that are selected, hidden or isolated, by their ids. They stay so across
// updates of the model; another result has other panels.

/** What is kept of them between pages. */
export type PanelsState = { hidden: number[]; isolated?: number[] | undefined };

export class Panels {
  readonly selected = new Set<number>();
  private hidden = new Set<number>();
  private isolated: Set<number> | undefined;

  /** Selects one panel, or adds it to or takes it from the selection. */
  select(panel: number, adding: boolean): void {
    if (adding && this.selected.has(panel)) {
      this.selected.delete(panel);
      return;
    }
    if (!adding) this.selected.clear();
    this.selected.add(panel);
  }

  /** Selects several panels, or adds them to the selection. */
  selectAll(panels: Iterable<number>, adding: boolean): void {
    if (!adding) this.selected.clear();
    for (const panel of panels) this.selected.add(panel);
  }

  /** Hides what is selected; says how many panels that were. */
  hide(): number {
    const count = this.selected.size;
    for (const panel of this.selected) this.hidden.add(panel);
    this.selected.clear();
    return count;
  }

  /** Leaves only what is selected, or ends that. */
  isolate(): void {
    this.isolated = this.isolated || this.selected.size === 0 ? undefined : new Set(this.selected);
  }

  showAll(): void {
    this.hidden.clear();
    this.isolated = undefined;
  }

  get isIsolating(): boolean {
    return this.isolated !== undefined;
  }

  /** Whether a panel is drawn. */
  isVisible(panel: number): boolean {
    return !this.hidden.has(panel) && (this.isolated?.has(panel) ?? true);
  }

  /** Whether any panel is out of sight. */
  get hidesSome(): boolean {
    return this.hidden.size > 0 || this.isIsolating;
  }

  /** One byte per panel up to the last that differs: 1 hidden, 2 isolated, 4 selected. */
  states(): Uint8Array {
    const sets: [Iterable<number>, number][] = [[this.hidden, 1], [this.isolated ?? [], 2], [this.selected, 4]];
    let last = -1;
    for (const [set] of sets) for (const panel of set) last = Math.max(last, panel);
    const states = new Uint8Array(last + 1);
    for (const [set, bit] of sets) for (const panel of set) states[panel] = (states[panel] as number) | bit;
    return states;
  }

  state(): PanelsState {
    return { hidden: [...this.hidden], isolated: this.isolated ? [...this.isolated] : undefined };
  }

  restore(state: PanelsState | undefined): void {
    this.selected.clear();
    this.hidden = new Set(state?.hidden);
    this.isolated = state?.isolated ? new Set(state.isolated) : undefined;
  }
}
