import { useEffect, useState } from "preact/hooks";
import * as three from "three";
import type { JSONPath } from "jsonc-parser";
import type { AuthorScene } from "./author_scene";
import { onSurface } from "./gizmos";
import { cameraValues } from "./inspector";
import { direction, type Fields, freeName, type Item, type ItemKind, itemsOf, kListOf, listOf, mm, mmVector } from "./items";
import { applied, type Json, parseJson, setValue } from "./json_edit";
import type { SceneView } from "./protocol";
import { alongRow, rowsOf } from "./rows";
import type { Viewer } from "./viewer";

const kTitles: [ItemKind, string][] = [["organ", "Organs"], ["anchor", "Anchors"], ["tool", "Tools"], ["probe", "Probes"], ["obstacle", "Obstacles"], ["zone", "Forbidden zones"], ["camera", "Cameras"]];

/** What can be added, and what it begins as. */
const kNew: Record<Exclude<ItemKind, "organ">, [string, string][]> = {
  anchor: [["sphere", "ball"], ["box", "box"]],
  tool: [["ball", "ball"], ["scalpel", "scalpel"]],
  probe: [["probe", "probe"]],
  obstacle: [["plane", "table"], ["box", "block"]],
  zone: [["sphere", "ball"], ["box", "box"]],
  camera: [["camera", "this view"]],
};

/** The place of the surface in the middle of the picture; else in front of the viewer. */
function middleOf(scene: AuthorScene, viewer: Viewer): { place: three.Vector3; normal: three.Vector3; organ: number } {
  const box = viewer.canvas.getBoundingClientRect();
  const ray = viewer.rayAt(box.left + box.width / 2, box.top + box.height / 2);
  const hit = scene.stage?.meet(ray);
  if (hit) return hit;
  // The organ beside the middle is met on the way to its own middle.
  const { view } = scene.shown!;
  const middle = new three.Vector3(...view.least).add(new three.Vector3(...view.most)).multiplyScalar(0.5);
  ray.set(viewer.camera.position, middle.clone().sub(viewer.camera.position).normalize());
  return scene.stage?.meet(ray) ?? { place: middle, normal: new three.Vector3(...view.up), organ: 0 };
}

const kBlock = 0.02; // height of a block [m]
const kBrim = 0.25; // by which it is wider than the organs on each side, of their size

/** What organs stand on as they are shown: a table, or a block that is wider than they are. Where there is a ground, a block stands
    beside them. */
function ground({ view }: { view: SceneView }, shape: string, isThere: boolean): Fields {
  const up = new three.Vector3(...view.up), least = new three.Vector3(...view.least), most = new three.Vector3(...view.most);
  const lowest = new three.Vector3(...up.toArray().map((x, i) => (x > 0 ? least : most).getComponent(i))).dot(up);
  if (shape === "plane") return { plane: { point_mm: mmVector(least.clone().add(most).multiplyScalar(0.5).projectOnPlane(up).addScaledVector(up, lowest)), normal: direction(up) } };
  // Boxes lie along the axes: this one is below the side that faces down most.
  const axis = up.toArray().reduce((best, x, i, all) => (Math.abs(x) > Math.abs(all[best]) ? i : best), 0), brim = most.clone().sub(least).multiplyScalar(kBrim);
  const [from, to] = [least.clone().sub(brim), most.clone().add(brim)];
  const isUp = up.getComponent(axis) > 0, bottom = (isUp ? least : most).getComponent(axis), isAfter = isUp === isThere; // below the organs, or beside them
  if (isThere) {
    const side = (axis + 1) % 3, wide = most.getComponent(side) - least.getComponent(side);
    from.setComponent(side, most.getComponent(side) + 0.1 * wide), to.setComponent(side, most.getComponent(side) + 0.6 * wide);
  }
  from.setComponent(axis, isAfter ? bottom : bottom - kBlock), to.setComponent(axis, isAfter ? bottom + kBlock : bottom);
  return { box: { min_mm: mmVector(from), max_mm: mmVector(to) } };
}

/** Adds a thing where the middle of the picture meets the surface. Returns its key. */
export function addItem(scene: AuthorScene, viewer: Viewer, kind: Exclude<ItemKind, "organ">, shape: string): string {
  const doc = scene.doc!, value = doc.value;
  const { place, normal, organ } = middleOf(scene, viewer);
  const radius = scene.stage?.organSpheres[organ]?.radius ?? 0.004;
  let path: JSONPath, entry: Json;
  const reach = 4 * radius, away = new three.Vector3(reach, reach, reach);
  const region: Fields = shape === "sphere" ? { sphere: { centre_mm: mmVector(place), radius_mm: mm(reach) } }
    : { box: { min_mm: mmVector(place.clone().sub(away)), max_mm: mmVector(place.clone().add(away)) } };
  if (kind === "anchor") {
    path = ["organs", organ, "anchors", listOf(listOf(value, "organs")[organ], "anchors").length];
    entry = region;
  } else {
    const list = listOf(value, kListOf[kind]);
    path = [kListOf[kind], list.length];
    entry = { name: freeName(list, kind === "tool" ? shape : shape === "plane" ? "table" : kind === "obstacle" ? "block" : kind) };
    if (kind === "obstacle") Object.assign(entry, ground(scene.shown!, shape, list.length > 0));
    if (kind === "zone") Object.assign(entry, region);
    if (kind === "tool" && shape === "ball") Object.assign(entry, { kind: "ball", radius_mm: mm(2.5 * radius) });
    if (shape === "scalpel") Object.assign(entry, { kind: "scalpel", blade_length_mm: 40 });
    if (kind === "probe") Object.assign(entry, { at_mm: mmVector(place) });
    if (kind === "camera") for (const [key, field] of cameraValues([], viewer)) Object.assign(entry, { [key[0]]: field! });
  }
  if (kind === "tool") {
    // A tool stands on the surface: its entry with its place is one step.
    const made = setValue(doc.text, path, entry);
    const item = made && itemsOf(parseJson(applied(doc.text, made)), scene.shown?.view ?? null).find((i) => i.key === path.join("/"));
    if (item) for (const [key, field] of onSurface(item, place, normal)) Object.assign(entry, { [key.at(-1)!]: field! });
  }
  doc.set([[path, entry]]);
  return path.join("/");
}

