import * as three from "three";
import type { Connection } from "./connection";
import { readGamepad } from "./gamepad";
import { aboveOrgans, kClearance } from "./items";
import { Pace } from "./pace";
import { orientationOf } from "./pose";
import type { BegunTraining, Binary, CameraView, EndedTraining, Frame, HandFrame, Motion, SceneView, Vector } from "./protocol";
import { StageScene } from "./stage_scene";
import { Fall, ToolShadow } from "./tool_shadow";
import { firstCamera, type Viewer } from "./viewer";

export const kTrainStage = 2;
export const kGhostAhead = 0.25; // [s]
const kMostSpeed = 0.4; // of the hand that is sent [m/s]
const kGuardSpeed = 0.6; // faster motion counts as a jump [m/s]
const kInterval = 8; // between two poses [ms]
const kWheelStep = 0.0015; // of depth for a notch [m]
const kKeyStep = 0.001; // for a press of a key [m]
const kTurnStep = Math.PI / 36;
const kPadSpeed = 0.06, kPadTurn = Math.PI / 2; // of a stick or trigger that is fully pressed [m/s], [rad/s]
const kHalfGain = 6; // force at which the hand follows the pointer half as far [N]
const kFirm = 0.5; // share of what the hand bears, from which the pointer leads it no farther than it stretches the hand's spring
const kSpring = 1000, kSlack = 0.005; // of the program's spring between hand and tool, and how far it may lead beyond [N/m], [m]
const kGivesWay = 0.9; // share of what it bears, from which it is said to give way
const kEdge = 0.93; // of the picture that the hand may reach
const kTakeUp = 30; // from the tool to a pointer that takes it up [px]
const kSteep = 0.85; // cosine between up and the line of sight, beyond which the viewer looks from above
const kLookAhead = 1; // of the expert's motion [s]
const kNear = 0.03; // to the expert's path, to have reached it [m]
const kMargin = 0.06; // around the organs that the hand may use [m]
const kApart = 0.03; // of two hands from the middle [m]

/** A hand as the page leads it. */
interface LedHand {
  target: three.Vector3; // where the pointer wants it
  hand: three.Vector3;
  turn: three.Quaternion;
  tool: number; // -1: none
}

const makeHand = (): LedHand => ({ target: new three.Vector3(), hand: new three.Vector3(), turn: new three.Quaternion(), tool: 0 });

/** A session that mouse, keys and gamepad lead, or a device while the page looks on. */
export class Trainer {
  scene: StageScene | null = null;
  led = 0; // hand that mouse, keys and gamepad lead; the other one stays where it was left
  started: number | null = null; // when the hand was taken up [ms]
  poses = 0; // sent so far
  hasGamepad = false;
  hasBegun = false; // the hand has moved or was taken hold of, or a device leads: from then on its session runs
  ghostAhead = kGhostAhead; // of the place on the expert's path that the tool has reached [s]
  ghostAway: number | null = null; // from the tool [m]; null: there is no ghost
  awaited = ""; // where the device is that leads; empty: the page leads
  onWaiting: (why: string) => void = () => {}; // the device has sent nothing of use
  onFrame: () => void = () => {};
  onEnded: (ended: EndedTraining) => void = () => {};
  onNote: (text: string) => void = () => {}; // what is odd about the device
  onFailing: (problem: string) => void = () => {}; // what is recorded cannot be saved now
  isLedByKeys = false; // and not by the pointer since
  isLetGo = false; // by a key, with the pointer still in the picture
  gap: number | null = null; // from the tool straight down to the tissue [m]; Infinity: there is none; null: it touches or is in it
  pace = new Pace();
  private held = false;
  private shadow: ToolShadow | null = null;
  private isLive = false; // its frames come
  private bears = { force_n: Infinity, depth_m: 0 }; // the hand, before it gives way
  private camera = 0; // of the scene, through which the hand looked last
  private view: SceneView | null = null;
  private readonly hands = [makeHand(), makeHand()];
  private readonly box = new three.Box3();
  private motion: Motion | null = null;
  private sceneKey = ""; // of the scene in which the session runs
  private reached = 0; // pose of the expert's motion
  private timer: ReturnType<typeof setInterval> | null = null;
  private sentAt = 0;
  private pending: Binary[] = [];

