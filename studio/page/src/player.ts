import type { Connection } from "./connection";
import type { Binary, CameraView, Comparable, ComparisonResult, Drawing, Frame, OpenedSession, Seen, SessionInfo, TimelineData, Shapes } from "./protocol";
import { freeCamera, isPlain, kPlainLook, type Look, lookParameters, steppedForward } from "./look";
import { type Alignment, kEventOf, type Place } from "./place";
import { StageScene } from "./stage_scene";
import { firstCamera, type Viewer } from "./viewer";

/** A session on the page. Stage 0 is the one in review, stage 1 the one beside it. */
export interface Track {
  stage: number;
  session: OpenedSession;
  timeline: TimelineData | null;
  scene: StageScene;
  expert?: string; // the session whose cut the program shows on the organs
}

/** Longest step of a playback [s]: where the program simulates slower, playing becomes slower instead of jumping. */
const kLongestStep = 0.1;
const kTogether = 1e-3; // of two times [s]
const kLeastTogether = 0.1; // of two sessions that are brought together by hand [s]
const kPatience = 30; // with the picture of the other session [ms]
const kTimelinePoints = 12000; // so that a part of a long session can be looked at closely

/** When an event of that kind first happened [s]; null: never. */
export function firstOf(info: SessionInfo, kind: string): number | null {
  const event = info.events.find((e) => e.kind === kind);
  return event ? event.tick * info.tick_s : null;
}

/** How far a camera is from what it looks at [m]. */
function farOf({ eye, target }: CameraView): number {
  return Math.hypot(...eye.map((x, axis) => x - target[axis]));
}

function wholeMicroseconds(time: number): number {
  return Math.round(1e6 * time) / 1e6;
}

/** The clock of a review: moves to a moment, plays, and asks the program for one picture at a time. */
export class Player {
  readonly tracks = new Map<number, Track>();
  time = 0; // of stage 0 [s]
  speed = 1;
  offset = 0; // time of stage 1 where that of stage 0 is 0 [s]
  aligned: Alignment | "" = ""; // what brought both sessions together; empty: a hand
  otherScene = ""; // why the session beside cannot be compared: it is of another scene; empty: it can
  isPathWanted = false; // a link leads to sessions along their path, which is known once they are compared
  look: Look = kPlainLook; // how they are seen
  hasExpertLine = true; // the expert's cut is on the trainee's organs
  zoom: { from: number; to: number } | null = null; // what the timeline shows, of stage 0 [s]; null: everything
  isPlaying = false;
  pictureAfter: number | null = null; // time from the last move to its picture, a glimpse or not [ms]
  replayedAfter: number | null = null; // the same, to the replayed one [ms]
  path: [number, number][] | null = null; // times of both sessions that belong together; null: they differ by `offset` [s]
  private left: Pick<Player, "offset" | "path" | "aligned"> | null = null; // how they were brought together, until a moment needed another way
  reached = 0; // speed of the playback in the last second
  onChange: () => void = () => {};
  onTime: () => void = () => {};
  onDrawing: (stage: number, drawing: Drawing | null) => void = () => {}; // to show in place of the scene; null: the scene
  onFailure: (error: Error) => void = () => {};
  private readonly openings = new Map<number, number>(); // of each stage so far
  private readonly drawings = new Map<number, Drawing>(); // newest of each stage
  private readonly asked = new Map<number, number>(); // newest request of each stage
  private readonly unanswered = new Set<number>(); // stages from which nothing came since they were asked
  private drawing: ReturnType<typeof setTimeout> | undefined; // of what came from one of them
  private readonly unseen = new Set<number>(); // stages of which it has no picture yet
  private readonly waiting = new Map<number, number>(); // request of each stage that has no replayed picture yet
  private whenReplayed: (() => void)[] = []; // what waits until there are none of those
  private wanted: { look: Look; size: string } | null = null; // newest look that the program does not know yet
  private isLooking = false;
  private readonly tools = new Map<number, Shapes>();
  private request = 0;
  private movedAt = 0;
  private playedAt = 0;
  private steps: [number, number][] = []; // of the playback: when [ms], how far [s]

