import * as three from "three";
import type { Binary, Connection } from "./connection";
import { readGamepad } from "./gamepad";
import { orientationOf } from "./pose";
import type { BegunTraining, EndedTraining, Frame, Motion, SceneView, Vector } from "./protocol";
import { StageScene } from "./stage_scene";
import type { Viewer } from "./viewer";

export const kTrainStage = 2;
const kMostSpeed = 0.4; // of the hand that is sent [m/s]
const kGuardSpeed = 0.6; // faster motion counts as a jump [m/s]
const kInterval = 8; // between two poses [ms]
const kWheelStep = 0.0015; // of depth for a notch [m]
const kKeyStep = 0.001; // for a press of a key [m]
const kTurnStep = Math.PI / 36;
const kPadSpeed = 0.06, kPadTurn = Math.PI / 2; // of a stick or trigger that is fully pressed [m/s], [rad/s]
const kHalfGain = 6; // force at which the hand follows the pointer half as far [N]
const kEdge = 0.93; // of the picture that the hand may reach
const kSteep = 0.85; // cosine between up and the line of sight, beyond which the viewer looks from above
const kLookAhead = 1, kAhead = 0.25; // of the expert's motion [s]
const kNear = 0.03; // to the expert's path, to have reached it [m]
const kMargin = 0.06; // around the organs that the hand may use [m]

/** A session that mouse and keys lead. */
export class Trainer {
  scene: StageScene | null = null;
  tool = 0; // -1: none
  started: number | null = null; // when the hand was taken up [ms]
  poses = 0; // sent so far
  hasGamepad = false;
  onFrame: () => void = () => {};
  onEnded: (ended: EndedTraining) => void = () => {};
  onFailing: (problem: string) => void = () => {}; // what is recorded cannot be saved now
  private view: SceneView | null = null;
  private readonly target = new three.Vector3();
  private readonly hand = new three.Vector3();
  private readonly turn = new three.Quaternion();
  private readonly box = new three.Box3();
  private motion: Motion | null = null;
  private reached = 0; // pose of the expert's motion
  private timer: ReturnType<typeof setInterval> | null = null;
  private sentAt = 0;
  private pending: Binary[] = [];

  constructor(private readonly connection: Connection, private readonly viewer: Viewer) {
    connection.onStage(kTrainStage, (message) => (this.scene ? this.take(message) : this.pending.push(message)));
    connection.onEvent("train_ended", (content) => {
      this.release();
      this.onEnded(content as EndedTraining);
    });
    connection.onEvent("train_fails", (content) => this.onFailing((content as { text: string }).text));
  }

  get isRunning(): boolean {
    return this.timer !== null;
  }

  /** Loads a scene and takes the tool in the hand. `text` is taken in place of its file's; `output` undefined: nothing is recorded. */
  async begin(scene: string, text: string | undefined, output: string | undefined, signal: AbortSignal): Promise<BegunTraining> {
    this.release();
    this.viewer.set(kTrainStage, null);
    this.scene = null;
    this.pending = [];
    const begun = await this.connection.call<BegunTraining>("train.begin",
      { scene, text, output, stage: kTrainStage, most_speed_m_per_s: kGuardSpeed }, { signal });
    this.view = begun.view;
    this.scene = new StageScene(begun.view);
    this.scene.onFrame = (frame) => this.showGhost(frame);
    this.viewer.set(kTrainStage, this.scene);
    const camera = begun.view.cameras[0];
    if (camera) this.viewer.look(camera);
    for (const message of this.pending.splice(0)) this.take(message);
    this.takeUp();
    return begun;
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
    if (!motion) this.scene?.setGhost(null);
  }

  setTool(tool: number): void {
    const count = this.view?.tools.length ?? 0;
    if (tool < count) this.tool = tool;
    this.send();
  }

  /** Moves the hand in its plane, by pixels of the picture. */
  movePixels(right: number, down: number): void {
    const { camera, canvas } = this.viewer;
    const away = camera.position.distanceTo(this.hand);
    const metres = ((2 * away * Math.tan((camera.fov * Math.PI) / 360)) / canvas.clientHeight) * this.gain();
    this.moveBy(right * metres, -down * metres, 0);
  }

  /** Moves the hand away from the viewer, by notches of the wheel. */
  moveDeep(notches: number): void {
    this.moveBy(0, 0, notches * kWheelStep * this.gain());
  }

  /** Does what a key says. False: nothing. */
  press(key: string, isFine: boolean): boolean {
    const step = kKeyStep * (isFine ? 0.25 : 1);
    const moves: Record<string, [number, number, number]> = {
      ArrowLeft: [-step, 0, 0], ArrowRight: [step, 0, 0], ArrowUp: [0, step, 0], ArrowDown: [0, -step, 0],
      PageUp: [0, 0, step], PageDown: [0, 0, -step],
    };
    const turns: Record<string, [number, number, number]> = {
      q: [0, 0, 1], e: [0, 0, -1], w: [1, 0, 0], s: [-1, 0, 0], a: [0, 1, 0], d: [0, -1, 0],
    };
    const move = moves[key], turn = turns[key.toLowerCase()];
    if (move) this.moveBy(...move);
    else if (turn) this.turn.multiply(new three.Quaternion().setFromAxisAngle(new three.Vector3(...turn), kTurnStep * (isFine ? 0.25 : 1)));
    else if (/^[1-9]$/.test(key)) this.setTool(Number(key) - 1);
    else return false;
    this.send();
    return true;
  }

