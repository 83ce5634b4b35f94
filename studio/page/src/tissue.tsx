// What an organ is made of: its tissue, and that of its layers from the skin inwards.
import type { JSONPath } from "jsonc-parser";
import * as three from "three";
import type { AuthorScene } from "./author_scene";
import { NumberField } from "./fields";
import { type Fields, isFields, listOf } from "./items";
import type { Json } from "./json_edit";
import { Section } from "./parts";
import type { Preset } from "./protocol";

const kOwn = ""; // a material of its author's own values

const materialOf = (fields: Fields): Fields => (isFields(fields.material) ? fields.material : {});
const presetOf = (fields: Fields): string => String(materialOf(fields).preset ?? kOwn);

/** A material of that preset: what was fitted or set for another one is not its own, but how tense it lies in the body is. */
function materialAs(preset: string, before: Fields): Json {
  return { preset, ...(before.prestrain === undefined ? {} : { prestrain: before.prestrain }) };
}

/** `organ`: its place in the list. `presets`: those that a scene can name. */
export function Tissue({ presets, scene, organ, name }: { presets: Preset[]; scene: AuthorScene; organ: number; name: string }) {
  const doc = scene.doc!, path: JSONPath = ["organs", organ], fields = listOf(doc.lastValue, "organs")[organ] ?? {}, layers = listOf(fields, "layers");
  const choice = (label: string, of: Fields, at: JSONPath) => (
    <label class="field"><span>{label}</span>
      <select value={presetOf(of)} onChange={(e) => doc.set([[[...at, "material"], materialAs(e.currentTarget.value, materialOf(of))]])}>
        {presetOf(of) === kOwn && <option value={kOwn}>own values</option>}
        {presets.map((preset) => <option key={preset.name} title={preset.source}>{preset.name}</option>)}
      </select>
    </label>
  );
  /** How tense it lies in the body, where that is said: an import holds a capsule against what is below it. */
  const strain = (of: Fields, at: JSONPath) => {
    const { prestrain } = materialOf(of);
    return typeof prestrain === "number" && (
      <NumberField label="in-situ strain" hasOwnUnit unit="%" step={0.1} least={-20} value={Number((100 * prestrain).toPrecision(6))} onDone={() => doc.commit()}
        onInput={(percent) => doc.preview([[[...at, "material", "prestrain"], Number((percent / 100).toPrecision(6))]])} />
    );
  };
  const depthOf = (layer: Fields | undefined) => (typeof layer?.to_depth_mm === "number" ? layer.to_depth_mm : 0);
  /** A new layer is of the same tissue as what it lies in, until another one is chosen. */
  const add = () => {
    const box = new three.Box3().setFromArray(scene.stage?.organSpheres[organ]?.centre ?? []);
    const middle = box.isEmpty() ? 0 : 500 * Math.min(...box.getSize(new three.Vector3())); // how deep it lies, about [mm]
    const last = depthOf(layers.at(-1)), deeper = Number((middle > last ? (last + middle) / 2 : last + 1).toPrecision(3));
    const { fitted_for: _, ...material } = materialOf(layers.at(-1) ?? fields);
    doc.set([[[...path, "layers", layers.length], { to_depth_mm: deeper, material }]]);
  };
  const source = presets.find((preset) => preset.name === presetOf(fields))?.source;
  return (
    <Section title={`${name}: its tissue`}>
      {choice(layers.length > 0 ? "below its layers" : "tissue", fields, path)}
      {source && <p class="hint source">Its values: {source}.</p>}
      {strain(fields, path)}
      {layers.map((layer, i) => (
        <fieldset key={i} class="layer">
          <legend>layer of tissue {i + 1}, from {depthOf(layers[i - 1])} mm
            <button type="button" class="quiet remove" aria-label={`Remove layer of tissue ${i + 1}`} onClick={() => doc.set([[layers.length > 1 ? [...path, "layers", i] : [...path, "layers"], undefined]])}>remove</button>
          </legend>
          <NumberField label="down to" hasOwnUnit unit="mm" step={0.5} least={0.01} value={depthOf(layer)} onDone={() => doc.commit()}
            onInput={(depth) => doc.preview([[[...path, "layers", i, "to_depth_mm"], depth]])} />
          {choice("tissue", layer, [...path, "layers", i])}
          {strain(layer, [...path, "layers", i])}
        </fieldset>
      ))}
      <div class="buttons add"><button type="button" class="quiet" disabled={doc.value === undefined} onClick={add}>+ layer of tissue</button></div>
      <p class="hint">A sphere belongs to the first layer that ends below its centre: one that is thinner than the spheres lie apart may have none.</p>
    </Section>
  );
}
