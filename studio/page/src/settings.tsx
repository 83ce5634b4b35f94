// How a scene and its organs behave, as far as it is chosen without their text.
import type { JSONPath } from "jsonc-parser";
import { useRef } from "preact/hooks";
import type { AuthorScene } from "./author_scene";
import { NumberField } from "./fields";
import { listOf } from "./items";
import type { Json } from "./json_edit";
import { Section } from "./parts";

const kFreeFall = 9.81; // [m/s^2]
const kWays = ["-z", "+z", "-y", "+y", "-x", "+x"];
const kNowhere = "nowhere", kOther = "other";

function vectorAt(scene: AuthorScene, path: JSONPath): number[] {
  const value = scene.settingAt(path);
  return Array.isArray(value) && value.length === 3 && value.every((x) => typeof x === "number") ? (value as number[]) : [0, 0, 0];
}

/** Which way down is: along an axis, nowhere, or another way that the text says. */
function downOf(gravity: number[]): string {
  const along = gravity.flatMap((x, i) => (x === 0 ? [] : [`${x < 0 ? "-" : "+"}${"xyz"[i]}`]));
  return along.length === 0 ? kNowhere : along.length === 1 ? along[0] : kOther;
}

/** As strong as before, but another way. */
function gravityAlong(down: string, before: number[]): number[] {
  const strength = Math.hypot(...before) || kFreeFall;
  return ["x", "y", "z"].map((axis) => (down.endsWith(axis) ? (down.startsWith("-") ? -strength : strength) : 0));
}

/** A switch that the text holds. */
function SwitchAt({ scene, path, off = false, on = true, label }: { scene: AuthorScene; path: JSONPath; off?: Json; on?: Json; label: string }) {
  const isOn = scene.settingAt(path) === on;
  return (
    <label class="tick">
      <input type="checkbox" checked={isOn} onChange={() => scene.doc!.set([[path, isOn ? off : on]])} />
      <span>{label}</span>
    </label>
  );
}

/** A number that the text holds. */
function NumberAt({ scene, path, label, unit, step }: { scene: AuthorScene; path: JSONPath; label: string; unit: string; step: number }) {
  const value = scene.settingAt(path);
  return <NumberField label={label} hasOwnUnit unit={unit} step={step} least={0} value={typeof value === "number" ? value : 0}
    onInput={(number) => scene.preview([[path, number]])} onDone={() => scene.doc!.commit()} />;
}

/** Of the whole scene: where down is, the hands, and what touches what. */
export function Behaviour({ scene }: { scene: AuthorScene }) {
  const path = ["gravity_m_per_s2"], gravity = vectorAt(scene, path), down = downOf(gravity);
  return (
    <Section title="How it behaves">
      <label class="field"><span>down is</span>
        <select value={down} onChange={(e) => scene.doc!.set([[path, gravityAlong(e.currentTarget.value, gravity)]])}>
          {down === kOther && <option value={kOther}>as the text says</option>}
          {kWays.map((way) => <option key={way}>{way}</option>)}
          <option value={kNowhere}>nowhere: no gravity</option>
        </select>
      </label>
      <SwitchAt scene={scene} path={["hands"]} off={1} on={2} label="two hands hold a tool each" />
      {listOf(scene.doc!.lastValue, "organs").length > 1 && <SwitchAt scene={scene} path={["organs_meet"]} label="organs touch each other; otherwise they pass through each other" />}
      <SwitchAt scene={scene} path={["lips_meet"]} label="the two sides of a cut touch each other; otherwise they pass through each other" />
      <NumberAt scene={scene} path={["contact_friction"]} label="coefficient of friction" unit="" step={0.05} />
      <p class="hint">What touches costs time where it is near: where organs lie on each other, a step may take several times as long.</p>
    </Section>
  );
}

/** Red, green and blue from 0 to 1, as a browser writes a colour, and back. */
function hexOf(colour: number[]): string {
  return `#${colour.map((x) => Math.round(255 * Math.min(1, Math.max(0, x))).toString(16).padStart(2, "0")).join("")}`;
}
function colourOf(hex: string): number[] {
  return [1, 3, 5].map((at) => Number((parseInt(hex.slice(at, at + 2), 16) / 255).toFixed(3)));
}

/** A colour that the text holds. */
function ColourAt({ scene, path, label }: { scene: AuthorScene; path: JSONPath; label: string }) {
  const colour = hexOf(vectorAt(scene, path)), chosen = useRef(colour);
  return (
    <label class="tick">
      <input type="color" value={colour} onInput={(e) => (chosen.current = e.currentTarget.value)}
        onChange={() => chosen.current !== colour && scene.doc!.set([[path, colourOf(chosen.current)]])} />
      <span>{label}</span>
    </label>
  );
}

/** Of an organ: from what it counts as harmed, whether it touches itself, and its colours. */
export function OrganBehaviour({ scene, organ }: { scene: AuthorScene; organ: number }) {
  const at = (key: string): JSONPath => ["organs", organ, key];
  return (
    <>
      <NumberAt scene={scene} path={at("damage_force_n")} label="harmed by a force above" unit="N" step={0.5} />
      <NumberAt scene={scene} path={at("damage_depth_mm")} label="harmed by a press deeper than" unit="mm" step={1} />
      <p class="hint">0 is no limit. Who trains is told where one is passed, and comparisons count it.</p>
      <SwitchAt scene={scene} path={at("meets_itself")} label="its parts and its pieces touch each other" />
      <ColourAt scene={scene} path={at("surface_color")} label="colour outside" />
      <ColourAt scene={scene} path={at("inner_color")} label="colour inside, where it is cut" />
    </>
  );
}
