// What belongs to an organ goes with it: its anchors, where it was fitted, and the tools, probes, loads and forbidden regions
// that no other organ is nearer to.
import type { JSONPath } from "jsonc-parser";
import * as three from "three";
import { direction, isFields, type Fields, lengthOf, listOf, metresOf, mm, mmVector, organPoses, type OrganPose } from "./items";
import type { Json } from "./json_edit";
import type { OrganSpheres } from "./protocol";

type Values = [JSONPath, Json | undefined][];

const kPoseKeys = ["at_mm", "turn_deg", "scale"];
const kNoTurn = 1e-9; // [rad]

/** From one pose of an organ to another: where its tissue goes. */
class Motion {
  readonly turn: three.Quaternion;
  readonly scale: number;

  constructor(private readonly from: OrganPose, private readonly to: OrganPose) {
    this.turn = to.turn.clone().multiply(from.turn.clone().invert());
    this.scale = to.scale / from.scale;
  }

  get isTurned(): boolean {
    return this.turn.angleTo(new three.Quaternion()) > kNoTurn;
  }

  of(place: three.Vector3): three.Vector3 {
    return place.clone().sub(this.from.place).multiplyScalar(this.scale).applyQuaternion(this.turn).add(this.to.place);
  }

  /** The sides of a box that stays along the axes: each is the one that is turned nearest to it. */
  sides(size: three.Vector3): three.Vector3 {
    const columns = [0, 1, 2].map((axis) => new three.Vector3().setComponent(axis, 1).applyQuaternion(this.turn));
    const free = [0, 1, 2], sides = new three.Vector3();
    for (let row = 0; row < 3; ++row) {
      const along = (column: number) => Math.abs(columns[column].getComponent(row));
      const nearest = free.reduce((best, column) => (along(column) > along(best) ? column : best));
      free.splice(free.indexOf(nearest), 1);
      sides.setComponent(row, size.getComponent(nearest) * this.scale);
    }
    return sides;
  }
}

/** A thing that has a place, as the text says it. */
interface Thing {
  place: three.Vector3;
  moved: (motion: Motion) => Values;
}

function pointOf(path: JSONPath, value: Json | undefined): Thing[] {
  const place = metresOf(value);
  return place ? [{ place, moved: (motion) => [[path, mmVector(motion.of(place))]] }] : [];
}

function turnedOf(path: JSONPath, value: Json | undefined, motion: Motion): Values {
  const way = metresOf(value);
  return way && way.length() > 0 && motion.isTurned ? [[path, direction(way.normalize().applyQuaternion(motion.turn))]] : [];
}

/** A box, a sphere or a plane of an anchor or a forbidden region. */
function regionOf(path: JSONPath, { sphere, box, plane }: Fields): Thing[] {
  const both = (points: Thing[], more: (motion: Motion) => Values): Thing[] => points.map(({ place, moved }) => ({ place, moved: (motion) => [...moved(motion), ...more(motion)] }));
  if (isFields(sphere)) {
    const radius = lengthOf(sphere.radius_mm, 0);
    return both(pointOf([...path, "sphere", "centre_mm"], sphere.centre_mm), ({ scale }) => (scale === 1 ? [] : [[[...path, "sphere", "radius_mm"], mm(radius * scale)]]));
  }
  if (isFields(plane)) return both(pointOf([...path, "plane", "point_mm"], plane.point_mm), (motion) => turnedOf([...path, "plane", "normal"], plane.normal, motion));
  const least = isFields(box) ? metresOf(box.min_mm) : null, most = isFields(box) ? metresOf(box.max_mm) : null;
  if (!least || !most) return [];
  const place = least.clone().add(most).multiplyScalar(0.5), size = most.clone().sub(least);
  return [{ place, moved: (motion) => {
    const middle = motion.of(place), half = motion.sides(size).multiplyScalar(0.5);
    return [[[...path, "box", "min_mm"], mmVector(middle.clone().sub(half))], [[...path, "box", "max_mm"], mmVector(middle.add(half))]];
  } }];
}

function toolOf(path: JSONPath, tool: Fields): Thing[] {
  const key = tool.kind === "pin" ? "holds_mm" : "at_mm";
  return pointOf([...path, key], tool[key]).map(({ place, moved }) => ({
    place, moved: (motion) => [...moved(motion), ...["pointing", "facing"].flatMap((way) => turnedOf([...path, way], tool[way], motion))],
  }));
}

/** What an organ has of its own that has a place in the scene. */
function ownOf(organ: Fields, path: JSONPath): Thing[] {
  const fitted = (fields: Fields, at: JSONPath) => {
    const material = isFields(fields.material) ? fields.material : {};
    return isFields(material.fitted_for) ? pointOf([...at, "material", "fitted_for", "place_mm"], material.fitted_for.place_mm) : [];
  };
  return [
    ...listOf(organ, "anchors").flatMap((anchor, i) => regionOf([...path, "anchors", i], anchor)),
    ...fitted(organ, path), ...listOf(organ, "layers").flatMap((layer, i) => fitted(layer, [...path, "layers", i])),
  ];
}

/** What belongs to the organ that is nearest to it. */
function sharedOf(scene: Json | undefined): Thing[] {
  const all = (key: string, of: (path: JSONPath, fields: Fields) => Thing[]) => listOf(scene, key).flatMap((fields, i) => of([key, i], fields));
  const point = (path: JSONPath, fields: Fields) => pointOf([...path, "at_mm"], fields.at_mm);
  return [...all("tools", toolOf), ...all("probes", point), ...all("loads", point), ...all("forbidden", regionOf)];
}

/** The organ whose spheres are nearest to a place. `spheres`: of each organ where they are shown, at the poses `shown`, while
    the organs are at `poses`. -1: there is none. */
function nearestOrgan(place: three.Vector3, spheres: OrganSpheres[], shown: OrganPose[], poses: OrganPose[]): number {
  if (poses.length === 1) return 0;
  let nearest = -1, least = Infinity;
  spheres.forEach(({ centre, radius }, organ) => {
    if (!shown[organ] || !poses[organ]) return;
    const back = new Motion(poses[organ], shown[organ]), at = back.of(place);
    for (let i = 0; i < centre.length; i += 3) {
      const away = (Math.hypot(centre[i] - at.x, centre[i + 1] - at.y, centre[i + 2] - at.z) - radius) / back.scale;
      if (away < least) least = away, nearest = organ;
    }
  });
  return nearest;
}

/** What goes with the organs that `values` place anew, in a scene that is `before`. `spheres`, `shown`: as of nearestOrgan(). */
export function takenAlong(values: Values, before: Json | undefined, spheres: OrganSpheres[], shown: OrganPose[]): Values {
  const poses = values.filter(([path]) => path[0] === "organs" && path.length === 3 && kPoseKeys.includes(String(path[2])));
  const moving = new Set(poses.map(([path]) => Number(path[1])));
  if (moving.size === 0) return [];
  const after = structuredClone(before), organs = listOf(before, "organs");
  for (const [[, organ, key], value] of poses) listOf(after, "organs")[Number(organ)][key] = value!;
  const from = organPoses(before), to = organPoses(after);
  const along = (things: Thing[], organOf: (thing: Thing) => number) => things.flatMap((thing) => {
    const organ = organOf(thing);
    return moving.has(organ) ? thing.moved(new Motion(from[organ], to[organ])) : [];
  });
  return [
    ...organs.flatMap((organ, i) => along(ownOf(organ, ["organs", i]), () => i)),
    ...along(sharedOf(before), ({ place }) => nearestOrgan(place, spheres, shown, from)),
  ];
}
