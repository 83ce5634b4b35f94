// The scene that an author works on: its text, and what the program makes of it, kept together while the text changes.
import type { JSONPath } from "jsonc-parser";
import * as three from "three";
import { takenAlong } from "./belongings";
import type { Connection } from "./connection";
import { SceneDocument } from "./document";
import { dropKept, moveKept } from "./drafts";
import { type Item, itemsOf, listOf, type OrganPose, organPoses } from "./items";
import { findJson, type Json } from "./json_edit";
import { CallFailed, type Problem, type SceneView, type Shapes, type Spheres, type TissueSpheres, type Triangles, type WaitingFrame } from "./protocol";
import { type Schema, schemaAt } from "./scene_schema";
import { StageScene, type Shown } from "./stage_scene";
import { firstCamera, type Viewer } from "./viewer";

export const kAuthorStage = 3;
const kCheckAfter = 250, kShowAfter = 300; // without a change [ms]

export interface Finding {
  code: string;
  found: string;
  done: string;
  remains: string;
}
export interface ShownOrgan {
  spheres: number;
  anchored: number;
  shape_error: string; // in the command's words; empty: a rig
  thin_parts: string; // the same; empty: none is too thin for its spheres
  report: string;
  findings: Finding[];
  tissues: TissueSpheres[]; // of its layers of tissue, outermost first, and of what lies below
}
export interface ShownScene {
  view: SceneView;
  organs: ShownOrgan[];
  spheres: number;
  elements: number;
  warnings: Problem[];
}
export interface TickTime {
  measured_tick_time_s: number;
  tick_s: number;
  ticks: number;
  warnings: Problem[]; // of how the scene stands once it has settled
}
interface Checked {
  errors: Problem[];
  warnings: Problem[];
}

/** What the simulation depends on: a change of anything else does not load the scene again. */
function simulatedPart(value: Json | undefined): string {
  const { cameras, probes, forbidden, name, task, tools, ...rest } = (value ?? {}) as { [key: string]: Json };
  const shapes = listOf({ tools }, "tools").map(({ at_mm, pointing, facing, ...shape }) => shape);
  return JSON.stringify([rest, shapes]);
}

function middleOf(centres: Float32Array): three.Vector3 {
  const box = new three.Box3().setFromArray(centres);
  return box.getCenter(new three.Vector3());
}

/** Scenes that were open, those that were removed in this page by where they are. */
const documents = new Map<string, SceneDocument>();
const kOpen = "ctpm.scene"; // what this tab shows, also after the page was loaded again
let lastOpen = sessionStorage.getItem(kOpen) ?? "";
function remember(path: string): void {
  lastOpen = path;
  sessionStorage.setItem(kOpen, path);
}

/** A scene's history and its draft go where its file goes. */
function moveDocument(from: string, to: string): void {
  const doc = documents.get(from);
  doc?.keepHistory();
  moveKept(from, to);
  documents.delete(from);
  if (doc) documents.set(to, doc);
  else documents.delete(to);
}

export class AuthorScene {
  onChange: () => void = () => {};
  doc: SceneDocument | null = null;
  shown: ShownScene | null = null;
  stage: StageScene | null = null;
  how: Shown = "surface";
  isTakingAlong = true; // what belongs to an organ goes with it
  error: Error | null = null; // why the text cannot be loaded
  isLoading = false;
  filled: number | null = null; // share of the organs' meshes that are filled; null: not told yet
  measured: { done: number; most: number } | null = null; // ticks so far while the time of a tick is measured
  tickTime: TickTime | null = null; // of what is shown; null: not measured yet
  private checked: Checked | null = null;
  private schema: Schema | null = null;
  private shownPart = "";
  private isUnchecked = false; // the text, as it is now
  private isUnshown = false; // and what it simulates
  private running: { part: string; stop: AbortController } | null = null; // a load
  private measuring: AbortController | null = null;
  private timers: { check?: ReturnType<typeof setTimeout>; show?: ReturnType<typeof setTimeout> } = {};
  private received: (Shapes | Spheres | Triangles | WaitingFrame)[] = [];
  private poses: OrganPose[] = []; // of the organs that are shown
  private middles: three.Vector3[] = []; // of their spheres, in their meshes
  private onFrame: () => void = () => {};
  private held = ""; // what hold() told

  constructor(private readonly connection: Connection, private readonly viewer: Viewer) {
    connection.call<Schema>("scene.schema").then((schema) => (this.schema = schema), () => {});
    connection.onStage(kAuthorStage, (message) => {
      if (message.kind !== "drawing" && message.kind !== "expert") this.received.push(message);
      if (message.kind === "waiting") this.onFrame();
    });
  }

  /** The scene that was open when the author left the room, or loaded the page again; empty: none. */
  static get lastOpen(): string {
    return lastOpen;
  }

