// The things of a scene that have a place, as the text says them. Lengths of the text are millimetres, here metres.
import type { JSONPath } from "jsonc-parser";
import * as three from "three";
import type { Json } from "./json_edit";
import { orientationOf } from "./pose";
import type { SceneView, Vector } from "./protocol";

export type ItemKind = "organ" | "anchor" | "tool" | "probe" | "obstacle" | "zone" | "camera";

/** The list of a scene that has what is not of an organ. */
export const kListOf: Record<Exclude<ItemKind, "organ" | "anchor">, string> = { tool: "tools", probe: "probes", obstacle: "obstacles", zone: "forbidden", camera: "cameras" };

export interface Item {
  key: string; // its path, as text
  path: JSONPath;
  kind: ItemKind;
  name: string;
  shape: "organ" | "ball" | "scalpel" | "pin" | "probe" | "camera" | "sphere" | "box" | "plane" | "lowest" | "mesh";
  index: number; // in its list
  place: three.Vector3 | null; // null: it has none, or the text does not say it well
  turn: three.Quaternion; // of organs, tools, planes and cameras
  size: three.Vector3; // of a box its sides; of a sphere or a ball, three times its radius; of an organ, its scale
  offset: three.Vector3; // from its place to its handle: an organ's place is that of its mesh's origin
  isWritten: boolean; // the text says the place; else it is where the hand takes it up
}

type Values = [JSONPath, Json | undefined][];
export type Fields = { [key: string]: Json };

/** A length as it is written [mm]: to a hundredth. */
export function mm(metres: number): number {
  return Math.round(metres * 1e5) / 100 + 0;
}
export function mmVector(v: three.Vector3): number[] {
  return [mm(v.x), mm(v.y), mm(v.z)];
}
export function direction(v: three.Vector3): number[] {
  return v.toArray().map((x) => Math.round(x * 1e4) / 1e4 + 0);
}

export function isFields(value: Json | undefined): value is Fields {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}
export function listOf(scene: Json | undefined, key: string): Fields[] {
  const list = isFields(scene) ? scene[key] : undefined;
  return Array.isArray(list) ? list.map((entry) => (isFields(entry) ? entry : {})) : [];
}
function numbersOf(value: Json | undefined): number[] | null {
  return Array.isArray(value) && value.length === 3 && value.every((x) => typeof x === "number") ? (value as number[]) : null;
}
export function metresOf(value: Json | undefined): three.Vector3 | null {
  const numbers = numbersOf(value);
  return numbers && new three.Vector3(...numbers).multiplyScalar(1e-3);
}
export function lengthOf(value: Json | undefined, otherwise: number): number {
  return typeof value === "number" && value > 0 ? value * 1e-3 : otherwise;
}
function textOf(value: Json | undefined, otherwise: string): string {
  return typeof value === "string" && value ? value : otherwise;
}

/** How an organ's mesh stands in the scene: sized and turned about its origin, which is then put at its place. */
export interface OrganPose {
  place: three.Vector3;
  turn: three.Quaternion;
  scale: number;
}
function poseOf(organ: Fields): OrganPose {
  const [x, y, z] = (numbersOf(organ.turn_deg) ?? [0, 0, 0]).map(three.MathUtils.degToRad);
  return {
    place: metresOf(organ.at_mm) ?? new three.Vector3(), turn: new three.Quaternion().setFromEuler(new three.Euler(x, y, z, "ZYX")), // about x first
    scale: typeof organ.scale === "number" && organ.scale > 0 ? organ.scale : 1,
  };
}
export function organPoses(scene: Json | undefined): OrganPose[] {
  return listOf(scene, "organs").map(poseOf);
}

/** Above everything, over the largest organ: between several there may be nothing to press. A tool is taken up there, by its
    radius and kClearance higher, if the scene does not say where. */
export function aboveOrgans({ up: [x, y, z], least, most, organs }: SceneView): three.Vector3 {
  const up = new three.Vector3(x, y, z), middleOf = (box: { least: Vector; most: Vector }) => new three.Vector3(...box.least).add(new three.Vector3(...box.most)).multiplyScalar(0.5);
  const size = new three.Vector3(...most).sub(new three.Vector3(...least)), middle = middleOf({ least, most });
  const height = Math.abs(x) * size.x + Math.abs(y) * size.y + Math.abs(z) * size.z;
  const chosen = organs.length > 1 ? middleOf(organs.reduce((largest, organ) => (organ.spheres > largest.spheres ? organ : largest))) : middle;
  return chosen.addScaledVector(up, up.dot(middle) + height / 2 - up.dot(chosen));
}
export const kClearance = 0.02; // [m]
const kBeside = 0.03; // from the tool that is taken up first to those that wait [m]

