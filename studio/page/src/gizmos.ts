// Handles on the picture by which the things of a scene are placed.
import * as three from "three";
import { TransformControls } from "three/addons/controls/TransformControls.js";
import type { JSONPath } from "jsonc-parser";
import { type Item, placed, sized, turned } from "./items";
import { shapeOf } from "./item_shapes";
import type { Json } from "./json_edit";
import { apart, type Label } from "./labels";
import { alongRow, rowsOf } from "./rows";
import type { StageScene } from "./stage_scene";
import type { Viewer } from "./viewer";

export type Values = [JSONPath, Json | undefined][];
export type GizmoMode = "move" | "turn" | "size";

const kEdge = 12; // where a handle stays whose item is outside the picture [px]
const kStill = 3; // a press that moves less is a click [px]
export const kNudge = 0.001, kFineNudge = 0.0001; // of an arrow key [m]
const kRoomBelow = 40; // of the picture, for a name below its handle [px]
const kClearance = 0.002; // between a tool and the surface that it was dragged to [m]

/** What an item can do besides being moved. */
export function modesOf(item: Item | null): GizmoMode[] {
  if (!item?.place) return [];
  if (item.kind === "organ") return ["move", "turn", "size"];
  if (item.shape === "scalpel" || item.shape === "ball" || item.shape === "plane") return ["move", "turn"];
  return item.shape === "sphere" || item.shape === "box" ? ["move", "size"] : ["move"];
}

export class Gizmos {
  isSnapping = true; // what is dragged by its handle follows the drawn surface
  onSelect: (key: string) => void = () => {};
  onPreview: (values: Values) => void = () => {};
  onCommit: () => void = () => {};
  newest: (key: string) => Item | undefined = (key) => this.item(key); // as the text has it now, drawn or not
  private stage: StageScene | null = null;
  private items: Item[] = [];
  private selected = "";
  private mode: GizmoMode = "move";
  private size = 0.1; // of the scene [m]
  private group = new three.Group();
  private readonly pivot = new three.Object3D();
  private readonly controls: TransformControls;
  private readonly handles = new Map<string, HTMLButtonElement>();
  private rows: Item[][] = []; // of balls whose handles are one stop of the tabulator
  private stop = ""; // the ball that had the keyboard last, or was chosen
  private grabbed = ""; // handle that is dragged
  private begun: Item | null = null; // what is dragged, as it was before
  private pressed: { x: number; y: number } | null = null; // a press on the picture that may become a click
  private readonly disposed = new AbortController();

  constructor(private readonly viewer: Viewer, private readonly overlay: HTMLElement) {
    this.controls = new TransformControls(viewer.camera, viewer.canvas);
    this.controls.setSize(0.8);
    this.controls.addEventListener("change", () => viewer.draw());
    this.controls.addEventListener("dragging-changed", (event) => {
      viewer.controls.enabled = !event.value;
      if (!event.value) this.end(), this.update();
    });
    this.controls.addEventListener("objectChange", () => this.dragged());
    viewer.onDraw = () => this.layHandles();
    this.listenToPicture();
  }

  get isDragging(): boolean {
    return this.controls.dragging || this.grabbed !== "";
  }

  /** Shows these items in a scene. While the brush paints, presses are its own and nothing is selected. */
  set(stage: StageScene | null, items: Item[], selected: string, mode: GizmoMode, isPainting: boolean): void {
    this.overlay.classList.toggle("painting", isPainting);
    if (stage !== this.stage) {
      this.stage?.scene.remove(this.group, this.pivot, this.controls.getHelper());
      stage?.scene.add(this.pivot, this.controls.getHelper());
      this.stage = stage;
      if (stage) this.size = new three.Vector3(...stage.view.most).distanceTo(new three.Vector3(...stage.view.least));
    }
    this.stop = selected || this.stop;
    this.items = items, this.selected = selected, this.mode = mode;
    this.rows = rowsOf(items).filter((row) => row.length > 1);
    this.update();
  }

  private item(key: string): Item | undefined {
    return this.items.find((item) => item.key === key);
  }

  private update(): void {
    const { stage } = this;
    this.group.removeFromParent();
    this.group = new three.Group();
    if (stage) {
      for (const item of this.items) {
        const shape = shapeOf(item, stage, this.size, item.key === this.selected);
        shape.userData.isCamera = item.kind === "camera";
        this.group.add(shape);
      }
      stage.scene.add(this.group);
    }
    const item = this.item(this.selected);
    if (!item?.place || !stage) this.controls.detach();
    else if (!this.controls.dragging) {
      this.pivot.position.copy(item.place).add(item.offset);
      this.pivot.quaternion.copy(this.mode === "turn" ? item.turn : new three.Quaternion());
      this.pivot.scale.set(1, 1, 1);
      this.controls.setMode(this.mode === "move" ? "translate" : this.mode === "turn" ? "rotate" : "scale");
      this.controls.setSpace(this.mode === "turn" ? "local" : "world");
      this.controls.attach(this.pivot);
    }
    this.makeHandles();
    this.layHandles();
    this.viewer.draw();
  }