/** `isStop`: the tabulator comes to it; otherwise arrow keys do, from another one of its row. */
function Row({ item, selected, isStop = true, onSelect }: { item: Item; selected: string; isStop?: boolean; onSelect: (key: string) => void }) {
  return (
    <li>
      <button type="button" tabIndex={isStop ? 0 : -1} aria-current={item.key === selected} title={item.name} onClick={() => onSelect(item.key)}><i class={`dot ${item.kind}`} /><span>{item.name}</span></button>
    </li>
  );
}

/** What was painted: many balls in one row, which opens. Arrow keys go from one to the next. */
function Stroke({ balls, selected, onSelect, onRemove }: { balls: Item[]; selected: string; onSelect: (key: string) => void; onRemove: () => void }) {
  const chosen = balls.findIndex(({ key }) => key === selected);
  const [isOpen, setOpen] = useState(false), [stop, setStop] = useState(0);
  useEffect(() => void (chosen >= 0 && setStop(chosen)), [chosen]);
  const name = `${balls.length} balls of ${mm(balls[0].size.x)} mm`, last = balls.length - 1;
  return (
    <li class="stroke">
      <details open={isOpen || chosen >= 0} onToggle={(e) => setOpen(e.currentTarget.open)}>
        <summary><i class="dot anchor" /><span>{name}</span></summary>
        <ul aria-label={`${name}: arrow keys go from one to the next`} onKeyDown={(e) => {
          const next = alongRow(e.key, Math.min(stop, last), balls.length);
          if (next === null) return;
          e.preventDefault();
          setStop(next);
          e.currentTarget.querySelectorAll("button")[next].focus();
        }}>{balls.map((ball, i) => <Row key={ball.key} item={ball} selected={selected} isStop={i === Math.min(stop, last)} onSelect={onSelect} />)}</ul>
        <button type="button" class="quiet" aria-label={`Remove ${name}`} onClick={onRemove}>remove them all</button>
      </details>
    </li>
  );
}

export function Objects({ scene, viewer, items, selected, onSelect, brushRadius, onBrush }: {
  scene: AuthorScene;
  viewer: Viewer;
  items: Item[];
  selected: string;
  onSelect: (key: string) => void;
  brushRadius: number | null; // [m]; null: nothing is painted
  onBrush: (radius: number | null) => void;
}) {
  const least = 1.2 * Math.max(0.001, ...(scene.stage?.organSpheres ?? []).map((organ) => organ.radius));
  return (
    <div class="objects">
      {kTitles.map(([kind, title]) => (
        <section key={kind}>
          <h2>{title}</h2>
          <ul>
            {rowsOf(items.filter((item) => item.kind === kind)).map((row) => row.length === 1
              ? <Row key={row[0].key} item={row[0]} selected={selected} onSelect={onSelect} />
              : <Stroke key={row[0].key} balls={row} selected={selected} onSelect={onSelect} onRemove={() => {
                scene.doc!.set(row.map((ball): [JSONPath, undefined] => [ball.path, undefined]).reverse()); // the last of the list first
                onSelect("");
              }} />)}
          </ul>
          {kind !== "organ" && (
            <div class="buttons add">
              {kNew[kind].map(([shape, name]) => (
                <button key={shape} type="button" class="quiet" disabled={!scene.shown || scene.doc?.value === undefined} aria-label={`+ ${name}: ${title}`} onClick={() => onSelect(addItem(scene, viewer, kind, shape))}>+ {name}</button>
              ))}
              {kind === "anchor" && (
                <button type="button" class="quiet" disabled={!scene.shown || scene.doc?.value === undefined} aria-pressed={brushRadius !== null}
                  onClick={() => onBrush(brushRadius === null ? 2.5 * least : null)}>paint</button>
              )}
            </div>
          )}
          {kind === "anchor" && brushRadius !== null && (
            <label class="field brush"><span>brush {mm(brushRadius)} mm: drag, or arrows and Space; Shift erases</span>
              <input type="range" min={least} max={12 * least} step={0.0005} value={brushRadius} onInput={(e) => onBrush(e.currentTarget.valueAsNumber)} />
            </label>
          )}
        </section>
      ))}
    </div>
  );
}