  constructor(private readonly connection: Connection, readonly viewer: Viewer) {
    for (const stage of [0, 1]) connection.onStage(stage, (message) => this.take(stage, message));
    viewer.onReady = () => {
      for (const [stage, { scene }] of this.tracks) if (scene.frame) connection.send({ ready: { stage, request: scene.frame.request } });
    };
  }

  /** Opens the session beside. */
  async openBeside(path: string): Promise<void> {
    if (!(await this.load(1, path))) return;
    this.move(this.time);
    this.onChange();
  }

  /** Opens what a place names, at its moment: both sessions at once, and no picture of another moment is asked for. */
  async openAt({ session, beside, ahead, align, time, besideTime, comparison, zoom }: Place): Promise<void> {
    if (session === undefined) return;
    this.zoom = null;
    if (beside === undefined) this.close(1);
    else this.drop(1); // nothing of it is to be seen beside the new one
    const [first, second] = await Promise.allSettled([this.load(0, session), beside === undefined ? null : this.load(1, beside)]);
    if (first.status === "rejected") for (const stage of [1, 0]) this.close(stage); // the program still has the one before open
    else if (!first.value) return; // another one was opened meanwhile
    else {
      this.path = null, this.aligned = "", this.left = null;
      const hasBoth = second.status === "fulfilled" && second.value !== null;
      this.isPathWanted = hasBoth && align === "path";
      const isByEvent = hasBoth && (align === "contact" || align === "cut") && this.bringTogether(align);
      if (hasBoth && ahead !== undefined && !isByEvent) this.offset = this.allowed(ahead);
      else if (!isByEvent && (!hasBoth || !this.bringTogether("contact"))) this.offset = 0;
      if (hasBoth && besideTime !== undefined && comparison) this.moveBeside(besideTime, comparison);
      else this.move(time ?? 0);
      this.zoom = zoom ?? null;
    }
    this.onChange();
    for (const one of [first, second]) if (one.status === "rejected") throw one.reason;
  }

  /** Null: another session was opened as that stage meanwhile, whether this one can be opened or not. Its curves come
      when they are there. */
  private async load(stage: number, path: string): Promise<Track | null> {
    this.drop(stage);
    const opening = this.openings.get(stage), isWanted = () => this.openings.get(stage) === opening;
    const session = await this.connection.callInTurn<OpenedSession>(stage, "session.open", { path }, isWanted).catch((failure) => {
      if (isWanted()) throw failure;
      return null;
    });
    if (!session || !isWanted()) return null;
    const track: Track = { stage, session, timeline: null, scene: new StageScene(session.view) };
    const tools = this.tools.get(stage); // they come before the answer
    if (tools) track.scene.setShapes(tools);
    track.scene.onFrame = (frame) => this.drew(stage, frame);
    this.tracks.set(stage, track);
    this.viewer.set(stage, track.scene);
    const camera = stage === 0 && firstCamera(session.view);
    if (camera) this.viewer.look(camera);
    void this.addCurves(track);
    void this.askForScenes();
    return track;
  }

  /** Asks whether both sessions are of one scene, as they must be to be compared. */
  private async askForScenes(): Promise<void> {
    const shown = [0, 1].map((stage) => this.tracks.get(stage)), [expert, trainee] = shown.map((track) => track?.session.path);
    if (!expert || !trainee) return;
    const isShown = () => shown.every((track, stage) => this.tracks.get(stage) === track);
    try {
      const { comparable, text } = await this.connection.call<Comparable>("session.comparable", { expert, trainee });
      if (!isShown()) return;
      this.otherScene = comparable ? "" : text;
      this.onChange();
    } catch (failure) {
      if (isShown()) this.onFailure(failure as Error);
    }
  }

  private async addCurves(track: Track): Promise<void> {
    try {
      track.timeline = await this.connection.call<TimelineData>("session.timeline", { path: track.session.path, points: kTimelinePoints });
      if (this.tracks.get(track.stage) === track) this.onChange();
    } catch (failure) {
      if (this.tracks.get(track.stage) === track) this.onFailure(failure as Error);
    }
  }

  close(stage: number): void {
    this.drop(stage);
    this.connection.callInTurn(stage, "session.close", {}).catch(() => {});
  }

