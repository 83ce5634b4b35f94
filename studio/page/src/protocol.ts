// The messages of studio/server/PROTOCOL.md. Lengths in metres, forces in newtons, times in seconds.
import { Reader } from "./reader";

export const kSubprotocol = "ctpm.studio.2"; // with the version of the protocol
export const kOtherVersion = 4001; // the code of a WebSocket that the program closes because it speaks another version

export type Vector = [number, number, number];

/** A tissue that a scene can name. */
export interface Preset {
  name: string;
  organ: string;
  source: string; // of its values
}

export interface Problem {
  where: string;
  message: string;
  hint: string;
}

export class CallFailed extends Error {
  constructor(readonly problems: Problem[], readonly isTaken = false /* the file is there already */) {
    super(problems.map(problemText).join("\n"));
  }
}

export function problemText(problem: Problem): string {
  const where = problem.where ? `${problem.where}: ` : "";
  return `${where}${problem.message}${problem.hint ? ` (${problem.hint})` : ""}`;
}

export interface FileEntry {
  path: string;
  bytes: number;
  modified_s: number;
}

export interface Listing {
  folder: string;
  sessions: FileEntry[];
  scenes: FileEntry[];
}

export interface SessionEvent {
  tick: number;
  kind: string;
  text: string;
}

export interface SessionInfo {
  session_id: string;
  created_utc: string;
  ended_cleanly: boolean; // false: recording was interrupted, or still runs
  values: { [name: string]: number }; // of what led the hand
  physics_remark: string;
  tick_s: number;
  ticks: number;
  duration_s: number;
  spheres: number;
  elements: number;
  severed: number;
  late_ticks: number;
  slip_s: number;
  slip_max_s: number;
  tick_time_p50_s: number;
  tick_time_p99_s: number;
  max_force_n: number;
  max_depth_m: number;
  remarks: string[];
  events: SessionEvent[];
}

export interface OrganView {
  name: string;
  spheres: number;
  layers: number;
  damage_depth_m: number;
  outer: Vector;
  inner: Vector;
  wetness: number;
  layer_colours: Vector[]; // sRGB, outermost first
  least: Vector; // the box around its spheres at rest
  most: Vector;
}

export interface ToolView {
  name: string;
  kind: "ball" | "scalpel" | "pin";
  radius_m: number;
  blade_m: number;
  at?: Vector; // where a hand takes it up
  pointing?: Vector;
  facing?: Vector;
}

export interface CameraView {
  name: string;
  eye: Vector;
  target: Vector;
  up: Vector;
  fov_deg: number;
}

export interface SceneView {
  name: string;
  task: string; // for trainees; empty: none is told
  organs: OrganView[];
  tools: ToolView[];
  hands: number; // 1 or 2
  cameras: CameraView[];
  damage_force_n: number;
  least: Vector; most: Vector; up: Vector;
}

export interface OpenedSession {
  path: string;
  info: SessionInfo;
  view: SceneView;
}

export interface TimelineData {
  duration_s: number;
  points: number;
  force_n: number[];
  depth_m: (number | null)[]; // null: a blade has none
  speed_m_per_s: number[];
}

export interface Note {
  time_s: number;
  text: string;
}

export interface Notes {
  revision: string;
  notes: Note[];
}

export interface Moment {
  worst_s: number;
  from_s: number;
  to_s: number;
  what: string;
  value: number;
  limit: number | null;
  unit: string;
  severity: number;
}

export interface MeasureRow {
  key: string;
  measure: string;
  expert: number | null;
  trainee: number | null;
  unit: string;
  better_is: string;
  trainee_is: string;
  meaning: string;
}

export interface ComparisonResult {
  comparison: { scene: string; force_limit_n?: number; force_limit_from?: string; measures: MeasureRow[]; moments: Moment[]; advice: string[]; less_done?: string };
  remarks: string[];
  path_s: [number, number][];
}