/** Everything in a scene that has a place. `view`: as it is shown, for places that the text leaves open. `middles`: of its organs, in their meshes [m]. */
export function itemsOf(scene: Json | undefined, view: SceneView | null, middles: three.Vector3[] = []): Item[] {
  const items: Item[] = [];
  const add = (path: JSONPath, kind: ItemKind, shape: Item["shape"], name: string, place: three.Vector3 | null, more: Partial<Item> = {}) =>
    items.push({
      key: path.join("/"), path, kind, shape, name, place, index: Number(path.at(-1)), turn: new three.Quaternion(), size: new three.Vector3(), offset: new three.Vector3(), isWritten: true, ...more,
    });
  /** A ball, a box or a plane that `fields` are; its shape, or null: none of these. */
  const addRegion = (path: JSONPath, kind: ItemKind, fields: Fields, nameOf: (what: string) => string): Item["shape"] | null => {
    if (isFields(fields.sphere)) {
      const radius = lengthOf(fields.sphere.radius_mm, 0);
      add(path, kind, "sphere", nameOf("ball"), metresOf(fields.sphere.centre_mm), { size: new three.Vector3(radius, radius, radius) });
    } else if (isFields(fields.box)) {
      const least = metresOf(fields.box.min_mm), most = metresOf(fields.box.max_mm);
      add(path, kind, "box", nameOf("box"), least && most && least.clone().add(most).multiplyScalar(0.5), least && most ? { size: most.clone().sub(least) } : {});
    } else if (isFields(fields.plane)) {
      const normal = numbersOf(fields.plane.normal) as Vector | null;
      add(path, kind, "plane", nameOf("plane"), metresOf(fields.plane.point_mm), { turn: orientationOf(normal && Math.hypot(...normal) > 0 ? normal : [0, 0, 1]) });
    } else return null;
    return items.at(-1)!.shape;
  };
  const above = view ? aboveOrgans(view) : new three.Vector3();
  listOf(scene, "organs").forEach((organ, i) => {
    const name = textOf(organ.name, `organ ${i + 1}`);
    const { place, turn, scale } = poseOf(organ);
    const offset = (middles[i] ?? new three.Vector3()).clone().multiplyScalar(scale).applyQuaternion(turn);
    if (!organ.rig) add(["organs", i], "organ", "organ", name, place, { isWritten: organ.at_mm !== undefined, turn, size: new three.Vector3(scale, scale, scale), offset });
    // The organ is named where there are others.
    const called = (what: string, k: number) => `${what} ${k + 1}${listOf(scene, "organs").length > 1 ? ` of ${name}` : ""}`;
    listOf(organ, "anchors").forEach((anchor, k) => {
      const path = ["organs", i, "anchors", k];
      if (!addRegion(path, "anchor", anchor, (what) => called(what, k)) && anchor.lowest_mm !== undefined) add(path, "anchor", "lowest", called("lowest part", k), null);
    });
  });
  let waiting = 0; // tools so far that a hand takes up
  listOf(scene, "tools").forEach((tool, i) => {
    const shape = tool.kind === "pin" ? "pin" : tool.kind === "scalpel" ? "scalpel" : "ball";
    const radius = lengthOf(tool.radius_mm, 0);
    const place = metresOf(shape === "pin" ? tool.holds_mm : tool.at_mm);
    const pointing = numbersOf(tool.pointing) as Vector | null, facing = numbersOf(tool.facing) as Vector | null;
    const up = view ? new three.Vector3(...view.up) : new three.Vector3(0, 0, 1);
    // The first one where it is taken up; others beside it, alternately.
    const step = (waiting % 2 ? 1 : -1) * Math.ceil(waiting / 2);
    if (shape !== "pin") ++waiting;
    const waits = above.clone().addScaledVector(up, radius + kClearance).addScaledVector(acrossOf(up), kBeside * step);
    add(["tools", i], "tool", shape, textOf(tool.name, `tool ${i + 1}`), place ?? (shape === "pin" ? null : waits), {
      turn: orientationOf(!place ? (up.clone().negate().toArray() as Vector) : pointing && Math.hypot(...pointing) > 0 ? pointing : [0, 0, -1], place && facing ? facing : undefined),
      size: new three.Vector3(radius, radius, radius), isWritten: place !== null,
    });
  });
  listOf(scene, "probes").forEach((probe, i) => add(["probes", i], "probe", "probe", textOf(probe.name, `probe ${i + 1}`), metresOf(probe.at_mm)));
  for (const kind of ["obstacle", "zone"] as const)
    listOf(scene, kListOf[kind]).forEach((fields, i) => {
      const path = [kListOf[kind], i], name = textOf(fields.name, `${kind} ${i + 1}`);
      if (!addRegion(path, kind, fields, () => name)) add(path, kind, "mesh", name, null);
    });
  listOf(scene, "cameras").forEach((camera, i) => add(["cameras", i], "camera", "camera", textOf(camera.name, `camera ${i + 1}`), metresOf(camera.eye_mm), { turn: lookOf(camera) }));
  return items;
}

