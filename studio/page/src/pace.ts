// Whether a session keeps up with the clock. What a machine does not reach in time is lost to the session, which then runs in slow motion.

const kLooksBack = 2; // [s]
const kSlow = 0.5, kKeepsUp = 0.1; // lost in that time: from there on it counts as slow, and no longer [s]

export class Pace {
  isSlow = false;
  private readonly past: { time: number; slip: number }[] = []; // of kLooksBack, and one before

  /** A moment of the session, and how far that is behind the clock [s]. */
  add({ time, slip }: { time: number; slip: number }): void {
    const { past } = this;
    past.push({ time, slip });
    while (past.length > 2 && past[1].time + past[1].slip <= time + slip - kLooksBack) past.shift();
    this.isSlow = slip - past[0].slip > (this.isSlow ? kKeepsUp : kSlow);
  }

  /** How far the session went in a second of the clock [s]. */
  get share(): number {
    const [from, to] = [this.past[0], this.past.at(-1)], went = from && to ? to.time - from.time : 0;
    return from && to && went + to.slip > from.slip ? went / (went + to.slip - from.slip) : 1;
  }

  /** How far it is behind the clock by now [s]. */
  get behind(): number {
    return this.past.at(-1)?.slip ?? 0;
  }
}