/** In which scene a session was recorded. */
export interface SceneOfSession {
  path: string;
  scene_name: string;
  scene_key: string; // as Motion has it
}

/** Whether two sessions can be compared. */
export interface Comparable {
  comparable: boolean;
  text: string; // why not; empty: they can
}

export interface Motion {
  scene_key: string; // that only sessions of one scene share
  interval_s: number;
  poses: number[][]; // tool, position, orientation w x y z
}

export interface BegunTraining {
  awaited: string; // where a device is awaited
  gives_way: { force_n: number; depth_m: number }; // with which, and at which depth, a hand that the page leads does; 0: at none
  scene_key: string; // as Motion has it
  scene: string;
  view: SceneView;
  warnings: Problem[];
}

/** What happens when a scene goes. */
export interface Removal {
  goes: string[]; // the scene first
  stays: { path: string; why: string }[];
}

/** Event train_ended. */
export interface EndedTraining {
  path: string; // empty: nothing was kept
  errors: Problem[];
  tick_s?: number;
  ticks?: number;
  late_ticks?: number;
  late_by?: { [cause: string]: number };
  slip_s?: number;
  slip_max_s?: number;
  fault?: string;
  refused?: boolean;
  max_force_n?: number;
  max_depth_m?: number;
  severed?: number;
  tick_time_p50_s?: number;
  tick_time_p99_s?: number;
  pose_wait_p50_s?: number; // from when a pose was sent to the tick that took it
  pose_wait_p99_s?: number;
  pose_way_p99_s?: number; // of it, until the program had read it
  poses_within_5ms?: number; // share
  waited_for_processor_s?: number;
}

export interface OrganTriangles {
  vertexCount: number;
  outerVertexCount: number;
  outerTriangleCount: number;
  index: Uint32Array;
  stain: Uint8Array;
  lip: Uint8Array;
  corrections: NormalCorrections;
}

/** What is added to the normals of the first vertices of an organ that is cut. */
export interface NormalCorrections {
  neighbour: Uint32Array; // and kCopiesNormal
  along: Int8Array; // the way to it, and across that, in steps of 1 / kCorrectionSteps of the normal
  across: Int8Array;
}
export const kCopiesNormal = 2 ** 31, kCorrectionSteps = 63.5;

export interface Triangles {
  kind: "triangles";
  stage: number;
  topology: number;
  organs: OrganTriangles[];
}

export interface ToolShape {
  vertex: Float32Array; // position, normal, part of each vertex
  index: Uint32Array;
}

export interface Shapes {
  kind: "shapes";
  stage: number;
  tools: ToolShape[];
  obstacles: ToolShape[]; // in the scene's frame
}

/** Spheres of an organ that are of one tissue. */
export interface TissueSpheres {
  text: string;
  spheres: number;
  colour: Vector;
}

export interface OrganSpheres {
  radius: number;
  centre: Float32Array; // x y z of each
  layer: Uint8Array; // 1: outermost
  anchored: Uint8Array; // 1: never moves
  tissue: Uint8Array; // which of the organ's
}

export interface Spheres {
  kind: "spheres";
  stage: number;
  organs: OrganSpheres[];
}

/** What a hand holds, and what the tissue does to it. */
export interface HandFrame {
  tool: number; // -1: none
  position: Vector;
  orientation: [number, number, number, number]; // w x y z
  force: Vector;
  depth: number;
  contacts: number;
  hand: Vector;
}

export interface Frame extends HandFrame {
  kind: "frame";
  stage: number;
  topology: number;
  missed: number;
  request: number;
  isSame: boolean;
  isLive: boolean;
  isGlimpse: boolean; // the replayed frame of this request follows
  time: number;
  tick: number;
  severed: number;
  second: HandFrame | null; // of the second hand, in a scene with two
  tickTime: number;
  lateTicks: number;
  tickP99: number;
  slip: number;
  organs: Float32Array[]; // x y z of each vertex
}

