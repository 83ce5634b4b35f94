// What is seen of a session, in the words of `export`.
import { Vector3 } from "three";
import type { CameraView, SceneView, Vector } from "./protocol";

export interface Look {
  view: string; // surface, spheres, both, elements
  by: string; // of elements; empty: stretch
  cutaway: string; // an axis and its place in mm, as y=12.5; empty: none
  camera: string; // its name, or places as freeCamera() writes them; empty: the one that `export` chooses
}

export const kPlainLook: Look = { view: "surface", by: "", cutaway: "", camera: "" };

/** Views with what colours them, and their names. */
export const kViews: [string, string][] = [
  ["surface", "surface"], ["spheres", "spheres"], ["both", "both"],
  ["elements stretch", "elements by stretch"], ["elements tilt", "elements by tilt"], ["elements force", "elements by force"],
];
export const kAxes = ["x", "y", "z"];
const kFieldOfView = 32; // of cameras whose text names none, vertical [degrees]
const kWide = 16 / 9; // pictures for which cameras are set up; in narrower ones they step back

export function viewOf(look: Look): string {
  return look.by ? `${look.view} ${look.by}` : look.view;
}
export function withView(look: Look, name: string): Look {
  const [view, by = ""] = name.split(" ");
  return { ...look, view, by };
}

/** The axis of a cutaway and its place [mm]. */
export function planeOf(look: Look, view: SceneView): { axis: number; place: number; least: number; most: number } | null {
  const axis = kAxes.indexOf(look.cutaway.slice(0, 1));
  if (axis < 0) return null;
  const least = 1e3 * view.least[axis], most = 1e3 * view.most[axis];
  return { axis, least, most, place: look.cutaway.length > 2 ? Number(look.cutaway.slice(2)) : (least + most) / 2 };
}

/** Whether the page draws it; anything else is drawn by the program, as for a video. */
export function isPlain(look: Look): boolean {
  return look.view === "surface" && !look.cutaway && look.camera !== "follow";
}

/** What is drawn of a session, in words. */
export function lookText(look: Look): string {
  return [kViews.find(([name]) => name === viewOf(look))?.[1], look.cutaway && `cut across ${look.cutaway.slice(0, 1)}`, look.camera === "follow" && "camera follow"]
    .filter(Boolean).join(", ");
}

export function isFree(look: Look): boolean {
  return look.camera.includes(":");
}

/** A camera as the text of `--camera`: the eye, what it looks at, and where they are not the usual ones the upward direction
    and the field of view. `up`: that of the scene. */
export function freeCamera(camera: CameraView, up: Vector): string {
  const triple = (v: Vector3) => v.toArray().map((x) => Number(x.toFixed(2))).join(",");
  const parts = [camera.eye, camera.target].map((place) => triple(new Vector3(...place).multiplyScalar(1e3)));
  const own = new Vector3(...camera.up).normalize();
  if (own.dot(new Vector3(...up)) < 0.9999) parts.push(triple(own));
  if (Math.abs(camera.fov_deg - kFieldOfView) > 5e-4) parts.push(String(Number(camera.fov_deg.toFixed(3))));
  return parts.join(":");
}

/** The look as it is seen: where the program chose the camera, that camera. */
export function asSeen(look: Look, seen: CameraView, up: Vector): Look {
  return look.camera ? look : { ...look, camera: freeCamera(seen, up) };
}

/** The camera of the page that sees what a camera of a picture of that size sees. */
export function steppedForward(camera: CameraView, size: string | null): CameraView {
  const [width, height] = (size ?? "16x9").split("x").map(Number);
  const back = Math.max(1, kWide / (width / height)), target = new Vector3(...camera.target);
  return { ...camera, eye: new Vector3(...camera.eye).sub(target).divideScalar(back).add(target).toArray() };
}

/** A camera that looks along an axis from the other side. */
export function mirrored(camera: CameraView, axis: number): CameraView {
  return { ...camera, eye: camera.eye.map((x, i) => (i === axis ? 2 * camera.target[i] - x : x)) as Vector };
}

export function lookParameters(look: Look): { [key: string]: string | undefined } {
  return { view: look.view, by: look.by || undefined, cutaway: look.cutaway || undefined, camera: look.camera || undefined };
}

/** The same as words of a command. */
export function lookWords(look: Look): string[] {
  return [
    ...(look.camera ? ["--camera", look.camera] : []), ...(look.view !== kPlainLook.view ? ["--view", look.view] : []),
    ...(look.by ? ["--by", look.by] : []), ...(look.cutaway ? ["--cutaway", look.cutaway] : []),
  ];
}