  /** Opens a scene, with the history that it had if it was open before. */
  async open(path: string): Promise<void> {
    if (this.isLoading && !this.doc && lastOpen === path) return; // it is on its way
    this.doc?.commit();
    const known = documents.get(path);
    this.close();
    remember(path);
    this.isLoading = true;
    this.onChange();
    try {
      const doc = known ?? (await SceneDocument.open(this.connection, path, () => this.schema));
      documents.set(path, doc);
      doc.connection = this.connection; // the program may have been started again
      doc.onChange = () => this.changed();
      this.doc = doc;
      this.changed();
      if (!this.isUnshown && !this.running) this.isLoading = false, this.onChange(); // its text has nothing to show yet
    } catch (failure) {
      this.isLoading = false, this.error = failure as Error;
      this.onChange();
    }
  }

  /** Others may rename and remove what this page does not show, unless it has changes that are not saved. */
  private letGo(): void {
    this.connection.callInTurn(kAuthorStage, "scene.close", {}).catch(() => {});
  }
  private hold(): void {
    const paths = [...documents].filter(([path, doc]) => path === doc.path && doc.isChanged).map(([path]) => path);
    if (JSON.stringify(paths) === this.held) return;
    this.held = JSON.stringify(paths);
    this.connection.call("scene.hold", { paths }).catch(() => {});
  }

  /** Shows no scene. */
  private close(): void {
    for (const timer of Object.values(this.timers)) clearTimeout(timer);
    this.endWork();
    if (lastOpen) this.letGo();
    remember("");
    this.doc = null, this.shown = null, this.error = null, this.tickTime = null, this.checked = null, this.shownPart = "", this.filled = null;
    this.viewer.set(kAuthorStage, null);
    this.stage = null;
  }

  /** A scene's file has another name now: its history and its draft go with it. */
  renamed(from: string, to: string): void {
    moveDocument(from, to);
    const doc = documents.get(to);
    if (!doc) return;
    doc.path = to;
    this.hold();
    if (this.doc !== doc) return;
    remember(to), this.shownPart = ""; // the program shows it by its new name
    this.endWork();
    this.changed();
  }

  /** A scene's file is below `folder` now. Its history and its draft go with it, for restored(). Whether it was open. */
  removed(path: string, folder: string): boolean {
    const wasOpen = this.doc?.path === path;
    if (wasOpen) this.close();
    moveDocument(path, `${folder}/${path}`);
    this.hold();
    this.onChange();
    return wasOpen;
  }

  /** It is there again. */
  restored(path: string, folder: string): void {
    moveDocument(`${folder}/${path}`, path);
    this.hold();
  }

  /** It is gone for good. */
  deleted(path: string, folder: string): void {
    dropKept(`${folder}/${path}`);
    documents.delete(`${folder}/${path}`);
  }

  /** What the text says at a path, else what the program takes where nothing is said. */
  settingAt(path: JSONPath): Json | undefined {
    return findJson(this.doc?.lastValue, path) ?? (this.schema ? (schemaAt(this.schema, path)?.default as Json | undefined) : undefined);
  }

  get items(): Item[] {
    return itemsOf(this.doc?.lastValue, this.shown?.view ?? null, this.middles);
  }

  /** Whether what is said and shown may still be of a text before. */
  get isBehind(): boolean {
    return this.isUnchecked || this.isRefilling;
  }
  /** The same of what is shown alone. */
  get isRefilling(): boolean {
    return this.isUnshown || this.isLoading;
  }

  /** What is done while the organs are filled, with its number once that is known. */
  get fillingText(): string {
    return this.filled === null ? "filling" : `filling ${Math.round(100 * this.filled)} %`;
  }
  /** The same while the time of a tick is measured: in ticks, of which it may need fewer. */
  get measuringText(): string {
    return this.measured ? `measuring, ${this.measured.done} of at most ${this.measured.most} ticks` : "measuring";
  }

  /** Errors and warnings of the text, as they are known now. */
  get problems(): Checked {
    const load = this.error instanceof CallFailed ? this.error.problems : [];
    const errors = this.checked?.errors.length ? this.checked.errors : load;
    return { errors, warnings: errors.length ? this.checked?.warnings ?? [] : [...this.shown?.warnings ?? this.checked?.warnings ?? [], ...this.tickTime?.warnings ?? []] };
  }

  /** Draws the organs where the text has them by now. */
  poseOrgans(): void {
    const poses = organPoses(this.doc?.lastValue);
    this.poses.forEach((was, i) => poses[i] && this.stage?.poseOrgan(i, was, poses[i]));
  }

  /** Changes values while a change goes on, as the document's preview() does; an organ takes along what belongs to it. */
  preview(values: [JSONPath, Json | undefined][]): void {
    const { doc, stage } = this;
    if (!doc || doc.begun === undefined) return; // while its text is no JSON, nothing in it has a value
    doc.preview([...values, ...(this.isTakingAlong && stage ? takenAlong(values, doc.begun, stage.organSpheres, this.poses) : [])]);
  }

  show(how: Shown): void {
    this.how = how;
    this.stage?.show(how);
    this.viewer.draw();
    this.onChange();
  }