/** The orientation of a camera, which looks along its -z. */
function lookOf(camera: Fields): three.Quaternion {
  const eye = metresOf(camera.eye_mm), target = metresOf(camera.target_mm), up = numbersOf(camera.up);
  if (!eye || !target) return new three.Quaternion();
  return new three.Quaternion().setFromRotationMatrix(new three.Matrix4().lookAt(eye, target, new three.Vector3(...(up ?? [0, 0, 1]))));
}

function acrossOf(up: three.Vector3): three.Vector3 {
  const helper = Math.abs(up.x) < 0.9 ? new three.Vector3(1, 0, 0) : new three.Vector3(0, 1, 0);
  return helper.addScaledVector(up, -helper.dot(up)).normalize();
}

/** What the text says of an item that was moved. */
export function placed(item: Item, place: three.Vector3): Values {
  const at = mmVector(place);
  if (item.shape === "sphere") return [[[...item.path, "sphere", "centre_mm"], at]];
  if (item.shape === "plane") return [[[...item.path, "plane", "point_mm"], at]];
  if (item.shape === "box") return boxed(item, place, item.size);
  if (item.shape === "pin") return [[[...item.path, "holds_mm"], at]];
  if (item.shape === "camera") return [[[...item.path, "eye_mm"], at]];
  const values: Values = [[[...item.path, "at_mm"], at]];
  if (item.kind === "tool" && !item.isWritten) values.push(...turned({ ...item, isWritten: true }, item.turn)); // its place is the new one
  return values;
}

/** Of an organ that was turned or sized: its middle stays where it is. */
function kept(item: Item, offset: three.Vector3): Values {
  const before = mmVector(item.place!), place = item.place!.clone().add(item.offset).sub(offset), after = mmVector(place);
  return after.some((x, i) => x !== before[i]) ? placed(item, place) : [];
}

/** Of a tool that was turned, with its place, of an organ or of a plane. */
export function turned(item: Item, turn: three.Quaternion): Values {
  if (item.kind === "organ") {
    const { x, y, z } = new three.Euler().setFromQuaternion(turn, "ZYX");
    const degrees = [x, y, z].map((angle) => Math.round(100 * three.MathUtils.radToDeg(angle)) / 100 + 0);
    return [[[...item.path, "turn_deg"], degrees], ...kept(item, item.offset.clone().applyQuaternion(item.turn.clone().invert()).applyQuaternion(turn))];
  }
  if (item.shape === "plane") return [[[...item.path, "plane", "normal"], direction(new three.Vector3(0, 0, -1).applyQuaternion(turn))]];
  const values: Values = item.isWritten ? [] : [[[...item.path, "at_mm"], mmVector(item.place!)]];
  values.push([[...item.path, "pointing"], direction(new three.Vector3(0, 0, -1).applyQuaternion(turn))]);
  if (item.shape === "scalpel") values.push([[...item.path, "facing"], direction(new three.Vector3(1, 0, 0).applyQuaternion(turn))]);
  return values;
}

function boxed(item: Item, place: three.Vector3, size: three.Vector3): Values {
  const half = size.clone().multiplyScalar(0.5);
  return [
    [[...item.path, "box", "min_mm"], mmVector(place.clone().sub(half))],
    [[...item.path, "box", "max_mm"], mmVector(place.clone().add(half))],
  ];
}

/** Of a ball, a box or an organ that got another size. */
export function sized(item: Item, size: three.Vector3): Values {
  if (item.kind === "organ") {
    const scale = three.MathUtils.clamp(Math.round(1e4 * size.x) / 1e4, 0.001, 1000);
    return [[[...item.path, "scale"], scale], ...kept(item, item.offset.clone().multiplyScalar(scale / item.size.x))];
  }
  if (item.shape === "sphere") return [[[...item.path, "sphere", "radius_mm"], mm(Math.max(size.x, 1e-4))]];
  return item.shape === "box" ? boxed(item, item.place!, size.clone().max(new three.Vector3(1e-4, 1e-4, 1e-4))) : [];
}

/** What is at a path of a scene, as people say it: "radius_mm of ball", or "tools" for several of them. */
export function saidOf(path: JSONPath, scene: Json): string {
  const item = itemsOf(scene, null).filter((i) => i.path.every((key, k) => path[k] === key)).sort((a, b) => b.path.length - a.path.length)[0];
  const words = path.slice(item?.path.length ?? 0).filter((key) => typeof key === "string").join(" ");
  return item ? `${words}${words && " of "}${item.name}` : words;
}

/** A name that no entry of the list has yet: probe 1, probe 2 ... */
export function freeName(list: Fields[], stem: string): string {
  const taken = new Set(list.map((entry) => entry.name));
  if (!taken.has(stem)) return stem;
  for (let i = 2; ; ++i) if (!taken.has(`${stem}-${i}`)) return `${stem}-${i}`;
}
