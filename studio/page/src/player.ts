import type { Binary, Connection } from "./connection";
import type { Frame, OpenedSession, SessionInfo, TimelineData, Shapes } from "./protocol";
import { StageScene } from "./stage_scene";
import type { Viewer } from "./viewer";

/** A session on the page. Stage 0 is the one in review, stage 1 the one beside it. */
export interface Track {
  stage: number;
  session: OpenedSession;
  timeline: TimelineData | null;
  scene: StageScene;
}

/** Longest step of a playback [s]: where the program simulates slower, playing becomes slower instead of jumping. */
const kLongestStep = 0.1;

/** When an event of that kind first happened [s]; null: never. */
export function firstOf(info: SessionInfo, kind: string): number | null {
  const event = info.events.find((e) => e.kind === kind);
  return event ? event.tick * info.tick_s : null;
}

/** The clock of a review: moves to a moment, plays, and asks the program for one picture at a time. */
export class Player {
  readonly tracks = new Map<number, Track>();
  time = 0; // of stage 0 [s]
  speed = 1;
  offset = 0; // time of stage 1 where that of stage 0 is 0 [s]
  isPlaying = false;
  pictureAfter: number | null = null; // time from the last move to its picture [ms]
  reached = 0; // speed of the playback in the last second
  onChange: () => void = () => {};
  onTime: () => void = () => {};
  private readonly waiting = new Map<number, number>(); // request of each stage that has no picture yet
  private readonly tools = new Map<number, Shapes>();
  private request = 0;
  private movedAt = 0;
  private playedAt = 0;
  private steps: [number, number][] = []; // of the playback: when [ms], how far [s]

  constructor(private readonly connection: Connection, readonly viewer: Viewer) {
    for (const stage of [0, 1]) connection.onStage(stage, (message) => this.take(stage, message));
  }

  async open(stage: number, path: string): Promise<Track> {
    this.close(stage);
    const connection = this.connection;
    const session = await connection.call<OpenedSession>("session.open", { path, stage });
    const track: Track = { stage, session, timeline: null, scene: new StageScene(session.view) };
    const tools = this.tools.get(stage); // they come before the answer
    if (tools) track.scene.setShapes(tools);
    track.scene.onFrame = (frame) => this.drew(stage, frame);
    this.tracks.set(stage, track);
    this.viewer.set(stage, track.scene);
    if (stage === 0) {
      this.time = 0;
      const camera = session.view.cameras[0];
      if (camera) this.viewer.look(camera);
    }
    track.timeline = await connection.call<TimelineData>("session.timeline", { path, points: 3000 });
    this.move(this.time);
    return track;
  }

  close(stage: number): void {
    if (!this.tracks.delete(stage)) return;
    this.waiting.delete(stage);
    this.viewer.set(stage, null);
    this.connection.call("session.close", { stage }).catch(() => {});
    this.onChange();
  }

  /** The times that can be shown, of stage 0: until both sessions have ended, and from where the first of them begins. */
  get span(): { from: number; to: number } {
    const first = this.tracks.get(0)?.session.info.duration_s ?? 0, second = this.tracks.get(1)?.session.info.duration_s;
    if (second === undefined) return { from: 0, to: first };
    return { from: Math.min(0, -this.offset), to: Math.max(first, second - this.offset) };
  }

  /** The time of a stage's own session. */
  timeOf(stage: number): number {
    return stage === 0 ? this.time : this.time + this.offset;
  }

  move(time: number): void {
    const { from, to } = this.span;
    this.time = Math.min(Math.max(Math.round(1e6 * time) / 1e6, from), to); // whole microseconds
    this.movedAt = performance.now();
    this.pictureAfter = null;
    this.ask();
    this.onTime();
  }

  setOffset(offset: number): void {
    this.offset = offset;
    this.move(this.time);
    this.onChange();
  }

  /** Aligns both sessions where an event of that kind first happened. Null: one of them has none. */
  alignAt(kind: string): number | null {
    const first = this.tracks.get(0), second = this.tracks.get(1);
    const here = first ? firstOf(first.session.info, kind) : null, there = second ? firstOf(second.session.info, kind) : null;
    if (here === null || there === null) return null;
    this.setOffset(there - here);
    return here;
  }

  play(): void {
    if (this.isPlaying || !this.tracks.has(0)) return;
    if (this.time >= this.span.to) this.time = this.span.from;
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
      this.time = Math.min(this.time + by, this.span.to);
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

  private ask(): void {
    for (const [stage, track] of this.tracks) {
      const { ticks, tick_s } = track.session.info;
      const tick = Math.min(Math.max(Math.round(this.timeOf(stage) / tick_s), 0), ticks);
      const request = ++this.request;
      this.waiting.set(stage, request);
      this.connection.send({ show: { stage, tick, request } });
    }
  }

  private take(stage: number, message: Binary): void {
    if (message.kind === "shapes") this.tools.set(stage, message);
    const track = this.tracks.get(stage);
    if (!track) return;
    if (message.kind === "triangles") track.scene.setTriangles(message);
    else if (message.kind === "waiting") track.scene.wait(message), this.viewer.draw();
  }

  private drew(stage: number, frame: Frame): void {
    if (this.waiting.get(stage) === frame.request) this.waiting.delete(stage);
    if (this.waiting.size === 0 && this.pictureAfter === null)
      setTimeout(() => {
        this.pictureAfter ??= performance.now() - this.movedAt; // the picture is drawn by now
        this.onTime();
      });
    this.onTime();
  }
}