  constructor(private readonly connection: Connection, private readonly viewer: Viewer) {
    connection.onStage(kTrainStage, (message) => (this.scene ? this.take(message) : this.pending.push(message)));
    viewer.onReady = () => {
      if (this.isLive) connection.send({ ready: { stage: kTrainStage } });
    };
    connection.onEvent("train_ended", (content) => {
      this.release();
      this.isLive = false;
      this.onEnded(content as EndedTraining);
    });
    connection.onEvent("train_waits", (content) => this.onWaiting((content as { text: string }).text));
    connection.onEvent("train_notes", (content) => this.onNote((content as { text: string }).text));
    connection.onEvent("train_fails", (content) => this.onFailing((content as { text: string }).text));
  }

  /** By the pointer, which the hand follows from then on. */
  get isHeld(): boolean {
    return this.held;
  }
  set isHeld(isHeld: boolean) {
    this.held = isHeld, this.isLedByKeys = this.isLetGo = false;
    this.hasBegun ||= isHeld;
  }

  /** By the pointer or by keys. */
  get isLed(): boolean {
    return this.held || this.isLedByKeys;
  }

  get isRunning(): boolean {
    return this.timer !== null;
  }

  private get own(): LedHand {
    return this.hands[this.led];
  }

  /** The tool in the hand that is led; -1: none. */
  get tool(): number {
    return this.own.tool;
  }

  /** Whether the other hand holds a tool, or one that does not go with it: one blade cuts at a time. */
  isTaken(tool: number): boolean {
    if (this.handCount < 2) return false;
    const tools = this.view!.tools, other = this.hands[1 - this.led].tool;
    return other === tool || (tools[other]?.kind === "scalpel" && tools[tool]?.kind === "scalpel");
  }

  get handCount(): number {
    return this.view?.hands ?? 1;
  }

  /** What the newest frame says of the hand that is led. */
  get ownFrame(): HandFrame | null {
    const frame = this.scene?.frame ?? null;
    return this.led === 1 ? (frame?.second ?? null) : frame;
  }

  /** Mouse, keys and gamepad lead the other hand from now on. */
  lead(hand: number): void {
    if (hand < this.handCount) this.led = hand;
    if (!this.hasBegun) this.showWaiting();
  }

  /** Loads a scene and takes the tools in the hands, unless a `device` leads. `text` is taken in place of its file's;
      `output` undefined: nothing is recorded. `seen`: from where; undefined: as firstCamera(). */
  async begin(scene: string, text: string | undefined, output: string | undefined, device: object | undefined, seen: CameraView | undefined, signal: AbortSignal): Promise<BegunTraining> {
    this.clear();
    const begun = await this.connection.call<BegunTraining>("train.begin",
      { scene, text, output, device, stage: kTrainStage, most_speed_m_per_s: kGuardSpeed }, { signal });
    this.isLive = true, this.awaited = begun.awaited, this.isHeld = false, this.hasBegun = begun.awaited !== "", this.sceneKey = begun.scene_key, this.bears = begun.gives_way;
    // A hand that is not led here leaves the mouse free to look around.
    const { controls } = this.viewer;
    controls.enableZoom = this.awaited !== "";
    controls.mouseButtons.LEFT = this.awaited ? three.MOUSE.ROTATE : null;
    controls.touches = { ONE: this.awaited ? three.TOUCH.ROTATE : null, TWO: three.TOUCH.DOLLY_ROTATE };
    this.view = begun.view;
    this.shadow = new ToolShadow(), this.pace = new Pace();
    this.scene = new StageScene(begun.view, this.shadow);
    this.scene.onFrame = (frame) => this.takeFrame(frame);
    this.viewer.set(kTrainStage, this.scene);
    const camera = seen ?? firstCamera(begun.view);
    if (camera) this.viewer.look(camera);
    this.camera = Math.max(0, begun.view.cameras.findIndex((own) => own === camera));
    for (const message of this.pending.splice(0)) this.take(message);
    if (!this.awaited) this.takeUp();
    return begun;
  }

  /** Takes away what is shown of a session. */
  clear(): void {
    this.release();
    this.viewer.set(kTrainStage, null);
    this.scene = null, this.ghostAway = null, this.isLive = false;
    this.pending = [];
  }

  /** Ends the session; what was recorded is saved before the call returns. */
  async end(): Promise<void> {
    this.release();
    await this.connection.call("train.end");
  }

  /** The expert's motion, shown as a pale tool a little ahead of the hand; null: none. */
  setExpert(motion: Motion | null): void {
    this.motion = motion;
    this.reached = 0;
    this.ghostAway = null;
    if (!motion) this.scene?.setGhost(null), this.viewer.draw();
  }

  setTool(tool: number): void {
    const count = this.view?.tools.length ?? 0;
    if (tool < count && !this.isTaken(tool)) this.own.tool = tool;
    if (this.hasBegun) this.send();
    else this.showWaiting();
  }

