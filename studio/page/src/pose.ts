import * as three from "three";
import type { Vector } from "./protocol";

/** The orientation of a tool: its -z looks along `pointing`, its +x to `facing` as well as it can; without, the shortest turn decides. */
export function orientationOf(pointing: Vector, facing?: Vector): three.Quaternion {
  const turn = new three.Quaternion().setFromUnitVectors(new three.Vector3(0, 0, -1), new three.Vector3(...pointing).normalize());
  if (!facing) return turn;
  const local = new three.Vector3(...facing).applyQuaternion(turn.clone().invert());
  return turn.multiply(new three.Quaternion().setFromAxisAngle(new three.Vector3(0, 0, 1), Math.atan2(local.y, local.x)));
}
