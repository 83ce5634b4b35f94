import * as three from "three";
import type { AuthorScene } from "./author_scene";
import { NumberField, VectorField } from "./fields";
import { kFineNudge, kNudge, type Values } from "./gizmos";
import { type Item, mm, mmVector } from "./items";
import { findJson, type Json } from "./json_edit";
import { Section } from "./parts";
import { OrganBehaviour } from "./settings";
import type { Viewer } from "./viewer";

const kTurning = "In the picture a drag turns the view, and the wheel zooms.";

const kWhatItDoes: Partial<Record<Item["kind"], string>> = {
  obstacle: "Tissue touches it and does not enter it; tools pass through it.",
  zone: "Where no tool should be: comparisons count a ball or a blade's edge that reaches into it. Nothing that is simulated depends on it.",
};

/** What the selected thing is, in numbers. */
export function Inspector({ scene, item, viewer, onRemove }: { scene: AuthorScene; item: Item | null; viewer: Viewer; onRemove: ((item: Item) => void) | null }) {
  const { doc } = scene;
  if (!doc || !item) {
    return <p class="hint">Choose something in the list or in the picture. It can be dragged over the surface, moved by its arrows, or given numbers here. {kTurning}</p>;
  }
  const preview = (values: Values) => scene.preview(values), done = () => doc.commit();
  const at = (...more: (string | number)[]) => [...item.path, ...more];
  const read = (...more: (string | number)[]): Json | undefined => findJson(doc.lastValue, at(...more));
  const vector = (label: string, key: (string | number)[], otherwise: number[], unit = "mm", step = 0.5, least?: number) => {
    const value = read(...key);
    return (
      <VectorField label={label} unit={unit} step={step} least={least} onDone={done} onInput={(numbers) => preview([[at(...key), numbers]])}
        value={Array.isArray(value) && value.length === 3 ? (value as number[]) : otherwise} />
    );
  };
  const number = (label: string, key: (string | number)[], otherwise: number, unit = "mm", step = 0.5, least = 0.01) => {
    const value = read(...key);
    return <NumberField label={label} hasOwnUnit unit={unit} step={step} least={least} value={typeof value === "number" ? value : otherwise}
      onInput={(n) => preview([[at(...key), n]])} onDone={done} />;
  };
  const place = item.place ? mmVector(item.place) : [0, 0, 0];
  return (
    <Section title={`${item.kind}: ${item.name}`} aside={onRemove && (
      <button type="button" class="quiet remove" onClick={() => onRemove(item)}>remove</button>
    )}>
      <p class="hint">{kTurning}{item.place && ` Where its handle has the focus, arrow keys move it by ${mm(kNudge)} mm, with Shift by ${mm(kFineNudge)} mm.`}</p>
      {item.kind !== "anchor" && (
        <label class="field"><span>name</span>
          <input value={item.name} onInput={(e) => e.currentTarget.value && preview([[at("name"), e.currentTarget.value]])} onChange={done}
            onBlur={(e) => (e.currentTarget.value = item.name)} />
        </label>
      )}
      {kWhatItDoes[item.kind] && <p class="hint">{kWhatItDoes[item.kind]}</p>}
      {item.shape === "mesh" && <p class="hint">It stands where its mesh file says, which the text names.</p>}
      {item.kind === "organ" && (
        <>
          {vector("place of the mesh's origin", ["at_mm"], [0, 0, 0])}
          {vector("turned about x, then y, then z", ["turn_deg"], [0, 0, 0], "degrees", 5)}
          {number("scale of the mesh", ["scale"], 1, "times", 0.05, 0.001)}
          <OrganBehaviour scene={scene} organ={Number(item.path[1])} />
        </>
      )}
      {(item.shape === "ball" || item.shape === "scalpel") && (
        <>
          {vector(item.isWritten ? "taken up at" : "taken up at (not written: above the organs)", ["at_mm"], place)}
          {item.path.at(-1) !== 0 && <p class="hint">A training begins with the first tool. This one is taken up where the hand is then.</p>}
          {item.isWritten && vector("pointing", ["pointing"], [0, 0, -1], "direction", 0.1)}
          {item.isWritten && item.shape === "scalpel" && vector("facing, along the blade", ["facing"], new three.Vector3(1, 0, 0).applyQuaternion(item.turn).toArray().map((x) => Math.round(1e3 * x) / 1e3 + 0), "direction", 0.1)}
          {item.shape === "ball" ? number("radius", ["radius_mm"], mm(item.size.x)) : number("length of the blade", ["blade_length_mm"], 40, "mm", 1)}
        </>
      )}
      {item.shape === "pin" && vector("holds the sphere nearest to", ["holds_mm"], place)}
      {item.shape === "probe" && vector("follows the sphere nearest to", ["at_mm"], place)}
      {item.shape === "sphere" && <>{vector("centre", ["sphere", "centre_mm"], place)}{number("radius", ["sphere", "radius_mm"], mm(item.size.x))}</>}
      {item.shape === "box" && <>{vector("smallest corner", ["box", "min_mm"], place)}{vector("largest corner", ["box", "max_mm"], place)}</>}
      {item.shape === "plane" && <>{vector("a point of it", ["plane", "point_mm"], place)}{vector("normal to the free side", ["plane", "normal"], [0, 0, 1], "direction", 0.1)}</>}
      {item.shape === "lowest" && number("height above the lowest point", ["lowest_mm"], 0, "mm", 0.5, 0)}
      {item.kind === "camera" && (
        <>
          <div class="buttons">
            <button type="button" class="main" onClick={() => doc.set(cameraValues(item.path, viewer))}>Use this view</button>
            <button type="button" onClick={() => lookThrough(item, doc.value, viewer)}>Look through it</button>
          </div>
          {vector("eye", ["eye_mm"], place)}
          {vector("looks at", ["target_mm"], [0, 0, 0])}
          {number("field of view", ["field_of_view_deg"], 35, "degrees", 1, 1)}
        </>
      )}
      {item.kind === "anchor" && <Anchored scene={scene} organ={Number(item.path[1])} />}
    </Section>
  );
}

function Anchored({ scene, organ }: { scene: AuthorScene; organ: number }) {
  const shown = scene.shown?.organs[organ];
  return shown ? <p class="hint numbers" role="status" aria-busy={scene.isRefilling}>{shown.anchored} of {shown.spheres} spheres of this organ never move.</p> : null;
}

/** The camera of the picture as a camera of the scene. */
export function cameraValues(path: Item["path"], viewer: Viewer): Values {
  const up = viewer.camera.up.toArray().map((x) => Math.round(x * 1e4) / 1e4 + 0);
  return [
    [[...path, "eye_mm"], mmVector(viewer.camera.position)], [[...path, "target_mm"], mmVector(viewer.controls.target)],
    [[...path, "up"], up], [[...path, "field_of_view_deg"], Math.round(10 * viewer.fieldOfView) / 10],
  ];
}

function lookThrough(item: Item, scene: Json | undefined, viewer: Viewer): void {
  const numbers = (key: string, otherwise: number[]) => (findJson(scene, [...item.path, key]) as number[] | undefined) ?? otherwise;
  const metres = (key: string) => numbers(key, [0, 0, 0]).map((x) => x * 1e-3) as [number, number, number];
  viewer.look({
    name: item.name, eye: metres("eye_mm"), target: metres("target_mm"), up: numbers("up", [0, 0, 1]) as [number, number, number],
    fov_deg: (findJson(scene, [...item.path, "field_of_view_deg"]) as number | undefined) ?? 35,
  });
}