  /** Moves the hand as a gamepad asks, for the time since the last pose. */
  private steer(): void {
    const pad = readGamepad();
    this.hasGamepad = pad !== null;
    if (!pad) return;
    const time = Math.min(performance.now() - this.sentAt, 50) / 1e3, way = kPadSpeed * time * this.gain();
    if (pad.right || pad.up || pad.deep) this.shift(way * pad.right, way * pad.up, way * pad.deep);
    const turn = (axis: Vector, angle: number) => this.turn.multiply(new three.Quaternion().setFromAxisAngle(new three.Vector3(...axis), angle));
    if (pad.turnUp) turn([1, 0, 0], kPadTurn * time * pad.turnUp);
    if (pad.turnRight) turn([0, 1, 0], kPadTurn * time * pad.turnRight);
    const count = this.view?.tools.length ?? 0;
    if (pad.nextTool && count > 0) this.tool = (this.tool + pad.nextTool + count) % count;
  }

  /** The hand follows the pointer less where the tissue resists. */
  private gain(): number {
    const frame = this.scene?.frame;
    return frame ? 1 / (1 + Math.hypot(...frame.force) / kHalfGain) : 1;
  }

  private moveBy(right: number, up: number, deep: number): void {
    if (!this.isRunning) return;
    this.shift(right, up, deep);
    this.send();
  }

  private shift(right: number, up: number, deep: number): void {
    const axes = this.handAxes();
    this.target.addScaledVector(axes.right, right).addScaledVector(axes.up, up).addScaledVector(axes.deep, deep);
    this.box.clampPoint(this.target, this.target);
    this.keepInView();
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
    const seen = this.target.clone().project(camera);
    const x = Math.min(Math.max(seen.x, -kEdge), kEdge), y = Math.min(Math.max(seen.y, -kEdge), kEdge);
    if (x !== seen.x || y !== seen.y) this.target.set(x, y, seen.z).unproject(camera);
  }

  /** Puts the hand where the scene says that the first tool is taken up, else above the organs. */
  private takeUp(): void {
    const view = this.view!;
    const up = new three.Vector3(...view.up);
    this.box.set(new three.Vector3(...view.least), new three.Vector3(...view.most));
    const middle = this.box.getCenter(new three.Vector3()), size = this.box.getSize(new three.Vector3());
    const height = Math.abs(up.x) * size.x + Math.abs(up.y) * size.y + Math.abs(up.z) * size.z;
    this.tool = view.tools.findIndex((tool) => tool.kind !== "pin");
    const held = view.tools[this.tool];
    if (held?.at) {
      this.target.set(...held.at);
      this.turn.copy(orientationOf(held.pointing ?? [0, 0, -1], held.facing));
      this.box.expandByPoint(this.target);
    } else {
      this.target.copy(middle).addScaledVector(up, height / 2 + (held?.radius_m ?? 0) + 0.02);
      this.turn.setFromUnitVectors(new three.Vector3(0, 0, 1), up);
    }
    this.hand.copy(this.target);
    this.box.expandByScalar(kMargin);
    this.started = performance.now();
    this.sentAt = performance.now();
    this.poses = 0;
    this.reached = 0;
    this.timer = setInterval(() => (this.steer(), this.send()), kInterval);
    this.send();
  }

  private release(): void {
    if (this.timer !== null) clearInterval(this.timer);
    this.timer = null;
  }

  private send(): void {
    if (!this.isRunning) return;
    const now = performance.now();
    const reach = (kMostSpeed * Math.min(now - this.sentAt, 50)) / 1e3;
    const way = new three.Vector3().subVectors(this.target, this.hand);
    this.hand.add(way.clampLength(0, reach));
    this.sentAt = now;
    ++this.poses;
    const { x, y, z, w } = this.turn;
    this.connection.send({
      hand: { position: this.hand.toArray(), orientation: [w, x, y, z], buttons: this.tool >= 0 ? 2 ** this.tool : 0, time_s: now / 1e3 },
    });
  }

  private take(message: Binary): void {
    const scene = this.scene!;
    if (message.kind === "shapes") scene.setShapes(message);
    else if (message.kind === "triangles") scene.setTriangles(message);
    else if (message.kind === "waiting") scene.wait(message), this.viewer.draw();
  }

  /** The expert's pose a little ahead of the place on the path that the tool has reached; it never goes back. */
  private expertNear(tool: Vector): number[] | null {
    const { poses, interval_s } = this.motion!;
    const end = Math.min(poses.length, this.reached + Math.ceil(kLookAhead / interval_s));
    let best = kNear;
    for (let i = this.reached; i < end; ++i) {
      const away = Math.hypot(poses[i][1] - tool[0], poses[i][2] - tool[1], poses[i][3] - tool[2]);
      if (poses[i][0] >= 0 && away < best) best = away, this.reached = i;
    }
    return poses[Math.min(poses.length - 1, this.reached + Math.round(kAhead / interval_s))] ?? null;
  }

  private showGhost(frame: Frame): void {
    if (this.motion && this.scene) this.scene.setGhost(this.expertNear(frame.position));
    this.onFrame();
  }
}
