import * as three from "three";
import { type ExpertMarks, type Frame, type HandFrame, type OrganSpheres, readWaitingFrame, type SceneView, type Shapes, type Spheres, type TissueSpheres, type ToolShape, type Triangles, type Vector, type WaitingFrame } from "./protocol";
import type { OrganPose } from "./items";
import { ExpertLine } from "./expert_line";
import { OrganMesh, organMaterials } from "./organ_mesh";
import type { Fall, ToolShadow } from "./tool_shadow";

const kArrowPerNewton = 0.007; // [m/N]
const kLongestArrow = 0.06; // [m]
const kSteel: Vector = [0.5, 0.53, 0.57];
const kHandle: Vector = [0.05, 0.055, 0.065];
const kClear = 0.9, kInTheWay = 0.97; // cosines of the angle between a tool and the view along which it is seen: whole, and hardly
const kLeast = 0.2; // opacity of a tool that is in the way
const kCloth: Vector = [0.16, 0.22, 0.24]; // of obstacles
export const kAnchored = "#7fb8ff"; // of spheres that never move
const kBead = 0.5; // of a sphere's radius, where the surface is to be seen around it

export type Shown = "surface" | "both" | "spheres";

/** One scene with its organs, tools and forces. */
export class StageScene {
  readonly scene = new three.Scene();
  frame: Frame | null = null; // the one that is drawn
  onFrame: (frame: Frame) => void = () => {};
  private waiting: WaitingFrame | null = null;
  private organs: OrganMesh[] = [];
  private readonly materials: three.MeshPhongMaterial[][]; // of each organ
  private topology = -1;
  private next: Triangles | null = null; // until their first frame is drawn
  private tools: three.Mesh[] = [];
  private obstacles: three.Mesh[] = [];
  private spheres: three.InstancedMesh[] = [];
  private shown: Shown = "surface";
  organSpheres: OrganSpheres[] = [];
  private readonly arrows = [makeArrow(), makeArrow()]; // of each hand
  private ghost: three.Mesh | null = null;
  expert: ExpertMarks | null = null; // on the organs of the frame that is drawn
  private nextExpert: ExpertMarks | null = null; // of a frame that waits
  private expertLine: ExpertLine | null = null;

  /** `shadow`: that falls on its organs. */
  constructor(readonly view: SceneView, shadow?: ToolShadow) {
    this.materials = view.organs.map((organ) => organMaterials(organ, shadow));
    this.scene.add(new three.HemisphereLight(0xdfe8ff, 0x5a4a46, 2.2), ...this.arrows);
    for (const arrow of this.arrows) arrow.visible = false;
  }

  /** The shapes of tools, which frames move, and of obstacles, which never move. */
  setShapes(shapes: Shapes): void {
    for (const mesh of [...this.tools, ...this.obstacles]) this.scene.remove(mesh), mesh.geometry.dispose();
    const steel = () => new three.MeshPhongMaterial({ vertexColors: true, specular: 0x777777, shininess: 70, side: three.DoubleSide, transparent: true });
    const cloth = new three.MeshPhongMaterial({ vertexColors: true, specular: 0x111111, side: three.DoubleSide });
    this.tools = shapes.tools.map((shape) => {
      const mesh = new three.Mesh(geometryOf(shape), steel());
      mesh.visible = false;
      return mesh;
    });
    this.obstacles = shapes.obstacles.map((shape) => new three.Mesh(geometryOf(shape), cloth));
    for (const mesh of [...this.tools, ...this.obstacles]) mesh.frustumCulled = false, this.scene.add(mesh);
  }

  /** The shape of a tool, for whoever draws a copy of it. */
  toolShape(tool: number): three.BufferGeometry | null {
    return this.tools[tool]?.geometry ?? null;
  }

  /** The spheres at rest, which show() shows: by tissue where an organ has several, else by layer. */
  setSpheres(spheres: Spheres, tissues: TissueSpheres[][]): void {
    for (const mesh of this.spheres) this.scene.remove(mesh), mesh.dispose();
    this.organSpheres = spheres.organs;
    this.spheres = spheres.organs.map((organ, i) => (tissues[i].length > 1
      ? sphereMesh(organ, organ.tissue, tissues[i].map(({ colour }) => colour))
      : sphereMesh(organ, organ.layer.map((layer) => layer - 1), this.view.organs[i].layer_colours)));
    for (const mesh of this.spheres) this.scene.add(mesh);
    this.show(this.shown);
  }

  /** The surfaces, the spheres, or both. */
  show(shown: Shown): void {
    this.shown = shown;
    for (const organ of this.organs) organ.show(shown === "surface" ? "tissue" : shown === "both" ? "glass" : "nothing");
    this.spheres.forEach((mesh, i) => {
      mesh.visible = shown !== "surface";
      placeSpheres(mesh, this.organSpheres[i], shown === "both" ? kBead : 1);
    });
  }

  /** Where a ray from a camera meets an organ first: the place, the normal of the surface there, the organ. */
  meet(ray: three.Raycaster): { place: three.Vector3; normal: three.Vector3; organ: number } | null {
    let best: three.Intersection | null = null, organ = -1;
    this.organs.forEach((candidate, i) => {
      const hit = candidate.meet(ray);
      if (hit && (!best || hit.distance < best.distance)) best = hit, organ = i;
    });
    if (!best) return null;
    const { point, face } = best as three.Intersection;
    const normal = face!.normal.clone();
    if (normal.dot(ray.ray.direction) > 0) normal.negate();
    return { place: point.clone(), normal, organ };
  }

  /** Lets something fall onto the organs. */
  fall(fall: Fall): Fall {
    for (const organ of this.organs) organ.catch(fall);
    return fall;
  }