  /** Shows no session there any more; what the program has open it closes when it opens another one. */
  private drop(stage: number): void {
    this.openings.set(stage, (this.openings.get(stage) ?? 0) + 1); // one that is on its way comes too late
    if (!this.tracks.delete(stage)) return;
    this.waiting.delete(stage), this.unanswered.delete(stage), this.unseen.delete(stage), this.asked.delete(stage), this.drawings.delete(stage);
    this.goOn();
    if (stage === 1) this.path = this.left = null;
    this.otherScene = "";
    this.viewer.isCovered = false;
    this.viewer.set(stage, null);
    this.onDrawing(stage, null);
    this.onChange();
  }

  /** The times that can be shown, of stage 0: until both sessions have ended, and from where the first of them begins. */
  get span(): { from: number; to: number } {
    const first = this.tracks.get(0)?.session.info.duration_s ?? 0, second = this.tracks.get(1)?.session.info.duration_s;
    if (second === undefined || this.path) return { from: 0, to: first };
    return { from: Math.min(0, -this.offset), to: Math.max(first, second - this.offset) };
  }

  /** The time of a stage's own session. */
  timeOf(stage: number): number {
    return stage === 0 ? this.time : this.besideAt(this.time);
  }

  /** The time of the session beside that belongs to a time of the first one. */
  besideAt(time: number): number {
    return this.path ? alongPath(this.path, time, 0) : time + this.offset;
  }

  /** The time of the first session that belongs to one of the session beside. */
  firstAt(beside: number): number {
    return this.path ? alongPath(this.path, beside, 1) : beside - this.offset;
  }

  /** Aligns both sessions where the tools were at the same place of the path. */
  alignAlong(path: [number, number][]): void {
    this.path = path.length > 0 ? path : null, this.left = null;
    this.aligned = this.path ? "path" : "";
    this.move(this.time);
    this.onChange();
  }

  /** What plays, or is moved to, comes into what the timeline shows. */
  private goTo(time: number): void {
    const { zoom, span } = this, hasMoved = time !== this.time;
    this.time = time;
    if (!zoom || !hasMoved || (time >= zoom.from && time <= zoom.to)) return;
    const length = zoom.to - zoom.from, from = Math.min(Math.max(time - 0.1 * length, span.from), span.to - length);
    this.zoom = { from, to: from + length };
  }

  move(time: number): void {
    const { from, to } = this.span;
    this.goTo(Math.min(Math.max(wholeMicroseconds(time), from), to));
    this.movedAt = performance.now();
    this.pictureAfter = this.replayedAfter = null;
    this.ask();
    this.onTime();
  }

  /** Sees the sessions as the program says; what the page cannot draw, the program draws in pictures of that size. One
      picture is asked for at a time, so that a hand that turns the view is followed as fast as they come. What comes of a
      session that is no longer shown, a failure too, is of no interest. `onSeen` may hear of a look that was asked for later. */
  async see(look: Look, size: string, onSeen: (seen: Seen, as: Look) => void): Promise<void> {
    this.look = look;
    this.wanted = { look, size };
    this.onTime();
    if (this.isLooking) return;
    this.isLooking = true;
    try {
      while (this.wanted && this.tracks.has(0)) {
        const { look: newest, size: its } = this.wanted, shown = [...this.tracks.values()];
        const isShown = () => shown.every((track) => this.tracks.get(track.stage) === track);
        this.wanted = null;
        const seen = await this.lookAt(newest, isPlain(newest) ? null : its).catch((failure) => {
          if (isShown() && !this.wanted) throw failure; // else the newer look may be possible
          return null;
        });
        if (seen && isShown()) onSeen(seen, newest);
      }
    } finally {
      this.isLooking = false;
      this.onTime();
    }
  }