  /** Where the tool in the hand that is led is. */
  private get place(): three.Vector3 {
    const frame = this.ownFrame;
    return frame && frame.tool >= 0 ? new three.Vector3(...frame.position) : this.own.hand;
  }

  /** Looks straight down from the tool in the hand that is led, onto the tissue as it is drawn, and casts its shadow there. */
  lookDown(): void {
    const { scene, view, ownFrame: frame } = this;
    this.gap = null;
    if (!scene || !view) return;
    const up = new three.Vector3(...view.up), at = this.place, tool = frame && frame.tool >= 0 ? frame.tool : this.tool;
    const { radius_m = 0, kind } = view.tools[tool] ?? {}, radius = kind === "scalpel" ? 0 : radius_m;
    const isFree = this.isLive && tool >= 0 && (frame?.contacts ?? 0) === 0, fall = isFree ? scene.fall(new Fall(at, up, radius)) : null;
    this.shadow?.cast(at, up, radius, fall);
    if (fall && !fall.isInside) this.gap = fall.gap;
  }

  /** How large the tool in the hand that is led is drawn, from its place to its edge [px]. */
  get toolSize(): number {
    const { radius_m = 0, kind } = this.view?.tools[this.tool] ?? {};
    return kind === "scalpel" ? 0 : radius_m / this.metresPerPixel(this.place);
  }

  private metresPerPixel(at: three.Vector3): number {
    const { camera, canvas } = this.viewer;
    return (2 * camera.position.distanceTo(at) * Math.tan((camera.fov * Math.PI) / 360)) / canvas.clientHeight;
  }

  /** Where the tool in the hand that is led is drawn, in pixels of the picture; null: it is not in it. */
  get toolPixel(): { x: number; y: number } | null {
    const { canvas } = this.viewer, seen = this.viewer.pixelOf(this.place);
    return seen && seen.x >= 0 && seen.y >= 0 && seen.x <= canvas.clientWidth && seen.y <= canvas.clientHeight ? seen : null;
  }

  /** Takes the tool up where it is, with a pointer that comes to it at a place of the picture [px]. What holds it does not
      move it yet, so that it is never carried from where the pointer came in. */
  reach(x: number, y: number): void {
    if (this.isLetGo) return;
    const tool = this.toolPixel;
    this.isHeld ||= tool !== null && Math.hypot(tool.x - x, tool.y - y) < kTakeUp;
  }

  /** The tool stays where it is, wherever the pointer goes: until that holds it again, or has left the picture. */
  letGo(): void {
    this.isHeld = false, this.isLetGo = true;
  }

  /** The pointer has left the picture. */
  leave(): void {
    if (this.isHeld) this.isHeld = false;
    this.isLetGo = false;
  }

  /** Moves the hand in its plane, by pixels of the picture. */
  movePixels(right: number, down: number): void {
    const metres = this.metresPerPixel(this.own.hand) * this.gain();
    this.moveBy(right * metres, -down * metres, 0);
  }

  /** Moves the hand that is led here away from the viewer, by notches of the wheel. */
  moveDeep(notches: number): void {
    if (this.isLed) this.moveBy(0, 0, notches * kWheelStep * this.gain());
  }

  /** Does what a key says. False: nothing. */
  press(key: string, isFine: boolean): boolean {
    if (!this.isRunning) return false;
    const step = kKeyStep * (isFine ? 0.25 : 1);
    const moves: Record<string, [number, number, number]> = {
      ArrowLeft: [-step, 0, 0], ArrowRight: [step, 0, 0], ArrowUp: [0, step, 0], ArrowDown: [0, -step, 0],
      PageUp: [0, 0, step], PageDown: [0, 0, -step],
    };
    const turns: Record<string, [number, number, number]> = {
      q: [0, 0, 1], e: [0, 0, -1], w: [1, 0, 0], s: [-1, 0, 0], a: [0, 1, 0], d: [0, -1, 0],
    };
    const move = moves[key], turn = turns[key.toLowerCase()];
    if (move || turn) this.isLedByKeys ||= !this.isHeld;
    if (move) this.moveBy(...move);
    else if (turn) this.hasBegun = true, this.own.turn.multiply(new three.Quaternion().setFromAxisAngle(new three.Vector3(...turn), kTurnStep * (isFine ? 0.25 : 1)));
    else if (key.toLowerCase() === "x" && this.handCount > 1) this.lead(1 - this.led);
    else if (/^[1-9]$/.test(key)) this.setTool(Number(key) - 1);
    else if (key.toLowerCase() === "c") this.nextCamera();
    else return false;
    this.send();
    return true;
  }