  private changed(): void {
    const { doc } = this;
    if (!doc) return;
    this.hold();
    clearTimeout(this.timers.check);
    this.isUnchecked = true;
    this.timers.check = setTimeout(() => void this.check(doc), kCheckAfter);
    clearTimeout(this.timers.show);
    this.isUnshown = this.isOutdated;
    if (this.isUnshown) {
      this.endWork();
      this.timers.show = setTimeout(() => void this.load(), this.shown ? kShowAfter : 0);
    } else this.goOn();
    this.onChange();
  }

  /** Whether what is shown, or is being loaded, is another scene than the text says by now. */
  private get isOutdated(): boolean {
    const { doc, running } = this, part = running && !running.stop.signal.aborted ? running.part : this.shownPart;
    return doc?.value !== undefined && simulatedPart(doc.value) !== part;
  }

  /** What is measured or loaded now is outdated. */
  private endWork(): void {
    this.measuring?.abort();
    this.running?.stop.abort();
  }

  /** Does what is to do once the text has stopped changing: a change that was taken back may have ended a load or a measurement. */
  private goOn(): void {
    if (!this.doc || this.running || this.isUnshown) return;
    if (this.isOutdated) void this.load();
    else if (this.stage && !this.tickTime && this.measuring?.signal.aborted) void this.measure();
  }

  private async check(doc: SceneDocument): Promise<void> {
    const { text } = doc;
    try {
      const checked = await this.connection.call<Checked>("scene.check", { path: doc.path, text });
      if (this.doc !== doc || doc.text !== text) return;
      this.checked = checked;
    } catch (failure) {
      this.error = failure as Error;
    }
    this.isUnchecked = false;
    this.underline();
    this.onChange();
  }

  private underline(): void {
    const { errors, warnings } = this.problems;
    this.doc?.underline(errors, warnings);
  }

  /** Loads the text as it is now. One load at a time: its pictures must not mix with those of another. */
  private async load(): Promise<void> {
    this.isUnshown = false;
    const { doc } = this;
    if (!doc || this.running) return; // the end of the one before goes on
    const stop = new AbortController(), part = simulatedPart(doc.value), poses = organPoses(doc.value);
    this.running = { part, stop };
    this.isLoading = true, this.received = [], this.filled = null;
    this.onChange();
    const progress = (done: number, total: number) => {
      this.filled = done / total;
      this.onChange();
    };
    try {
      const frame = new Promise<void>((resolve) => (this.onFrame = resolve));
      const shown = await this.connection.callInTurn<ShownScene>(kAuthorStage, "scene.show", { path: doc.path, text: doc.text }, () => !stop.signal.aborted, { signal: stop.signal, progress });
      if (shown) await frame;
      if (shown && this.doc === doc) this.take(shown, part, poses);
    } catch (failure) {
      if (!stop.signal.aborted && this.doc === doc) this.error = failure as Error, this.shownPart = part;
    }
    this.running = null, this.isLoading = false;
    this.goOn();
    this.underline();
    this.onChange();
  }

  private take(shown: ShownScene, part: string, poses: OrganPose[]): void {
    const isFirst = !this.shown, had = this.shown?.view.organs.length ?? 0;
    const stage = new StageScene(shown.view);
    for (const message of this.received.splice(0))
      if (message.kind === "shapes") stage.setShapes(message);
      else if (message.kind === "spheres") stage.setSpheres(message, shown.organs.map(({ tissues }) => tissues));
      else if (message.kind === "triangles") stage.setTriangles(message);
      else stage.wait(message);
    stage.takeFrame();
    stage.show(this.how);
    this.viewer.set(kAuthorStage, stage);
    this.stage = stage, this.shown = shown, this.shownPart = part, this.poses = poses, this.error = null;
    this.middles = stage.organSpheres.map((organ, i) => {
      const { place, turn, scale } = poses[i];
      return middleOf(organ.centre).sub(place).applyQuaternion(turn.clone().invert()).divideScalar(scale);
    });
    // A scene is seen by its first camera; when an organ came, by the one that sees everything.
    const camera = isFirst ? firstCamera(shown.view) : shown.view.organs.length > had ? shown.view.cameras.at(-1) : undefined;
    if (camera) this.viewer.look(camera);
    void this.measure();
  }

  private async measure(): Promise<void> {
    this.tickTime = this.measured = null;
    const stop = (this.measuring = new AbortController());
    const progress = (done: number, most: number) => {
      if (this.measuring !== stop) return;
      this.measured = { done, most };
      this.onChange();
    };
    try {
      const time = await this.connection.call<TickTime>("scene.measure", { stage: kAuthorStage }, { signal: stop.signal, progress });
      if (this.measuring === stop && !stop.signal.aborted) this.tickTime = time, this.underline();
    } catch {
      // It was stopped because the scene changed.
    }
    this.onChange();
  }

  dispose(): void {
    for (const timer of Object.values(this.timers)) clearTimeout(timer);
    this.doc = null; // nothing goes on
    this.endWork();
    this.letGo();
    for (const doc of documents.values()) doc.commit(), (doc.onChange = () => this.hold()); // one may be being saved
  }
}