  /** The arrows, rings or cubes around the selected item were dragged. */
  private dragged(): void {
    const item = this.controls.dragging ? this.before(this.selected) : undefined;
    if (!item?.place) return;
    if (this.mode === "move") this.onPreview(placed(item, this.pivot.position.clone().sub(item.offset)));
    else if (this.mode === "turn") this.onPreview(turned(item, this.pivot.quaternion.clone()));
    else {
      const { scale } = this.pivot;
      const ratio = [scale.x, scale.y, scale.z].reduce((most, s) => (Math.abs(s - 1) > Math.abs(most - 1) ? s : most), 1);
      const factor = item.shape === "sphere" || item.kind === "organ" ? new three.Vector3(ratio, ratio, ratio) : scale.clone();
      this.onPreview(sized(item, item.size.clone().multiply(factor)));
    }
  }

  /** The item as it was before the drag that goes on. */
  private before(key: string): Item | undefined {
    if (this.begun?.key !== key) this.begun = this.item(key) ?? null;
    return this.begun ?? undefined;
  }

  private end(): void {
    this.begun = null;
    this.onCommit();
  }

  private makeHandles(): void {
    const keys = new Set(this.items.filter((item) => item.place && (item.kind !== "organ" || item.key === this.selected)).map((item) => item.key));
    for (const [key, handle] of this.handles) if (!keys.has(key)) handle.remove(), this.handles.delete(key);
    for (const key of keys) {
      let handle = this.handles.get(key);
      if (!handle) {
        handle = document.createElement("button");
        handle.type = "button";
        handle.append(document.createElement("span"));
        this.listen(handle, key);
        this.handles.set(key, handle);
        this.overlay.append(handle);
      }
      const item = this.item(key)!;
      handle.className = `handle ${item.kind}`;
      handle.tabIndex = 0;
      handle.setAttribute("aria-pressed", String(key === this.selected));
      handle.firstElementChild!.textContent = item.name;
      handle.setAttribute("aria-label", `${item.kind} ${item.name}: ${this.keysOf(item)}`);
    }
  }

  /** What keys do on a handle, for whoever hears it. */
  private keysOf({ key }: Item): string {
    const row = this.rowOf(key), isChosen = key === this.selected;
    if (row && !isChosen) return `one of ${row.length}; arrow keys go to the others, Enter chooses it`;
    return `drag it, or move it with the arrow keys${isChosen ? "; Escape lets it go" : ""}`;
  }

  private rowOf(key: string): Item[] | undefined {
    return this.rows.find((row) => row.some((item) => item.key === key));
  }

  /** One handle of each row is a stop of the tabulator, if one can be seen. */
  private layStops(): void {
    for (const row of this.rows) {
      const seen = row.filter(({ key }) => this.handles.get(key)?.style.display === "");
      const stop = seen.find(({ key }) => key === this.stop) ?? seen[0];
      for (const item of row) this.handles.get(item.key)?.setAttribute("tabindex", item === stop ? "0" : "-1");
    }
  }

  /** Arrow keys go along a row, until one of it is chosen: then they move that. Whether the key was of this use. */
  private goAlong(key: string, event: KeyboardEvent): boolean {
    const row = this.rowOf(key);
    if (!row || key === this.selected) return false;
    const next = alongRow(event.key, row.findIndex((item) => item.key === key), row.length);
    if (next === null) return false;
    event.preventDefault();
    this.stop = row[next].key;
    const handle = this.handles.get(this.stop)!;
    handle.style.display = ""; // it may be beyond the picture
    handle.focus();
    this.layHandles();
    return true;
  }

  private layHandles(): void {
    // A camera through which the viewer looks would frame the picture.
    for (const shape of this.group.children) if (shape.userData.isCamera) shape.visible = shape.position.distanceTo(this.viewer.camera.position) > 0.3 * this.size;
    const { clientWidth: width, clientHeight: height } = this.viewer.canvas;
    const named: [HTMLElement, Label][] = [];
    for (const [key, handle] of this.handles) {
      const item = this.item(key), at = item?.place && this.viewer.pixelOf(item.place.clone().add(item.offset));
      const isIn = at && at.x > 0 && at.y > 0 && at.x < width && at.y < height;
      // One that has the keyboard waits at the edge: a hidden one would lose it, and the keys that follow.
      const isKept = isIn || handle === document.activeElement;
      handle.style.display = isKept ? "" : "none";
      handle.classList.toggle("beyond", isKept && !isIn);
      if (!isKept || !at) continue;
      const edge = isIn ? 0 : kEdge;
      const x = three.MathUtils.clamp(at.x, edge, width - edge), y = three.MathUtils.clamp(at.y, edge, height - edge);
      handle.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
      const isLeft = x > width - 120;
      // Arrows, rings or cubes stand beside the one that is chosen: its name makes room for them.
      const isBelow = key === this.selected && y < height - kRoomBelow;
      handle.classList.toggle("left", isLeft);
      handle.classList.toggle("below", isBelow);
      const name = handle.firstElementChild as HTMLElement;
      const label = { x, y, width: name.offsetWidth, height: name.offsetHeight, isLeft, isBelow };
      if (key === this.selected) named.unshift([name, label]); // it stays; the others make room
      else named.push([name, label]);
    }
    const downs = apart(named.map(([, label]) => label), height);
    named.forEach(([name], i) => (name.style.transform = downs[i] ? `translateY(${downs[i].toFixed(1)}px)` : ""));
    this.layStops();
  }

