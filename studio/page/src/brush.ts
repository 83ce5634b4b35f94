// Painting anchors on the surface: a stroke is a row of balls whose spheres never move.
import * as three from "three";
import type { JSONPath } from "jsonc-parser";
import type { Values } from "./gizmos";
import { type Item, mm, mmVector } from "./items";
import type { StageScene } from "./stage_scene";
import type { Viewer } from "./viewer";

const kApart = 0.6; // distance of two balls of a stroke, in radii
const kKeyStep = 8; // of an arrow key [px]
const kKeyWays: { [key: string]: [number, number] } = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

type Hit = NonNullable<ReturnType<StageScene["meet"]>>;

export class Brush {
  radius = 0.01; // [m]
  onPreview: (values: Values) => void = () => {};
  onCommit: () => void = () => {};
  onNothing: (why: string) => void = () => {}; // a stroke changed nothing; empty: the brush went on
  newest: () => Item[] = () => this.items; // as the text has them now, drawn or not
  private stage: StageScene | null = null;
  private items: Item[] = []; // of the scene as it was before the stroke
  private stroke: { organ: number; place: three.Vector3 }[] = [];
  private erased = new Set<string>();
  private isDown = false;
  private refusal = ""; // why the newest place of the stroke changed nothing
  private pointer: { x: number; y: number } | null = null; // of the mouse or the keys, in the window [px]
  private readonly cursor: three.Mesh;

  constructor(private readonly viewer: Viewer) {
    const material = new three.MeshBasicMaterial({ color: 0x7cc0ff, transparent: true, opacity: 0.35, depthTest: false });
    this.cursor = new three.Mesh(new three.SphereGeometry(1, 24, 16), material);
    this.cursor.visible = false;
    this.cursor.renderOrder = 1;
  }

  /** Paints in this scene; null: no longer. */
  use(stage: StageScene | null, items: Item[]): void {
    if (!this.isDown) this.items = items;
    if (stage === this.stage) return;
    this.cursor.removeFromParent();
    stage?.scene.add(this.cursor);
    if ((stage === null) !== (this.stage === null)) {
      this.listen(stage !== null);
      this.pointer = null; // a scene that was filled again leaves the brush where it is
    }
    this.stage = stage;
    this.cursor.visible = false;
    this.viewer.draw();
  }

  private listen(on: boolean): void {
    const change = on ? "addEventListener" : "removeEventListener";
    this.viewer.controls.enabled = !on;
    this.viewer.canvas[change]("pointerdown", this.down as EventListener);
    this.viewer.canvas[change]("pointermove", this.move as EventListener);
    this.viewer.canvas[change]("pointerup", this.up as EventListener);
    this.viewer.canvas[change]("keydown", this.key as EventListener);
    if (on) this.viewer.canvas.focus();
  }

  private readonly down = (event: PointerEvent): void => {
    if (event.button !== 0) return;
    this.viewer.canvas.setPointerCapture(event.pointerId);
    this.begin();
    this.isDown = true;
    this.move(event);
  };

  /** Begins a stroke: keys may come faster than pictures. */
  private begin(): void {
    this.items = this.newest();
    this.stroke = [], this.erased.clear();
    this.refusal = "";
    this.onNothing("");
  }

  private readonly up = (): void => {
    if (!this.isDown) return;
    this.isDown = false;
    this.finish();
  };

  /** Ends a stroke. */
  private finish(): void {
    if (this.stroke.length > 0 || this.erased.size > 0) this.onCommit();
    else this.onNothing(this.refusal);
  }

  private readonly move = (event: PointerEvent): void => {
    this.pointer = { x: event.clientX, y: event.clientY };
    const hit = this.point();
    if (!this.isDown) this.onNothing("");
    if (!hit || !this.isDown) return;
    if (event.shiftKey) this.erase(hit.place);
    else this.paint(hit.organ, hit.place);
  };

