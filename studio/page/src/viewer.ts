import * as three from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Picture } from "./picture";
import { PictureQuality } from "./picture_quality";
import type { CameraView, SceneView, Vector } from "./protocol";
import type { StageScene } from "./stage_scene";

/** Whether the box is in the picture of a camera, but for two of its corners. */
export function seesBox(seen: CameraView, least: Vector, most: Vector): boolean {
  const camera = new three.PerspectiveCamera(seen.fov_deg, 16 / 9, 1e-3, 1e3);
  camera.up.set(...seen.up), camera.position.set(...seen.eye);
  camera.lookAt(...seen.target);
  camera.updateMatrixWorld();
  const ends = [least, most];
  let outside = 0;
  for (let i = 0; i < 8; ++i) {
    const corner = new three.Vector3(ends[i & 1][0], ends[(i >> 1) & 1][1], ends[i >> 2][2]).project(camera);
    outside += Number(Math.abs(corner.x) > 1 || Math.abs(corner.y) > 1 || corner.z > 1);
  }
  return outside <= 2;
}

/** Of the cameras of a scene the first one, unless organs lie outside of its picture: then the one that sees everything,
    which is the last. */
export function firstCamera(view: SceneView): CameraView | undefined {
  const first = view.cameras[0];
  return !first || seesBox(first, view.least, view.most) ? first : view.cameras.at(-1);
}

const kLookAgain = 2; // whether a picture is done [ms]
const kLongerThanFrames = 25; // a picture that took so long is followed at once: it would wait for half a frame of the screen [ms]
const kNearPole = 0.01; // no view is nearer to straight down or up, where nothing says what is up in the picture [rad]
const kStandsStill = 400; // a picture, if no other one follows for that long [ms]

/** What keys do to a view: right and up [rad], times as far away. */
export const kTurns: { [key: string]: [number, number, number] } = {
  a: [-0.1, 0, 1], d: [0.1, 0, 1], w: [0, 0.1, 1], s: [0, -0.1, 1], "+": [0, 0, 0.9], "=": [0, 0, 0.9], "-": [0, 0, 1 / 0.9],
};

/** Turns what is up into y. */
function uprightOf(up: three.Vector3): three.Quaternion {
  return new three.Quaternion().setFromUnitVectors(up.clone().normalize(), new three.Vector3(0, 1, 0));
}

/** The mouse turns the view about what is up, and not about what was up when three.js made its controls, the only time that
    they ask. A view that passes the pole of another axis spins. */
function turnAbout(up: three.Vector3, controls: OrbitControls): void {
  const axis = controls as unknown as { _quat: three.Quaternion; _quatInverse: three.Quaternion };
  axis._quat.copy(uprightOf(up));
  axis._quatInverse.copy(axis._quat).invert();
}

/** Draws up to two scenes side by side with one camera, whenever something changed. */
export class Viewer {
  readonly camera = new three.PerspectiveCamera(32, 16 / 9, 0.01, 10);
  readonly controls: OrbitControls;
  readonly stages = new Map<number, StageScene>();
  frames = 0; // drawn so far
  private readonly renderer: three.WebGLRenderer;
  private readonly picture: Picture;
  private readonly key = new three.DirectionalLight(0xfff4e6, 3);
  private readonly rim = new three.DirectionalLight(0x9fc2ff, 0.7);
  private readonly observer: ResizeObserver;
  onDraw: () => void = () => {}; // before each drawing
  onReady: () => void = () => {}; // a picture of something that moves is done: the next one would be drawn at once
  onTurn: () => void = () => {}; // the mouse or keys moved the camera
  fieldOfView = 32; // vertical, in a picture of 16:9 [degrees]
  isCovered = false; // by other pictures: nothing is drawn
  private isWanted = false;
  private isBusy = false; // with the picture before
  private isTurning = false;
  private beganAt = 0; // the last picture of something that moves [ms]
  private readonly quality = new PictureQuality();
  private still: ReturnType<typeof setTimeout> | undefined; // until the picture counts as one that stands still

  constructor(readonly canvas: HTMLCanvasElement) {
    this.renderer = new three.WebGLRenderer({ canvas, antialias: this.quality.smoothsEdges, alpha: true });
    this.renderer.setClearColor(0x000000, 0); // the page's ground shows
    this.renderer.autoClear = false;
    this.picture = new Picture(this.renderer, this.quality.smoothsEdges);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.minPolarAngle = kNearPole, this.controls.maxPolarAngle = Math.PI - kNearPole;
    this.controls.addEventListener("start", () => (this.isTurning = true));
    this.controls.addEventListener("end", () => (this.isTurning = false));
    this.controls.addEventListener("change", () => {
      this.draw();
      if (this.isTurning) this.onTurn();
    });
    this.observer = new ResizeObserver(() => this.draw());
    this.observer.observe(canvas);
  }

  /** Whether the browser draws with the processor, so that everything else on the page costs pictures. */
  get isByProcessor(): boolean {
    return this.quality.isByProcessor;
  }

  set(stage: number, scene: StageScene | null): void {
    this.stages.get(stage)?.dispose();
    if (scene) this.stages.set(stage, scene);
    else this.stages.delete(stage);
    this.draw();
  }

  look(camera: CameraView): void {
    if (this.isTurning) return; // a hand has it
    this.camera.up.set(...camera.up);
    turnAbout(this.camera.up, this.controls);
    this.camera.position.set(...camera.eye);
    this.fieldOfView = camera.fov_deg;
    this.controls.target.set(...camera.target);
    this.controls.update();
    this.camera.updateMatrixWorld(); // what is placed by it need not wait for a picture
    this.draw();
  }