  /** Draws an organ, whose frame has it at the pose `was`, at another one, until its next frame. */
  poseOrgan(organ: number, was: OrganPose, now: OrganPose): void {
    const turn = now.turn.clone().multiply(was.turn.clone().invert()), scale = now.scale / was.scale;
    const place = now.place.clone().sub(was.place.clone().multiplyScalar(scale).applyQuaternion(turn));
    for (const drawn of [this.organs[organ]?.mesh, this.spheres[organ]])
      if (drawn) drawn.position.copy(place), drawn.quaternion.copy(turn), drawn.scale.setScalar(scale);
  }

  /** Triangles of the frames that follow. */
  setTriangles(triangles: Triangles): void {
    this.next = triangles;
  }

  private useTriangles(triangles: Triangles): void {
    for (const organ of this.organs) this.scene.remove(organ.mesh), organ.dispose();
    this.organs = triangles.organs.slice(0, this.view.organs.length).map((organ, i) => new OrganMesh(organ, this.view.organs[i], this.materials[i]));
    for (const organ of this.organs) this.scene.add(organ.mesh);
    this.topology = triangles.topology;
    this.next = null;
    this.show(this.shown);
  }

  /** An expert's cut on the organs of a frame that follows. */
  setExpert(marks: ExpertMarks): void {
    this.nextExpert = marks;
  }

  private showExpert(marks: ExpertMarks | null): void {
    this.expert = marks;
    if (marks && !this.expertLine) this.scene.add((this.expertLine = new ExpertLine()).group);
    this.expertLine?.show(marks);
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
    if (frame.topology !== this.topology || !frame.organs.every((positions, i) => this.organs[i]?.fits(positions))) return false; // of triangles that are not here
    this.frame = frame;
    frame.organs.forEach((positions, i) => this.organs[i]?.update(positions));
    this.showExpert(this.nextExpert?.request === frame.request ? this.nextExpert : null);
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

  /** Draws these tools alone, each at its pose, until the next frame. */
  showTools(held: { tool: number; hand: three.Vector3; turn: three.Quaternion }[]): void {
    for (const tool of this.tools) tool.visible = false;
    for (const { tool, hand, turn } of held) {
      const mesh = this.tools[tool];
      if (mesh) mesh.visible = true, mesh.position.copy(hand), mesh.quaternion.copy(turn);
    }
  }

  /** Of the organs, only what faces a viewer is drawn. */
  drawFacing(viewer: three.Vector3): void {
    for (const organ of this.organs) organ.drawFacing(viewer);
  }

  /** Who looks along a tool sees the tissue through it, and lines that lie on the tissue whole. */
  clearTools(viewer: three.Vector3): void {
    this.expertLine?.comeNearer(viewer);
    for (const tool of this.tools) {
      if (!tool.visible) continue;
      tool.updateMatrixWorld();
      const eye = tool.worldToLocal(viewer.clone()), along = eye.z / eye.length(); // its handle is along z
      const share = Math.min(Math.max((along - kClear) / (kInTheWay - kClear), 0), 1);
      const material = tool.material as three.MeshPhongMaterial;
      material.opacity = 1 - share * (1 - kLeast);
      material.depthWrite = share === 0;
    }
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
    this.expertLine?.dispose();
    for (const organ of this.organs) organ.dispose();
    for (const material of this.materials.flat()) material.dispose();
    for (const mesh of [...this.tools, ...this.obstacles, ...this.spheres]) mesh.geometry.dispose();
  }
}

function geometryOf(shape: ToolShape): three.BufferGeometry {
  const geometry = new three.BufferGeometry();
  const interleaved = new three.InterleavedBuffer(shape.vertex, 7);
  geometry.setAttribute("position", new three.InterleavedBufferAttribute(interleaved, 3, 0));
  geometry.setAttribute("normal", new three.InterleavedBufferAttribute(interleaved, 3, 3));
  const count = shape.vertex.length / 7, colours = new Float32Array(3 * count);
  for (let v = 0; v < count; ++v) {
    const part = shape.vertex[7 * v + 6];
    colours.set(part < 0.5 ? kSteel : part < 1.5 ? kHandle : kCloth, 3 * v);
  }
  geometry.setAttribute("color", new three.BufferAttribute(colours, 3));
  geometry.setIndex(new three.BufferAttribute(shape.index, 1));
  return geometry;
}

/** The spheres of an organ in the colours of their layers; those that never move are blue. */
/** `kind`: which of the colours each sphere has; the last one stands for more. */
function sphereMesh(spheres: OrganSpheres, kind: Uint8Array, colours: Vector[]): three.InstancedMesh {
  const count = kind.length;
  const shape = new three.SphereGeometry(spheres.radius, 12, 8);
  const mesh = new three.InstancedMesh(shape, new three.MeshPhongMaterial({ specular: 0x222222 }), count);
  const colour = new three.Color();
  for (let i = 0; i < count; ++i) {
    if (spheres.anchored[i]) colour.set(kAnchored);
    else colour.setRGB(...(colours[Math.min(kind[i], colours.length - 1)] ?? [0.6, 0.6, 0.6]), three.SRGBColorSpace);
    mesh.setColorAt(i, colour);
  }
  mesh.frustumCulled = false;
  return mesh;
}

/** Draws them so many times as large as they are. */
function placeSpheres(mesh: three.InstancedMesh, { centre }: OrganSpheres, size: number): void {
  const place = new three.Matrix4().makeScale(size, size, size);
  for (let i = 0; i < mesh.count; ++i) mesh.setMatrixAt(i, place.setPosition(centre[3 * i], centre[3 * i + 1], centre[3 * i + 2]));
  mesh.instanceMatrix.needsUpdate = true;
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