  /** Looks through the scene's next camera. */
  nextCamera(): void {
    const cameras = this.view?.cameras ?? [];
    if (cameras.length > 0) this.viewer.look(cameras[(this.camera = (this.camera + 1) % cameras.length)]);
  }

  /** Name of the scene's camera through which the hand looked last. */
  get cameraName(): string {
    return this.view?.cameras[this.camera]?.name ?? "";
  }

  /** Moves the hand as a gamepad asks, for the time since the last pose. */
  private steer(): void {
    const pad = readGamepad();
    this.hasGamepad = pad !== null;
    if (!pad) return;
    this.hasBegun ||= Object.values(pad).some((way) => way !== 0);
    const time = Math.min(performance.now() - this.sentAt, 50) / 1e3, way = kPadSpeed * time * this.gain();
    if (pad.right || pad.up || pad.deep) this.shift(way * pad.right, way * pad.up, way * pad.deep);
    const turn = (axis: Vector, angle: number) => this.own.turn.multiply(new three.Quaternion().setFromAxisAngle(new three.Vector3(...axis), angle));
    if (pad.turnUp) turn([1, 0, 0], kPadTurn * time * pad.turnUp);
    if (pad.turnRight) turn([0, 1, 0], kPadTurn * time * pad.turnRight);
    if (pad.nextTool) this.stepTool(pad.nextTool);
  }

  /** Takes the next tool, or the previous one, that the other hand leaves free. */
  private stepTool(by: number): void {
    const count = this.view?.tools.length ?? 0;
    for (let i = 0, tool = this.tool; i < count; ++i) {
      tool = (tool + by + count) % count;
      if (!this.isTaken(tool)) return void (this.own.tool = tool);
    }
  }

  /** What the hand bears, if it gives way now. */
  get givesWay(): { force_n: number } | { depth_m: number } | null {
    const { force_n, depth_m } = this.bears, frame = this.ownFrame;
    if (!frame || this.awaited) return null;
    if (depth_m > 0 && this.pressedDepth >= depth_m) return { depth_m };
    return Math.hypot(...frame.force) >= kGivesWay * force_n ? { force_n } : null;
  }

  /** How deep the tool dents the tissue [m]; a blade parts it. */
  private get pressedDepth(): number {
    const frame = this.ownFrame;
    return frame && this.view?.tools[frame.tool]?.kind !== "scalpel" ? frame.depth : 0;
  }

  /** The hand follows the pointer less where the tissue resists. */
  private gain(): number {
    const frame = this.ownFrame;
    return frame ? 1 / (1 + Math.hypot(...frame.force) / kHalfGain) : 1;
  }

  private moveBy(right: number, up: number, deep: number): void {
    if (!this.isRunning) return;
    this.hasBegun = true;
    this.shift(right, up, deep);
    this.send();
  }

  private shift(right: number, up: number, deep: number): void {
    const axes = this.handAxes();
    const { target } = this.own;
    target.addScaledVector(axes.right, right).addScaledVector(axes.up, up).addScaledVector(axes.deep, deep);
    this.box.clampPoint(target, target);
    this.keepInView();
    this.keepNearTool();
  }

  /** Where the tissue resists firmly the hand stays near its tool: what it gives way by need not come back first. */
  private keepNearTool(): void {
    const frame = this.ownFrame, force = Math.hypot(...(frame?.force ?? [0])), { force_n, depth_m } = this.bears;
    if (!frame || (force < kFirm * force_n && (depth_m === 0 || this.pressedDepth < kFirm * depth_m))) return;
    const { target } = this.own, tool = new three.Vector3(...frame.position);
    target.sub(tool).clampLength(0, force / kSpring + kSlack).add(tool);
  }

  /** Directions of the hand: an upright plane that faces the viewer, so that down presses; from above, the picture's. */
  private handAxes(): { right: three.Vector3; up: three.Vector3; deep: three.Vector3 } {
    const right = new three.Vector3(), upInPicture = new three.Vector3(), back = new three.Vector3();
    this.viewer.camera.matrixWorld.extractBasis(right, upInPicture, back);
    const up = new three.Vector3(...this.view!.up);
    if (Math.abs(up.dot(back)) > kSteep) up.copy(upInPicture);
    return { right, up, deep: new three.Vector3().crossVectors(up, right).normalize() };
  }

  /** The hand stays in the picture, where it can be seen. */
  private keepInView(): void {
    const { camera } = this.viewer;
    const { target } = this.own;
    const seen = target.clone().project(camera);
    const x = Math.min(Math.max(seen.x, -kEdge), kEdge), y = Math.min(Math.max(seen.y, -kEdge), kEdge);
    if (x !== seen.x || y !== seen.y) target.set(x, y, seen.z).unproject(camera);
  }