  private async lookAt(look: Look, size: string | null): Promise<Seen> {
    const ask = (stage: number, as: Look, expert?: string) => this.connection.call<Seen>("session.draw", { stage, size: size ?? undefined, expert, ...lookParameters(as) });
    const first = this.tracks.get(0)!, second = this.tracks.get(1);
    const seen = await ask(0, look);
    seen.camera = steppedForward(seen.camera, size);
    if (second) {
      // As in a video, all of one scene is seen as the first one is.
      const isAlike = JSON.stringify([first.session.view.least, first.session.view.most]) === JSON.stringify([second.session.view.least, second.session.view.most]);
      const camera = isAlike && look.camera !== "follow" ? freeCamera(seen.camera, second.session.view.up) : look.camera;
      const expert = this.hasExpertLine ? first.session.path : undefined;
      const other = await ask(1, { ...look, camera }, expert);
      if (second.expert !== expert && !this.isPlaying) this.ask(1);
      second.expert = expert;
      // The page sees both with one camera: of two scenes, the one that is farther away has both in its picture.
      if (!isAlike && !size && farOf(other.camera) > farOf(seen.camera)) seen.camera = other.camera;
    }
    if (size || this.drawings.size > 0) {
      this.drawings.clear();
      this.ask();
      await new Promise<void>((resolve) => this.whenReplayed.push(resolve));
    }
    return seen;
  }

  /** Whether a replayed picture was asked for that is not there yet. */
  get isWaiting(): boolean {
    return this.waiting.size > 0;
  }

  /** Whether the picture that is shown is an older one until the program has drawn what was asked for. */
  get isDrawing(): boolean {
    const isByProgram = !isPlain(this.look) || this.drawings.size > 0;
    return isByProgram && (this.isLooking || this.isWaiting) && !this.isPlaying;
  }

  /** What an address needs to lead here again. */
  get place(): Place {
    const [first, second] = [0, 1].map((stage) => this.tracks.get(stage)?.session.path);
    return {
      session: first, beside: second, ahead: second && this.besideAt(this.time) - this.time, align: this.aligned || undefined,
      time: this.time, look: this.look, zoom: this.zoom ?? undefined,
    } as Place;
  }

  /** The least and the most that the session beside may be ahead by [s]: some of both is left beside each other. */
  get offsets(): { least: number; most: number } {
    const [first = Infinity, second = Infinity] = [0, 1].map((stage) => this.tracks.get(stage)?.session.info.duration_s);
    const together = Math.min(kLeastTogether, first / 2, second / 2);
    return { least: wholeMicroseconds(together - first), most: wholeMicroseconds(second - together) };
  }

  /** The nearest one of those. */
  private allowed(offset: number): number {
    return Math.min(Math.max(offset, this.offsets.least), this.offsets.most);
  }

  /** As near to it as both sessions stay beside each other. */
  setOffset(offset: number): void {
    this.offset = this.allowed(offset), this.path = null, this.aligned = "", this.left = null;
    this.move(this.time);
    this.onChange();
  }

  /** Aligns both sessions where an event first happened. Null: one of them has none. */
  alignAt(event: keyof typeof kEventOf): number | null {
    if (!this.bringTogether(event)) return null;
    this.move(this.time);
    this.onChange();
    return firstOf(this.tracks.get(0)!.session.info, kEventOf[event]);
  }

  /** The same, without a move. */
  private bringTogether(event: keyof typeof kEventOf): boolean {
    const first = this.tracks.get(0), second = this.tracks.get(1), kind = kEventOf[event];
    const here = first ? firstOf(first.session.info, kind) : null, there = second ? firstOf(second.session.info, kind) : null;
    if (here === null || there === null) return false;
    this.offset = there - here, this.path = null, this.aligned = event, this.left = null;
    return true;
  }

  /** Moves to a time of the session beside. Where the first one has nothing that belongs to it, both are brought together
      there, at the same place of the path. */
  moveBeside(time: number, { path_s }: ComparisonResult): void {
    if (this.left) Object.assign(this, this.left, { left: null }); // each moment is seen as it would be before the others
    const here = this.firstAt(time), first = this.tracks.get(0)!.session.info.duration_s;
    const belongs = here >= 0 && here <= first && Math.abs(this.besideAt(here) - time) < kTogether;
    if (!belongs && path_s.length > 0) {
      const { offset, path, aligned } = this;
      this.setOffset(time - Math.min(Math.max(alongPath(path_s, time, 1), 0), first));
      this.left = { offset, path, aligned };
    }
    this.move(this.firstAt(time));
    this.onChange();
  }