  /** The camera in a picture of 16:9. */
  seen(): CameraView {
    const vector = (v: three.Vector3) => v.toArray() as Vector, { camera } = this;
    return { name: "", eye: vector(camera.position), target: vector(this.controls.target), up: vector(camera.up), fov_deg: this.fieldOfView };
  }

  /** Turns the camera about its target, to the right and up [rad], and moves it so many times as far away. */
  turn(right: number, up: number, farther: number): void {
    const { camera, controls } = this;
    const upright = uprightOf(camera.up);
    const away = new three.Spherical().setFromVector3(camera.position.clone().sub(controls.target).applyQuaternion(upright));
    away.theta += right, away.phi = three.MathUtils.clamp(away.phi - up, kNearPole, Math.PI - kNearPole), away.radius *= farther;
    camera.position.setFromSpherical(away).applyQuaternion(upright.invert()).add(controls.target);
    controls.update();
    this.onTurn();
  }

  /** The ray into the picture at a place of the window [px]. */
  rayAt(x: number, y: number): three.Raycaster {
    const box = this.canvas.getBoundingClientRect();
    const ray = new three.Raycaster();
    ray.setFromCamera(new three.Vector2((2 * (x - box.left)) / box.width - 1, 1 - (2 * (y - box.top)) / box.height), this.camera);
    return ray;
  }

  /** Where a place of the scene is drawn, in pixels of the canvas; null: behind the camera. */
  pixelOf(place: three.Vector3): { x: number; y: number } | null {
    const seen = place.clone().project(this.camera);
    if (seen.z > 1) return null;
    return { x: (0.5 + 0.5 * seen.x) * this.canvas.clientWidth, y: (0.5 - 0.5 * seen.y) * this.canvas.clientHeight };
  }

  /** Draws after the picture before is done, for pictures that pile up in the browser would keep it from the pointer: at
      once if that began long ago, else with the next frame of the screen. */
  draw(): void {
    clearTimeout(this.still);
    if (this.isWanted) return;
    this.isWanted = true;
    if (!this.isBusy) this.drawNext();
  }

  private drawNext(): void {
    const isLate = performance.now() - this.beganAt > kLongerThanFrames && !document.hidden;
    if (isLate) queueMicrotask(() => this.drawMoving()); // with all that is said to be drawn by then
    else requestAnimationFrame(() => this.drawMoving());
  }

  private drawMoving(): void {
    const began = (this.beganAt = performance.now());
    this.isWanted = false;
    this.begin(false);
    this.awaitPicture(() => {
      this.quality.add(performance.now() - began);
      this.onReady();
      if (this.isWanted) this.drawNext();
      else if (this.quality.isReduced) this.still = setTimeout(() => this.drawStill(), kStandsStill);
    });
  }

  /** The same picture, as fine as it can be. */
  private drawStill(): void {
    this.begin(true);
    this.awaitPicture(() => {
      if (this.isWanted) this.drawNext();
    });
  }

  /** Makes a picture. Who asks for one meanwhile gets the next one. */
  private begin(isStill: boolean): void {
    this.isBusy = true;
    this.drawNow(isStill);
  }

  private awaitPicture(done: () => void): void {
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    const sync = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    this.isBusy = sync !== null;
    if (!sync) return;
    gl.flush();
    const look = () => {
      if (!gl.isContextLost() && gl.clientWaitSync(sync, 0, 0) === gl.TIMEOUT_EXPIRED) return void setTimeout(look, kLookAgain);
      gl.deleteSync(sync);
      this.isBusy = false;
      done();
    };
    setTimeout(look, kLookAgain);
  }

  private drawNow(isStill: boolean): void {
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    if (width === 0 || height === 0) return;
    for (const stage of this.stages.values()) stage.takeFrame();
    this.picture.begin(width, height, this.quality.ratio(isStill));
    const scenes = [...this.stages.entries()].sort(([a], [b]) => a - b).map(([, scene]) => scene);
    const part = width / Math.max(scenes.length, 1);
    this.camera.aspect = part / height;
    // Cameras are set up for 16:9; a narrower picture keeps the sides visible.
    const wide = Math.max(1, 16 / 9 / this.camera.aspect);
    this.camera.fov = (360 / Math.PI) * Math.atan(wide * Math.tan((this.fieldOfView * Math.PI) / 360));
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
    this.onDraw();
    if (this.isCovered) return this.picture.end();
    const away = new three.Vector3().subVectors(this.camera.position, this.controls.target);
    const right = new three.Vector3().crossVectors(this.camera.up, away).normalize();
    this.key.position.copy(away).addScaledVector(this.camera.up, away.length()).addScaledVector(right, -0.5 * away.length());
    this.rim.position.copy(away).multiplyScalar(-0.6).addScaledVector(this.camera.up, 0.8 * away.length()).addScaledVector(right, away.length());
    scenes.forEach((stage, i) => {
      stage.scene.add(this.key, this.rim);
      if (this.quality.isByProcessor) stage.drawFacing(this.camera.position);
      stage.clearTools(this.camera.position);
      this.picture.fill(i * part, part);
      this.renderer.render(stage.scene, this.camera);
    });
    this.picture.end();
    ++this.frames;
  }

  dispose(): void {
    clearTimeout(this.still);
    this.observer.disconnect();
    this.controls.dispose();
    for (const stage of this.stages.values()) stage.dispose();
    this.picture.dispose();
    this.renderer.dispose();
  }
}
