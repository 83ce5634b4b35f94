import * as three from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { type CameraView, type Frame, type HandFrame, readWaitingFrame, type SceneView, type ToolShapes, type Triangles, type Vector, type WaitingFrame } from "./protocol";
import { OrganMesh } from "./organ_mesh";

const kArrowPerNewton = 0.007; // [m/N]
const kLongestArrow = 0.06; // [m]
const kSteel: Vector = [0.5, 0.53, 0.57];
const kHandle: Vector = [0.05, 0.055, 0.065];

/** One scene with its organs, tool and force. */
export class StageScene {
  readonly scene = new three.Scene();
  frame: Frame | null = null; // the one that is drawn
  onFrame: (frame: Frame) => void = () => {};
  private waiting: WaitingFrame | null = null;
  private organs: OrganMesh[] = [];
  private topology = -1;
  private next: Triangles | null = null; // until their first frame is drawn
  private tools: three.Mesh[] = [];
  private readonly arrows = [makeArrow(), makeArrow()]; // of each hand
  private ghost: three.Mesh | null = null;

  constructor(readonly view: SceneView) {
    this.scene.add(new three.HemisphereLight(0xdfe8ff, 0x3a2e2a, 1.5), ...this.arrows);
    for (const arrow of this.arrows) arrow.visible = false;
  }

  setTools(shapes: ToolShapes): void {
    for (const tool of this.tools) this.scene.remove(tool);
    const material = new three.MeshPhongMaterial({ vertexColors: true, specular: 0x777777, shininess: 70, side: three.DoubleSide });
    this.tools = shapes.tools.map((shape) => {
      const geometry = new three.BufferGeometry();
      const interleaved = new three.InterleavedBuffer(shape.vertex, 7);
      geometry.setAttribute("position", new three.InterleavedBufferAttribute(interleaved, 3, 0));
      geometry.setAttribute("normal", new three.InterleavedBufferAttribute(interleaved, 3, 3));
      const count = shape.vertex.length / 7, colours = new Float32Array(3 * count);
      for (let v = 0; v < count; ++v) colours.set(shape.vertex[7 * v + 6] < 0.5 ? kSteel : kHandle, 3 * v);
      geometry.setAttribute("color", new three.BufferAttribute(colours, 3));
      geometry.setIndex(new three.BufferAttribute(shape.index, 1));
      const mesh = new three.Mesh(geometry, material);
      mesh.visible = false;
      mesh.frustumCulled = false;
      this.scene.add(mesh);
      return mesh;
    });
  }

  /** Triangles of the frames that follow. */
  setTriangles(triangles: Triangles): void {
    this.next = triangles;
  }

  private useTriangles(triangles: Triangles): void {
    for (const organ of this.organs) this.scene.remove(organ.mesh), organ.dispose();
    this.organs = triangles.organs.map((organ, i) => new OrganMesh(organ, this.view.organs[i]));
    for (const organ of this.organs) this.scene.add(organ.mesh);
    this.topology = triangles.topology;
    this.next = null;
  }

  /** Takes the newest frame, which is read when it is drawn: a slow browser leaves out those in between. */
  wait(frame: WaitingFrame): void {
    this.waiting = frame;
  }

  /** Moves everything to the frame that waits. False: there is none. */
  takeFrame(): boolean {
    if (!this.waiting) return false;
    const frame = readWaitingFrame(this.waiting);
    this.waiting = null;
    if (frame.topology === this.next?.topology) this.useTriangles(this.next);
    if (frame.topology !== this.topology) return false; // of triangles that are not here
    this.frame = frame;
    frame.organs.forEach((positions, i) => this.organs[i]?.update(positions));
    this.tools.forEach((tool, i) => {
      const holding = i === frame.second?.tool ? frame.second : frame; // both hands never hold the same tool
      tool.visible = i === holding.tool;
      tool.position.set(...holding.position);
      const [w, x, y, z] = holding.orientation;
      tool.quaternion.set(x, y, z, w);
    });
    this.showForce(this.arrows[0], frame);
    if (frame.second) this.showForce(this.arrows[1], frame.second);
    this.onFrame(frame);
    return true;
  }

  /** A pale copy of a tool at a pose (tool, position, orientation w x y z); null: none. */
  setGhost(pose: number[] | null): void {
    const [tool, px, py, pz, w, x, y, z] = pose ?? [-1];
    const like = this.tools[tool];
    if (this.ghost && this.ghost.userData.tool !== tool) {
      this.scene.remove(this.ghost);
      this.ghost = null;
    }
    if (!like) return;
    if (!this.ghost) {
      const material = new three.MeshBasicMaterial({ color: 0x7cc0ff, transparent: true, opacity: 0.3, depthWrite: false });
      this.ghost = new three.Mesh(like.geometry, material);
      this.ghost.frustumCulled = false;
      this.ghost.userData.tool = tool;
      this.scene.add(this.ghost);
    }
    this.ghost.position.set(px, py, pz);
    this.ghost.quaternion.set(x, y, z, w);
  }