function indices(r: Reader, count: number, vertexCount: number): Uint32Array {
  const index = r.array(Uint32Array, 4, count);
  for (const v of index) if (v >= vertexCount) throw new RangeError("a triangle names a vertex that is not there");
  return index;
}

function readCorrections(r: Reader, vertexCount: number): NormalCorrections {
  const count = r.u32();
  if (count > vertexCount) throw new RangeError("more vertices are corrected than there are");
  const neighbour = r.array(Uint32Array, 4, count), along = r.array(Int8Array, 1, count), across = r.array(Int8Array, 1, count);
  r.pad();
  for (const v of neighbour) if (v % kCopiesNormal >= vertexCount) throw new RangeError("a correction names a vertex that is not there");
  return { neighbour, along, across };
}

function readTriangles(r: Reader): Triangles {
  const stage = r.u32(), topology = r.u32(), count = r.u32();
  const organs: OrganTriangles[] = [];
  for (let i = 0; i < count; ++i) {
    const vertexCount = r.u32(), outerVertexCount = r.u32(), triangleCount = r.u32(), outerTriangleCount = r.u32();
    if (outerVertexCount > vertexCount || outerTriangleCount > triangleCount) throw new RangeError("more is outside than there is");
    const index = indices(r, 3 * triangleCount, vertexCount);
    const stain = r.array(Uint8Array, 1, vertexCount), lip = r.array(Uint8Array, 1, vertexCount);
    r.pad();
    organs.push({ vertexCount, outerVertexCount, outerTriangleCount, index, stain, lip, corrections: { neighbour: new Uint32Array(), along: new Int8Array(), across: new Int8Array() } });
  }
  for (const organ of organs) organ.corrections = readCorrections(r, organ.vertexCount);
  return { kind: "triangles", stage, topology, organs };
}

function readFrame(r: Reader): Frame {
  const stage = r.u32(), topology = r.u32(), missed = r.u32(), request = r.u32(), flags = r.u32();
  const readPose = () => {
    const tool = r.i32(), position = r.vector();
    const orientation: HandFrame["orientation"] = [r.f32(), r.f32(), r.f32(), r.f32()];
    return { tool, position, orientation };
  };
  const time = r.f64(), tick = r.f64(), pose = readPose();
  const force = r.vector(), depth = r.f32(), contacts = r.i32(), severed = r.u32(), hand = r.vector();
  const tickTime = r.f32(), lateTicks = r.u32(), tickP99 = r.f32(), slip = r.f32(), count = r.u32();
  const organs: Float32Array[] = [];
  for (let i = 0; i < count; ++i) {
    const vertices = r.u32(), least = r.vector(), size = r.vector();
    const numbers = r.array(Uint16Array, 2, 3 * vertices);
    r.pad();
    const position = new Float32Array(3 * vertices);
    for (let c = 0; c < 3; ++c) {
      const from = least[c], step = size[c] / 65535;
      for (let k = c; k < numbers.length; k += 3) position[k] = from + step * numbers[k];
    }
    organs.push(position);
  }
  let second: HandFrame | null = null;
  if (r.hasMore) {
    const of = readPose();
    second = { ...of, force: r.vector(), depth: r.f32(), contacts: r.i32(), hand: r.vector() };
  }
  return {
    kind: "frame", stage, topology, missed, request, isSame: (flags & 1) !== 0, isLive: (flags & 2) !== 0,
    isGlimpse: (flags & 4) !== 0, time, tick,
    ...pose, force, depth, contacts, severed, hand, second, tickTime, lateTicks, tickP99, slip, organs,
  };
}

function readShapeList(r: Reader): ToolShape[] {
  const count = r.u32();
  const shapes: ToolShape[] = [];
  for (let i = 0; i < count; ++i) {
    const vertices = r.u32(), indexCount = r.u32();
    shapes.push({ vertex: r.array(Float32Array, 4, 7 * vertices), index: indices(r, indexCount, vertices) });
  }
  return shapes;
}