  /** Shows the brush where the pointer meets the surface. Returns the place; null: it meets none. */
  private point(): Hit | null {
    const hit = (this.pointer && this.stage?.meet(this.viewer.rayAt(this.pointer.x, this.pointer.y))) ?? null;
    this.cursor.visible = hit !== null;
    if (hit) this.cursor.position.copy(hit.place), this.cursor.scale.setScalar(this.radius);
    this.viewer.draw();
    return hit;
  }

  /** Keys do what the mouse does: arrows move the brush, Space is a stroke where it is. */
  private readonly key = (event: KeyboardEvent): void => {
    const way = kKeyWays[event.key];
    if ((!way && event.key !== " ") || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    if (way) this.onNothing("");
    if (!this.point()) this.pointer = this.middle();
    else if (way) {
      const before = this.pointer!;
      this.pointer = { x: before.x + kKeyStep * way[0], y: before.y + kKeyStep * way[1] };
      if (!this.point()) this.pointer = before; // the brush stays on the surface
    }
    const hit = this.point();
    if (!hit || way) return;
    this.begin();
    if (event.shiftKey) this.erase(hit.place);
    else this.paint(hit.organ, hit.place);
    this.finish();
  };

  /** Where the first organ's middle is seen, where the brush begins. */
  private middle(): { x: number; y: number } | null {
    const organ = this.stage?.view.organs[0];
    if (!organ) return null;
    const box = this.viewer.canvas.getBoundingClientRect();
    const at = this.viewer.pixelOf(new three.Vector3(...organ.least).add(new three.Vector3(...organ.most)).multiplyScalar(0.5));
    return at && { x: box.left + at.x, y: box.top + at.y };
  }

  private paint(organ: number, place: three.Vector3): void {
    if (this.stroke.some((ball) => ball.organ === organ && ball.place.distanceTo(place) < kApart * this.radius)) return;
    if (this.isPainted(organ, place)) return void (this.refusal = "This place is an anchor already");
    if (!this.holdsSphere(organ, place)) return void (this.refusal = "The brush holds no sphere here"); // such an anchor is an error
    this.stroke.push({ organ, place: place.clone() });
    const counts = new Map<number, number>();
    const values: Values = this.stroke.map((ball) => {
      const count = counts.get(ball.organ) ?? this.items.filter((item) => item.kind === "anchor" && item.path[1] === ball.organ).length;
      counts.set(ball.organ, count + 1);
      return [["organs", ball.organ, "anchors", count] as JSONPath, { sphere: { centre_mm: mmVector(ball.place), radius_mm: mm(this.radius) } }];
    });
    this.onPreview(values);
  }

  private erase(place: three.Vector3): void {
    const before = this.erased.size;
    for (const item of this.items)
      if (item.shape === "sphere" && item.place && item.place.distanceTo(place) < Math.max(this.radius, item.size.x)) this.erased.add(item.key);
    if (this.erased.size === before) return void (this.refusal = "There is no painted anchor here");
    const gone = this.items.filter((item) => this.erased.has(item.key)).reverse(); // the last of a list first
    this.onPreview(gone.map((item) => [item.path, undefined]));
  }

  /** Whether that very anchor was there before the stroke: twice it would do no more than once. */
  private isPainted(organ: number, place: three.Vector3): boolean {
    const own = [...mmVector(place), mm(this.radius)].join();
    return this.items.some((item) => item.kind === "anchor" && item.path[1] === organ && item.shape === "sphere" && item.place !== null
      && [...mmVector(item.place), mm(item.size.x)].join() === own);
  }

  private holdsSphere(organ: number, place: three.Vector3): boolean {
    const spheres = this.stage?.organSpheres[organ];
    if (!spheres) return true;
    for (let i = 0; i < spheres.centre.length; i += 3)
      if (Math.hypot(spheres.centre[i] - place.x, spheres.centre[i + 1] - place.y, spheres.centre[i + 2] - place.z) <= this.radius) return true;
    return false;
  }
}