  private showForce(arrow: three.Group, frame: HandFrame): void {
    const force = new three.Vector3(...frame.force), size = force.length();
    arrow.visible = size > 0.01 && frame.tool >= 0;
    if (!arrow.visible) return;
    arrow.position.set(...frame.position);
    arrow.quaternion.setFromUnitVectors(new three.Vector3(0, 1, 0), force.divideScalar(size));
    arrow.scale.set(1, Math.min(size * kArrowPerNewton, kLongestArrow) / 0.03, 1);
  }

  dispose(): void {
    for (const organ of this.organs) organ.dispose();
    for (const tool of this.tools) tool.geometry.dispose();
  }
}

/** An arrow of 30 mm along +y. */
function makeArrow(): three.Group {
  const group = new three.Group();
  const material = new three.MeshBasicMaterial({ color: 0xffc857, depthTest: false, transparent: true, opacity: 0.95 });
  const shaft = new three.Mesh(new three.CylinderGeometry(0.0009, 0.0009, 0.022, 10), material);
  shaft.position.y = 0.011;
  const head = new three.Mesh(new three.ConeGeometry(0.0028, 0.008, 14), material);
  head.position.y = 0.026;
  group.add(shaft, head);
  group.renderOrder = 2;
  shaft.renderOrder = head.renderOrder = 2;
  return group;
}

/** Draws up to two scenes side by side with one camera, whenever something changed. */
export class Viewer {
  readonly camera = new three.PerspectiveCamera(32, 16 / 9, 0.01, 10);
  readonly controls: OrbitControls;
  readonly stages = new Map<number, StageScene>();
  frames = 0; // drawn so far
  private readonly renderer: three.WebGLRenderer;
  private readonly key = new three.DirectionalLight(0xfff4e6, 2.2);
  private readonly rim = new three.DirectionalLight(0x9fc2ff, 0.7);
  private readonly observer: ResizeObserver;
  private fieldOfView = 32; // vertical, in a picture of 16:9 [degrees]
  private isWanted = false;

  constructor(readonly canvas: HTMLCanvasElement) {
    this.renderer = new three.WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.setClearColor(0x000000, 0); // the page's ground shows
    this.renderer.setScissorTest(true);
    this.renderer.autoClear = false;
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.draw());
    this.observer = new ResizeObserver(() => this.draw());
    this.observer.observe(canvas);
  }

  set(stage: number, scene: StageScene | null): void {
    this.stages.get(stage)?.dispose();
    if (scene) this.stages.set(stage, scene);
    else this.stages.delete(stage);
    this.draw();
  }

  look(camera: CameraView): void {
    this.camera.up.set(...camera.up);
    this.camera.position.set(...camera.eye);
    this.fieldOfView = camera.fov_deg;
    this.controls.target.set(...camera.target);
    this.controls.update();
    this.draw();
  }

  /** Draws with the next frame of the screen. */
  draw(): void {
    if (this.isWanted) return;
    this.isWanted = true;
    requestAnimationFrame(() => {
      this.isWanted = false;
      this.drawNow();
    });
  }

  private drawNow(): void {
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    if (width === 0 || height === 0) return;
    for (const stage of this.stages.values()) stage.takeFrame();
    const ratio = Math.min(devicePixelRatio, 2);
    if (this.renderer.getPixelRatio() !== ratio) this.renderer.setPixelRatio(ratio);
    const size = this.renderer.getSize(new three.Vector2());
    if (size.x !== width || size.y !== height) this.renderer.setSize(width, height, false);
    this.renderer.setScissor(0, 0, width, height);
    this.renderer.clear();
    const scenes = [...this.stages.entries()].sort(([a], [b]) => a - b).map(([, scene]) => scene);
    const part = width / Math.max(scenes.length, 1);
    this.camera.aspect = part / height;
    // Cameras are set up for 16:9; a narrower picture keeps the sides visible.
    const wide = Math.max(1, 16 / 9 / this.camera.aspect);
    this.camera.fov = (360 / Math.PI) * Math.atan(wide * Math.tan((this.fieldOfView * Math.PI) / 360));
    this.camera.updateProjectionMatrix();
    const away = new three.Vector3().subVectors(this.camera.position, this.controls.target);
    const right = new three.Vector3().crossVectors(this.camera.up, away).normalize();
    this.key.position.copy(away).addScaledVector(this.camera.up, away.length()).addScaledVector(right, -0.5 * away.length());
    this.rim.position.copy(away).multiplyScalar(-0.6).addScaledVector(this.camera.up, 0.8 * away.length()).addScaledVector(right, away.length());
    scenes.forEach((stage, i) => {
      stage.scene.add(this.key, this.rim);
      this.renderer.setViewport(i * part, 0, part, height);
      this.renderer.setScissor(i * part, 0, part, height);
      this.renderer.render(stage.scene, this.camera);
    });
    ++this.frames;
  }

  dispose(): void {
    this.observer.disconnect();
    this.controls.dispose();
    for (const stage of this.stages.values()) stage.dispose();
    this.renderer.dispose();
  }
}
