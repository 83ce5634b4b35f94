import { useEffect, useRef, useState } from "preact/hooks";
import type { AuthorScene, ShownOrgan } from "./author_scene";
import type { Connection } from "./connection";
import { Fit } from "./fit";
import { listOf } from "./items";
import { findJson, parseJson } from "./json_edit";
import { Problems, Readings, Section, ShownCommand, Working } from "./parts";
import type { Preset } from "./protocol";
import { kAnchored } from "./stage_scene";
import { command, millimetres, ofStep } from "./text";
import { Tissue } from "./tissue";

const kMostSpheres = 60000; // that the slider offers, as estimated

interface ScatterRow {
  depth_m: number;
  force_n: number;
  scatter: number;
  most_over_least: number;
}
interface Scatter {
  name: string;
  turns: ScatterRow[];
  places: ScatterRow[];
}

/** Radii of the spheres: how many there are then, what a tick costs, how much the force depends on how they lie. */
export function Filling({ connection, scene, chosen }: { connection: Connection; scene: AuthorScene; chosen: number | null }) {
  const [presets, setPresets] = useState<Preset[]>([]);
  useEffect(() => void connection.call<Preset[]>("scene.presets").then(setPresets, () => {}), [connection]);
  const organs = listOf(scene.doc?.lastValue, "organs").map((organ, i) => ({ organ: i, name: String(organ.name ?? `organ ${i + 1}`), key: `${scene.doc?.path} ${i}`, isRig: !!organ.rig }));
  const filled = organs.filter(({ isRig }) => !isRig).sort((a, b) => Number(b.organ === chosen) - Number(a.organ === chosen)); // the one that is worked on comes first
  return (
    <>
      {filled.map(({ organ, name, key }) => <OrganFilling key={key} connection={connection} scene={scene} organ={organ} name={name} />)}
      {filled.map(({ organ, name, key }) => <Tissue key={key} presets={presets} scene={scene} organ={organ} name={name} />)}
      <Cost scene={scene} />
      <ScatterOf connection={connection} scene={scene} />
    </>
  );
}

function OrganFilling({ connection, scene, organ, name }: { connection: Connection; scene: AuthorScene; organ: number; name: string }) {
  const doc = scene.doc!, path = ["organs", organ, "fill"];
  const number = (key: string, otherwise: number) => {
    const value = findJson(doc.lastValue, [...path, key]);
    return typeof value === "number" ? value : otherwise;
  };
  const radius = number("radius_mm", 4), gap = number("gap_mm", 4);
  const ratio = useRef(gap / radius); // the gap follows the radius
  if (Math.abs(ratio.current - gap / radius) > 0.05 * ratio.current) ratio.current = gap / radius;
  const shown = scene.shown?.organs[organ], spheres = scene.stage?.organSpheres[organ];
  const view = scene.shown?.view;
  const size = view ? 1e3 * Math.min(...view.most.map((most, i) => most - view.least[i])) : 60;
  const now = shown && spheres ? 1e3 * spheres.radius * Math.cbrt(shown.spheres / kMostSpheres) : 1;
  const least = Math.max(0.2, Math.min(radius, now)), most = Math.max(radius, size / 6);
  const steps = 200, toStep = (r: number) => Math.round((steps * Math.log(r / least)) / Math.log(most / least));
  const set = (step: number) => {
    const exact = least * (most / least) ** (step / steps), wanted = Math.round(exact * 20) / 20;
    doc.preview([[[...path, "radius_mm"], wanted], [[...path, "gap_mm"], Math.round(wanted * ratio.current * 100) / 100]]);
  };
  const layers = new Map<number, number>();
  for (const layer of spheres?.layer ?? []) layers.set(layer, (layers.get(layer) ?? 0) + 1);
  const isByTissue = (shown?.tissues.length ?? 0) > 1;
  const kinds = isByTissue ? shown!.tissues : [...layers].sort(([a], [b]) => a - b).map(([layer, count]) => ({ text: `layer ${layer}`, spheres: count, colour: view?.organs[organ]?.layer_colours[layer - 1] }));
  return (
    <Section title={`${name}: its spheres`}>
      <label class="field slider">
        <span>radius <output>{radius} mm</output>, gap {gap} mm</span>
        <input type="range" min={0} max={steps} step={1} value={toStep(radius)} aria-valuetext={`${radius} mm`} onInput={(e) => set(e.currentTarget.valueAsNumber)} onChange={() => doc.commit()} />
        <span class="ends" aria-hidden="true"><span>finer, slower</span><span>coarser, faster</span></span>
      </label>
      <div class="numbers" aria-busy={scene.isRefilling}>
        {shown && <Readings rows={[["spheres", String(shown.spheres)], ["never move", String(shown.anchored)]]} />}
        {shown?.shape_error && <Shape shown={shown} apart={Number((2 * radius + gap).toPrecision(4))} />}
        <ul class={`layers ${isByTissue ? "tissues" : ""}`} aria-label={`Spheres by ${isByTissue ? "tissue" : "layer"}`}>
          {kinds.map(({ text, spheres, colour }) => (
            <li key={text}><i style={{ background: cssOf(colour) }} />{text}<span class="number">{spheres}</span></li>
          ))}
          {shown && shown.anchored > 0 && <li key="anchored"><i style={{ background: kAnchored }} />never moves</li>}
        </ul>
      </div>
      <Fit connection={connection} scene={scene} organ={organ} name={name} radius={radius} />
    </Section>
  );
}