  /** A click on an organ's surface selects the organ; arrow keys move what is selected. */
  private listenToPicture(): void {
    const { canvas } = this.viewer, { signal } = this.disposed;
    canvas.addEventListener("pointerdown", ({ button, clientX: x, clientY: y }) => {
      const isFree = button === 0 && !this.controls.dragging && !this.overlay.classList.contains("painting");
      this.pressed = isFree ? { x, y } : null;
    }, { signal });
    canvas.addEventListener("pointermove", ({ clientX, clientY }) => {
      if (this.pressed && Math.hypot(clientX - this.pressed.x, clientY - this.pressed.y) > kStill) this.pressed = null;
    }, { signal });
    canvas.addEventListener("click", () => {
      const hit = this.pressed && this.stage?.meet(this.viewer.rayAt(this.pressed.x, this.pressed.y));
      const organ = hit && this.items.find(({ kind, index }) => kind === "organ" && index === hit.organ);
      if (organ) this.onSelect(organ.key);
    }, { signal });
    canvas.addEventListener("keydown", (event) => this.selected && this.nudge(this.selected, event), { signal });
  }

  private listen(handle: HTMLButtonElement, key: string): void {
    let from: { x: number; y: number } | null = null;
    handle.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      handle.setPointerCapture(event.pointerId);
      from = { x: event.clientX, y: event.clientY };
      this.onSelect(key);
    });
    handle.addEventListener("pointermove", (event) => {
      if (!from || (!this.grabbed && Math.hypot(event.clientX - from.x, event.clientY - from.y) < kStill)) return;
      this.grabbed = key;
      this.dragTo(key, event.clientX, event.clientY);
    });
    const end = () => {
      from = null;
      if (this.grabbed === key) this.grabbed = "", this.end();
    };
    handle.addEventListener("pointerup", end);
    handle.addEventListener("lostpointercapture", end);
    // The tabulator passes without choosing: what was chosen keeps its numbers on the way to them.
    handle.addEventListener("click", () => this.onSelect(key));
    handle.addEventListener("keydown", (event) => {
      if (event.key === "Escape" && key === this.selected) this.onSelect("");
      else if (!this.goAlong(key, event)) this.nudge(key, event);
    });
  }

  /** Moves an item to where the pointer is: onto the surface, or in a plane that faces the viewer. */
  private dragTo(key: string, x: number, y: number): void {
    const item = this.before(key);
    if (!item?.place || !this.stage) return;
    const ray = this.viewer.rayAt(x, y);
    const hit = this.isSnapping && item.kind !== "camera" && item.kind !== "organ" ? this.stage.meet(ray) : null;
    if (hit) return this.onPreview(onSurface(item, hit.place, hit.normal));
    const facing = new three.Plane().setFromNormalAndCoplanarPoint(this.viewer.camera.getWorldDirection(new three.Vector3()), item.place.clone().add(item.offset));
    const place = ray.ray.intersectPlane(facing, new three.Vector3());
    if (place) this.onPreview(placed(item, place.sub(item.offset)));
  }

  private nudge(key: string, event: KeyboardEvent): void {
    const item = this.newest(key), step = event.shiftKey ? kFineNudge : kNudge; // keys may come faster than pictures
    const ways: Record<string, [number, number, number]> = {
      ArrowLeft: [-step, 0, 0], ArrowRight: [step, 0, 0], ArrowUp: [0, step, 0], ArrowDown: [0, -step, 0], PageUp: [0, 0, -step], PageDown: [0, 0, step],
    };
    const way = ways[event.key];
    if (!item?.place || !way) return;
    event.preventDefault();
    this.onSelect(key);
    const [right, up, back] = [new three.Vector3(), new three.Vector3(), new three.Vector3()];
    this.viewer.camera.matrixWorld.extractBasis(right, up, back);
    this.onPreview(placed(item, item.place.clone().addScaledVector(right, way[0]).addScaledVector(up, way[1]).addScaledVector(back, way[2])));
    this.onCommit();
  }

  dispose(): void {
    this.disposed.abort();
    this.viewer.onDraw = () => {};
    this.controls.detach();
    this.controls.dispose();
    for (const handle of this.handles.values()) handle.remove();
  }
}

/** An item on the surface: a tool above it, pointing into it; anything else in it. */
export function onSurface(item: Item, place: three.Vector3, normal: three.Vector3): Values {
  if (item.kind !== "tool" || item.shape === "pin") return placed(item, place);
  const away = item.shape === "ball" ? item.size.x + kClearance : kClearance;
  const before = new three.Vector3(0, 0, 1).applyQuaternion(item.turn);
  const turn = new three.Quaternion().setFromUnitVectors(before, normal).multiply(item.turn);
  return [...placed({ ...item, isWritten: true }, place.clone().addScaledVector(normal, away)), ...turned({ ...item, isWritten: true }, turn)];
}