function readShapes(r: Reader): Shapes {
  const stage = r.u32(), tools = readShapeList(r);
  return { kind: "shapes", stage, tools, obstacles: readShapeList(r) };
}

function readSpheres(r: Reader): Spheres {
  const stage = r.u32(), count = r.u32();
  const organs: OrganSpheres[] = [];
  for (let i = 0; i < count; ++i) {
    const spheres = r.u32(), radius = r.f32(), centre = r.array(Float32Array, 4, 3 * spheres);
    organs.push({ radius, centre, layer: r.array(Uint8Array, 1, spheres), anchored: r.array(Uint8Array, 1, spheres), tissue: r.array(Uint8Array, 1, spheres) });
    r.pad();
  }
  return { kind: "spheres", stage, organs };
}

/** The head of a frame, for its stage and request; the rest may never be needed. */
export interface WaitingFrame {
  kind: "waiting";
  stage: number;
  request: number;
  bytes: ArrayBuffer;
}

const kFrameHead = 124, kSecondHand = 64; // [bytes]

/** The head of a frame that is whole. */
function readHead(r: Reader): WaitingFrame {
  const stage = r.u32();
  r.take(8);
  const request = r.u32();
  r.take(kFrameHead - r.at);
  for (let organs = r.u32(); organs > 0; --organs) r.take(24 + 6 * r.u32()), r.pad();
  if (r.hasMore) r.take(kSecondHand);
  return { kind: "waiting", stage, request, bytes: r.bytes };
}

export function readWaitingFrame(message: WaitingFrame): Frame {
  const reader = new Reader(message.bytes);
  reader.u32();
  return readFrame(reader);
}

/** What the colours of drawings mean; without a title they mean nothing. */
export interface Legend {
  title: string;
  low: string;
  high: string;
  colours: Vector[]; // sRGB
}

/** How the program shows a session: what its colours mean, and from where it is seen. */
export interface Seen extends Legend {
  camera: CameraView;
}

/** A moment as the program draws it, in place of the page. */
export interface Drawing {
  kind: "drawing";
  stage: number;
  request: number;
  width: number;
  height: number;
  rgb: Uint8Array;
}

/** An expert's cut on the organs of a frame, and what is cut elsewhere. */
export interface ExpertMarks {
  kind: "expert";
  stage: number;
  request: number;
  line: Float32Array; // x y z of both ends of each part
  strays: Float32Array; // x y z of each
}

function readExpertMarks(r: Reader): ExpertMarks {
  const stage = r.u32(), request = r.u32(), parts = r.u32(), strays = r.u32();
  return { kind: "expert", stage, request, line: r.array(Float32Array, 4, 6 * parts), strays: r.array(Float32Array, 4, 3 * strays) };
}

function readDrawing(r: Reader): Drawing {
  const stage = r.u32(), request = r.u32(), width = r.u32(), height = r.u32();
  return { kind: "drawing", stage, request, width, height, rgb: r.array(Uint8Array, 1, 3 * width * height) };
}

/** What is read of a binary message. */
export type Binary = Triangles | WaitingFrame | Shapes | Spheres | Drawing | ExpertMarks;

function readKind(kind: number, r: Reader): Binary {
  if (kind === 1) return readTriangles(r);
  if (kind === 2) return readHead(r);
  if (kind === 3) return readShapes(r);
  if (kind === 4) return readSpheres(r);
  if (kind === 5) return readDrawing(r);
  if (kind === 6) return readExpertMarks(r);
  throw new RangeError(`unknown kind of message ${kind}`);
}

/** Reads a binary message; of a frame its head alone. Throws a RangeError for one that is not as PROTOCOL.md has it. */
export function readBinary(bytes: ArrayBuffer): Binary {
  const reader = new Reader(bytes), message = readKind(reader.u32(), reader);
  reader.pad();
  if (reader.hasMore) throw new RangeError("a message is longer than it says");
  return message;
}