  play(): void {
    if (this.isPlaying || !this.tracks.has(0)) return;
    if (this.time >= this.span.to) this.goTo(this.span.from);
    this.isPlaying = true;
    this.playedAt = performance.now();
    this.steps = [];
    this.onChange();
    requestAnimationFrame(this.step);
  }

  pause(): void {
    this.isPlaying = false;
    this.onChange();
  }

  private readonly step = (): void => {
    if (!this.isPlaying) return;
    const now = performance.now();
    if (this.waiting.size === 0) {
      const by = Math.min((now - this.playedAt) / 1e3, kLongestStep) * this.speed;
      this.playedAt = now;
      this.goTo(Math.min(wholeMicroseconds(this.time + by), this.span.to));
      this.steps.push([now, by]);
      while (this.steps.length > 2 && now - this.steps[0][0] > 1000) this.steps.shift();
      const span = (now - this.steps[0][0]) / 1e3;
      this.reached = span > 0.3 ? this.steps.slice(1).reduce((sum, [, far]) => sum + far, 0) / span : this.speed;
      this.ask();
      this.onTime();
      if (this.time >= this.span.to) return this.pause();
    }
    requestAnimationFrame(this.step);
  };

  private ask(only?: number): void {
    for (const [stage, track] of this.tracks) {
      if (only !== undefined && stage !== only) continue;
      const { ticks, tick_s } = track.session.info;
      const tick = Math.min(Math.max(Math.round(this.timeOf(stage) / tick_s), 0), ticks);
      const request = ++this.request;
      this.asked.set(stage, request), this.unanswered.add(stage), this.unseen.add(stage), this.waiting.set(stage, request);
      this.connection.send({ show: { stage, tick, request } });
    }
  }

  /** Lets what waits for replayed pictures go on, if they are there. */
  private goOn(): void {
    if (this.waiting.size > 0) return;
    for (const each of this.whenReplayed.splice(0)) each();
  }

  private take(stage: number, message: Binary): void {
    if (message.kind === "shapes") this.tools.set(stage, message);
    const track = this.tracks.get(stage);
    if (!track) return;
    if (message.kind === "drawing") this.drawings.set(stage, message);
    else if (message.kind === "expert") track.scene.setExpert(message);
    else if (message.kind === "triangles") track.scene.setTriangles(message);
    else if (message.kind === "waiting") track.scene.wait(message), this.unanswered.delete(stage), this.drawTogether();
  }

  /** Pictures of two sessions that come one after the other are drawn once: each drawing takes all that is in it. */
  private drawTogether(): void {
    clearTimeout(this.drawing);
    if (this.unanswered.size === 0) this.viewer.draw();
    else this.drawing = setTimeout(() => this.viewer.draw(), kPatience);
  }

  private drew(stage: number, frame: Frame): void {
    const drawing = this.drawings.get(stage);
    this.onDrawing(stage, drawing?.request === frame.request ? drawing : null);
    if (this.asked.get(stage) === frame.request) this.unseen.delete(stage);
    if (this.waiting.get(stage) === frame.request && !frame.isGlimpse) this.waiting.delete(stage);
    this.viewer.isCovered = [...this.tracks.keys()].every((each) => this.drawings.get(each)?.request === this.tracks.get(each)?.scene.frame?.request);
    this.goOn();
    setTimeout(() => { // the picture is drawn by now
      const time = performance.now() - this.movedAt;
      if (this.unseen.size === 0) this.pictureAfter ??= time;
      if (this.waiting.size === 0) this.replayedAfter ??= time;
      this.onTime();
    });
    this.onTime();
  }
}

/** The other time of the pair in which one of them is `time`, on straight lines between the pairs; beyond them both go on alike. */
function alongPath(path: [number, number][], time: number, known: 0 | 1): number {
  const other = known === 0 ? 1 : 0, last = path[path.length - 1];
  if (time <= path[0][known]) return path[0][other] + time - path[0][known];
  if (time >= last[known]) return last[other] + time - last[known];
  let low = 0, high = path.length - 1; // the pair at `low` is at or before the time
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (path[middle][known] <= time) low = middle;
    else high = middle;
  }
  const from = path[low], to = path[high], span = to[known] - from[known];
  return span > 0 ? from[other] + ((time - from[known]) / span) * (to[other] - from[other]) : from[other];
}