/** How far the spheres follow the organ's shape, and whether that is enough. */
function Shape({ shown, apart }: { shown: ShownOrgan; apart: number }) {
  return (
    <>
      <p class="hint">Shape error, <span class="shape" role="status">{shown.shape_error}</span>.</p>
      {shown.thin_parts ? <p class="warning fine-enough" role="status">Too coarse where the organ is thin: {shown.thin_parts}. Take a smaller radius if these parts are to be touched or cut.</p>
        : <p class="good fine-enough" role="status">Fine enough: the organ is nowhere thinner than two spacings ({Number((2 * apart).toPrecision(4))} mm).</p>}
      <p class="hint">The spheres stand on a lattice, {apart} mm apart, so that some are outside the skin and some end below it. About that much, for 95 %, is usual and no mistake: each weighs and holds as much
        as there is tissue around it, and tools touch the skin itself, which the spheres carry. With a smaller radius they follow the shape more closely, and cost more time.</p>
    </>
  );
}

function cssOf(colour: number[] | undefined): string {
  return colour ? `rgb(${colour.map((c) => Math.round(255 * c)).join(" ")})` : "#888";
}

function Cost({ scene }: { scene: AuthorScene }) {
  const { tickTime: time, shown, isLoading } = scene;
  const share = time ? time.measured_tick_time_s / time.tick_s : 0;
  return (
    <Section title="What it costs">
      <div class="numbers" aria-busy={scene.isRefilling}>
        <Readings rows={[
          ["elements", isLoading ? scene.fillingText : String(shown?.elements ?? "–")],
          ["a step takes", time ? ofStep(time.measured_tick_time_s, time.tick_s) : isLoading ? scene.fillingText : scene.measuringText],
        ]} />
        {time && <p class={share > 0.7 ? "warning" : "hint"} role="status">{share > 1 ? "Slower than real time on this machine." : share > 0.7 ? "Little is left for contact and cuts." : `Measured here and now at rest, median of ${time.ticks} steps.`}</p>}
      </div>
    </Section>
  );
}

/** The scatter is measured on demand: it presses the organ many times. */
function ScatterOf({ connection, scene }: { connection: Connection; scene: AuthorScene }) {
  const [measured, setMeasured] = useState<{ text: string; scatter: Scatter } | null>(null);
  const [progress, setProgress] = useState<[number, number] | null>(null);
  const [error, setError] = useState<Error | null>(null);
  const stop = useRef<AbortController | null>(null);
  const doc = scene.doc!;
  const measure = async (quick: boolean) => {
    const { path, text } = doc;
    setError(null), setProgress([0, 1]);
    stop.current = new AbortController();
    try {
      const scatter = await connection.call<Scatter>("scene.scatter", { path, text, quick },
        { progress: (done, total) => setProgress([done, total]), signal: stop.current.signal });
      setMeasured({ text, scatter });
    } catch (failure) {
      if (!stop.current.signal.aborted) setError(failure as Error);
    }
    setProgress(null);
  };
  const isOld = measured !== null && JSON.stringify(findJson(parseJson(measured.text), ["organs", 0])) !== JSON.stringify(findJson(doc.value, ["organs", 0]));
  return (
    <Section title="Scatter of the force">
      <p class="hint">How much the force of the first ball on the first organ changes when the lattice is turned, or the ball moved by less than a spacing. Tissue has none.</p>
      {progress ? <Working what="pressing" done={progress[0]} total={progress[1]} onCancel={() => stop.current?.abort()} /> : (
        <div class="buttons">
          <button type="button" disabled={!scene.shown} onClick={() => void measure(true)}>Measure, short form</button>
          <button type="button" disabled={!scene.shown} onClick={() => void measure(false)}>In full</button>
        </div>
      )}
      <Problems error={error} />
      {measured && (
        <>
          {isOld && <p class="warning">Of the organ before it was changed.</p>}
          <table class="scatter">
            <thead><tr><th scope="col">depth</th><th scope="col">force</th><th scope="col">turned</th><th scope="col">moved</th></tr></thead>
            <tbody>
              {measured.scatter.turns.map((row, i) => (
                <tr key={i}>
                  <th scope="row">{millimetres(row.depth_m)}</th><td>{row.force_n.toPrecision(3)} N</td>
                  <ScatterCell row={row} /><ScatterCell row={measured.scatter.places[i]} />
                </tr>
              ))}
            </tbody>
          </table>
        </>
      )}
      <ShownCommand text={command("fidelity", doc.path, "-o", "fidelity")} />
    </Section>
  );
}

/** The goal of `ctpm fidelity` is 5 %. */
function ScatterCell({ row }: { row: ScatterRow | undefined }) {
  return row ? <td class={row.scatter > 0.05 ? "worse" : "better"}>{(100 * row.scatter).toFixed(1)} %</td> : <td>–</td>;
}