  /** Puts each hand where the scene says that its first tool is taken up, else above the organs, two beside each other. */
  private takeUp(): void {
    const view = this.view!;
    const up = new three.Vector3(...view.up);
    this.box.set(new three.Vector3(...view.least), new three.Vector3(...view.most));
    const right = new three.Vector3().setFromMatrixColumn(this.viewer.camera.matrixWorld, 0), above = aboveOrgans(view);
    for (const own of this.hands) own.tool = -1;
    for (let hand = this.handCount - 1; hand >= 0; --hand) {
      this.led = hand;
      const { own } = this;
      own.tool = view.tools.findIndex((tool, i) => tool.kind !== "pin" && !this.isTaken(i) && i >= hand);
      const held = view.tools[own.tool];
      if (held?.at) {
        own.target.set(...held.at);
        own.turn.copy(orientationOf(held.pointing ?? [0, 0, -1], held.facing));
        this.box.expandByPoint(own.target);
      } else {
        own.target.copy(above).addScaledVector(up, (held?.radius_m ?? 0) + kClearance);
        if (this.handCount > 1) own.target.addScaledVector(right, hand === 0 ? kApart : -kApart);
        own.turn.setFromUnitVectors(new three.Vector3(0, 0, 1), up);
      }
      own.hand.copy(own.target);
    }
    this.box.expandByScalar(kMargin);
    this.started = performance.now();
    this.sentAt = performance.now();
    this.poses = 0;
    this.reached = 0;
    this.timer = setInterval(() => (this.steer(), this.send()), kInterval);
    this.showWaiting();
  }

  private release(): void {
    if (this.timer !== null) clearInterval(this.timer);
    this.timer = null;
  }

  /** Draws the tools where they wait for their hands. */
  private showWaiting(): void {
    this.scene?.showTools(this.hands.slice(0, this.handCount));
    this.viewer.draw();
  }

  private send(): void {
    if (!this.isRunning) return;
    if (!this.hasBegun) return;
    const now = performance.now();
    const reach = (kMostSpeed * Math.min(now - this.sentAt, 50)) / 1e3;
    this.sentAt = now;
    ++this.poses;
    const [first, second] = this.hands.map(({ target, hand, turn, tool }) => {
      hand.add(new three.Vector3().subVectors(target, hand).clampLength(0, reach));
      return { position: hand.toArray(), orientation: [turn.w, turn.x, turn.y, turn.z], buttons: tool >= 0 ? 2 ** tool : 0 };
    });
    this.connection.send({ hand: { ...first, time_s: now / 1e3, ...(this.handCount > 1 ? { second } : {}) } });
  }

  private take(message: Binary): void {
    const scene = this.scene!;
    if (message.kind === "shapes") scene.setShapes(message);
    else if (message.kind === "triangles") scene.setTriangles(message);
    else if (message.kind === "waiting") scene.wait(message), this.viewer.draw();
  }

  /** Whether the expert's session is of another scene, where its ghost would lead through other tissue. */
  get isExpertOfOtherScene(): boolean {
    return this.motion !== null && this.scene !== null && this.motion.scene_key !== this.sceneKey;
  }

  /** The expert's pose a little ahead of the place on the path that the tool has reached; it never goes back. */
  private expertNear(tool: Vector): number[] | null {
    const { poses, interval_s } = this.motion!;
    const end = Math.min(poses.length, this.reached + Math.ceil(kLookAhead / interval_s));
    let best = kNear;
    for (let i = this.reached; i < end; ++i) {
      const away = distance(poses[i], tool);
      if (poses[i][0] >= 0 && away < best) best = away, this.reached = i;
    }
    return poses[Math.min(poses.length - 1, this.reached + Math.round(this.ghostAhead / interval_s))] ?? null;
  }

  private takeFrame(frame: Frame): void {
    this.pace.add(frame);
    if (this.motion && this.scene && !this.isExpertOfOtherScene) {
      const pose = this.expertNear(frame.position);
      this.scene.setGhost(pose);
      this.ghostAway = pose && pose[0] >= 0 ? distance(pose, frame.position) : null;
    }
    if (!this.hasBegun) this.scene?.showTools(this.hands.slice(0, this.handCount));
    this.onFrame();
  }
}

/** From a pose of an expert's motion to a place [m]. */
function distance(pose: number[], [x, y, z]: Vector): number {
  return Math.hypot(pose[1] - x, pose[2] - y, pose[3] - z);
}
