import * as three from "three";
import type { Item } from "./items";
import type { StageScene } from "./stage_scene";

const kUnitBall = new three.SphereGeometry(1, 28, 18);
const kUnitBox = new three.BoxGeometry(1, 1, 1);
const kUnitEdges = new three.EdgesGeometry(kUnitBox);
const kUnitSquare = new three.PlaneGeometry(1, 1);
const kUnitRim = new three.EdgesGeometry(kUnitSquare);
export const kItemColours: Record<Item["kind"], number> = { organ: 0xe7eaee, anchor: 0x7cc0ff, tool: 0xffc857, probe: 0x7fd6a0, obstacle: 0x9fb0b8, zone: 0xff8a80, camera: 0xd9c7ff };

function glassy(colour: number, opacity: number): three.Material {
  return new three.MeshPhongMaterial({ color: colour, transparent: true, opacity, depthWrite: false, side: three.DoubleSide });
}
function lines(colour: number): three.Material {
  return new three.LineBasicMaterial({ color: colour, transparent: true, opacity: 0.9 });
}

/** How an item is drawn. `size`: of the scene [m]. */
export function shapeOf(item: Item, stage: StageScene, size: number, isSelected: boolean): three.Object3D {
  const group = new three.Group();
  const colour = kItemColours[item.kind];
  if (!item.place || item.kind === "organ") return group;
  if (item.shape === "ball" || item.shape === "scalpel") {
    const shape = stage.toolShape(item.index);
    if (shape) {
      const opacity = item.isWritten ? 1 : 0.35;
      const material = new three.MeshPhongMaterial({
        vertexColors: true, transparent: opacity < 1, opacity, specular: 0x777777, shininess: 70, side: three.DoubleSide,
      });
      group.add(new three.Mesh(shape, material));
    }
    group.quaternion.copy(item.turn);
  } else if (item.shape === "sphere" || item.shape === "box") {
    if (item.kind !== "obstacle") group.add(new three.Mesh(item.shape === "sphere" ? kUnitBall : kUnitBox, glassy(colour, isSelected ? 0.34 : 0.2)));
    if (item.shape === "box") group.add(new three.LineSegments(kUnitEdges, lines(colour)));
    group.scale.copy(item.size).max(new three.Vector3(1e-5, 1e-5, 1e-5));
  } else if (item.shape === "plane") {
    // Obstacles are drawn with the scene: of what would lie on them only edges are.
    group.add(item.kind === "obstacle" ? new three.LineSegments(kUnitRim, lines(colour)) : new three.Mesh(kUnitSquare, glassy(colour, 0.16)));
    group.scale.setScalar(size);
    group.quaternion.copy(item.turn);
  } else if (item.shape === "camera") {
    group.add(frustumOf(item, size));
  } else {
    const ball = new three.Mesh(kUnitBall, new three.MeshPhongMaterial({ color: colour }));
    ball.scale.setScalar(0.008 * size);
    group.add(ball);
  }
  group.position.copy(item.place);
  return group;
}

/** A small pyramid from the eye towards what the camera looks at. */
function frustumOf(item: Item, size: number): three.Object3D {
  const deep = 0.12 * size, half = 0.045 * size;
  const points: number[] = [];
  const corners = [[-1, -0.6], [1, -0.6], [1, 0.6], [-1, 0.6]].map(([x, y]) => [half * x, half * y, -deep]);
  corners.forEach((corner, i) => points.push(0, 0, 0, ...corner, ...corner, ...corners[(i + 1) % 4]));
  const geometry = new three.BufferGeometry();
  geometry.setAttribute("position", new three.Float32BufferAttribute(points, 3));
  const frustum = new three.LineSegments(geometry, lines(kItemColours.camera));
  frustum.quaternion.copy(item.turn);
  return frustum;
}
