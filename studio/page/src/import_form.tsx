import type { JSONPath } from "jsonc-parser";
import { useEffect, useRef, useState } from "preact/hooks";
import * as three from "three";
import type { AuthorScene, Finding } from "./author_scene";
import { takenAlong } from "./belongings";
import type { Connection } from "./connection";
import { NumberInput } from "./fields";
import { freeName, listOf, mmVector } from "./items";
import { type Json, parseJson } from "./json_edit";
import { Problems, Readings, Section, ShownCommand, Working } from "./parts";
import { CallFailed, type CameraView, type Preset, type Vector } from "./protocol";
import { command, whyNot } from "./text";
import { seesBox } from "./viewer";

export interface Imported {
  scene: string;
  script: string;
  report: string;
  unit: string;
  spheres: number;
  anchored: number;
  stiffness_scale?: number;
  fit_problem: string;
  findings: Finding[];
  least: Vector;
  most: Vector;
}

const kUnits: Record<string, string> = { "0.001": "mm", "0.01": "cm", "0.1": "dm", "1": "m", "0.0254": "in" };
const kGap = 0.1; // between an organ that is added and the others, of its size, as the command leaves it
const kMostNames = 100; // of an upload that are tried
const kImportsCamera = "front"; // as an import names the camera that it places
const kMaps = /\.(nii|nii\.gz|nrrd)$/i; // segmentations, of which each label is an organ
const kGeneric = "soft-tissue"; // what an organ of no name is taken as

/** What was found in a mesh, what was done about it, and what remains. */
export function Findings({ findings }: { findings: Finding[] }) {
  if (findings.length === 0) return <p class="good">Nothing had to be repaired.</p>;
  return (
    <ul class="findings" aria-label="Repairs">
      {findings.map((finding, i) => (
        <li key={i}>
          <span>{finding.found}</span>
          {finding.done && finding.done !== "none" && <span class="good">{finding.done}</span>}
          {finding.remains && <span class="warning">{finding.remains}</span>}
        </li>
      ))}
    </ul>
  );
}

export function ImportResult({ imported }: { imported: Imported }) {
  return (
    <Section title="Imported">
      <p class="good" role="status">{imported.scene}: {imported.spheres} spheres, {imported.anchored} of them never move</p>
      <p class="hint">{imported.stiffness_scale !== undefined ? `Stiffness scale ${Number(imported.stiffness_scale.toPrecision(6))}, fitted to the paper's Table 1.`
        : `Stiffness is not fitted: ${imported.fit_problem}`}</p>
      <Findings findings={imported.findings} />
    </Section>
  );
}

/** The smallest limit with which holes that were refused are closed [mm]; null: something else was wrong. */
function holesOf(error: Error | null): number | null {
  const found = error instanceof CallFailed ? error.problems.map(({ hint }) => Number(/largest_hole_mm (\d+)/.exec(hint)?.[1] ?? 0)) : [];
  return Math.max(0, ...found) || null;
}

/** Uploads a file under its name, or with a number where one of that name lies in the folder, maybe itself. */
async function uploadAnew(connection: Connection, file: File, progress: (share: number) => void, signal: AbortSignal): Promise<string> {
  const [, stem, ending] = /^(.*?)((?:\.nii)?\.[^.]*|)$/i.exec(file.name)!;
  for (let i = 1, name = file.name; ; name = `${stem}-${++i}${ending}`)
    try {
      await connection.upload(name, file, progress, signal);
      return name;
    } catch (failure) {
      if (!(failure instanceof CallFailed && failure.isTaken) || i >= kMostNames) throw failure;
    }
}

/** The first camera of a scene, moved away until it sees a larger box as it saw the one before; null: it sees it already. */
function movedCamera(camera: CameraView | undefined, before: [Vector, Vector], now: [Vector, Vector]): CameraView | null {
  if (!camera || seesBox(camera, ...now)) return null;
  const boxes = [before, now].map(([least, most]) => new three.Box3(new three.Vector3(...least), new three.Vector3(...most)));
  const [middle, newMiddle] = boxes.map((box) => box.getCenter(new three.Vector3()));
  const [size, newSize] = boxes.map((box) => box.getSize(new three.Vector3()).length());
  const moved = (place: Vector) => new three.Vector3(...place).sub(middle).multiplyScalar(newSize / size).add(newMiddle).toArray() as Vector;
  return { ...camera, eye: moved(camera.eye), target: moved(camera.target) };
}

/** Adds the organs of a scene that was imported to the one that is open, beside its organs, and moves the camera that an
    import left there until it sees all of them: one step of its history. */
async function addOrgans(connection: Connection, open: AuthorScene, imported: Imported): Promise<void> {
  const { text } = await connection.call<{ text: string }>("scene.read", { path: imported.scene });
  const added = listOf(parseJson(text), "organs");
  const doc = open.doc!, organs = listOf(doc.value, "organs"), view = open.shown?.view;
  const size = new three.Vector3(...imported.most).distanceTo(new three.Vector3(...imported.least));
  const at = view ? new three.Vector3(view.most[0] + kGap * size - imported.least[0], (view.least[1] + view.most[1] - imported.least[1] - imported.most[1]) / 2, view.least[2] - imported.least[2])
    : new three.Vector3();
  const values: [JSONPath, Json][] = [], known = [...organs];
  for (const { name, mesh, at_mm: _, ...rest } of added) {
    const organ = { name: freeName(known, String(name)), mesh, at_mm: mmVector(at), ...rest };
    const alone = { ...organ, at_mm: [0, 0, 0] };
    values.push([["organs", known.length], organ]);
    for (const [[, , ...key], field] of takenAlong([[["organs", 0, "at_mm"], mmVector(at)]], { organs: [alone] }, [], [])) values.push([["organs", known.length, ...key], field!]);
    known.push(organ);
  }
  const cameras = listOf(doc.value, "cameras");
  if (view && cameras[0]?.name === kImportsCamera) {
    const box = new three.Box3(new three.Vector3(...imported.least), new three.Vector3(...imported.most)).translate(at);
    const all = box.clone().expandByPoint(new three.Vector3(...view.least)).expandByPoint(new three.Vector3(...view.most));
    const camera = movedCamera(view.cameras[0], [view.least, view.most], [all.min.toArray() as Vector, all.max.toArray() as Vector]);
    for (const [key, place] of camera ? [["eye_mm", camera.eye], ["target_mm", camera.target]] as const : [])
      values.push([["cameras", 0, key], mmVector(new three.Vector3(...place))]);
  }
  doc.set(values);
}

/** What is needed to make a scene of a mesh, and how far it is. */
export function ImportForm({ connection, file, leftOut, open, onCancel, onDone }: {
  connection: Connection;
  file: File;
  leftOut: string[]; // files that came with it
  open: AuthorScene | null; // a scene to which the organ can be added
  onCancel: () => void;
  onDone: (imported: Imported, isAdded: boolean) => void;
}) {
  const isMap = kMaps.test(file.name);
  const stem = file.name.replace(/\.(nii\.gz|[^.]*)$/i, "").replace(/[^\w-]+/g, "-");
  const folder = open?.doc?.path.replace(/[^/]*$/, "") ?? "";
  const [presets, setPresets] = useState<Preset[]>([]);
  const [organ, setOrgan] = useState("");
  const [unit, setUnit] = useState("");
  const [radius, setRadius] = useState("");
  const [labels, setLabels] = useState("");
  const [hole, setHole] = useState("");
  const [chosenScene, setScene] = useState<string | null>(null), [freeScene, setFreeScene] = useState("");
  const scene = chosenScene ?? freeScene;
  const [isAdded, setAdded] = useState(false);
  const [progress, setProgress] = useState<[string, number] | null>(null);
  const [error, setError] = useState<Error | null>(null), [isStopped, setStopped] = useState(false);
  const stop = useRef(new AbortController());
  const uploaded = useRef(""); // for as many tries as its author makes
  const takeBack = async () => {
    const name = uploaded.current;
    uploaded.current = "";
    if (name) await connection.removeUpload(name).catch(() => {}); // somebody has changed it: it is theirs now
  };
  useEffect(() => {
    connection.call<Preset[]>("scene.presets").then((known) => {
      setPresets(known);
      setOrgan(known.find((preset) => file.name.toLowerCase().includes(preset.organ))?.name ?? kGeneric);
    }, setError);
    return () => {
      stop.current.abort();
      void takeBack();
    };
  }, [connection, file]);

  // Its mesh and its script need names too, of which the page knows nothing.
  useEffect(() => {
    let isWanted = true;
    connection.call<{ path: string }>("scene.import_name", { path: (isAdded ? folder : "") + (/\.obj$/i.test(file.name) ? `${stem}-scene.json` : `${stem}.json`) })
      .then(({ path }) => isWanted && setFreeScene(path.slice(isAdded ? folder.length : 0)), setError);
    return () => void (isWanted = false);
  }, [connection, file, isAdded]);

  const tissue = presets.find((preset) => preset.name === organ);
  const target = isAdded ? folder + scene : scene, names = isMap ? labels.split(",").map((name) => name.trim()).filter(Boolean) : [], refused = holesOf(error);
  const wrong = [whyNot("The radius", radius, 0.01, 100, "mm"), whyNot("The largest hole", hole, 0, 1e4, "mm")].filter(Boolean);
  const start = async (closed = hole) => {
    setError(null), setStopped(false), setHole(closed);
    const { signal } = (stop.current = new AbortController());
    try {
      if (!uploaded.current) {
        setProgress(["uploading", 0]);
        uploaded.current = await uploadAnew(connection, file, (share) => setProgress(["uploading", share]), signal);
      }
      setProgress(["importing", 0]);
      const params = {
        mesh: uploaded.current, scene: target, organ, unit_m: unit ? Number(unit) : undefined, radius_m: radius ? Number(radius) / 1e3 : undefined,
        names: names.length ? names : undefined, largest_hole_m: closed ? Number(closed) / 1e3 : undefined,
      };
      const imported = await connection.call<Imported>("scene.import", params,
        { progress: (done, total) => setProgress([done < total ? "importing" : "fitting the stiffness", done / total]), signal });
      uploaded.current = ""; // the program has removed it: the scene has its own mesh
      if (isAdded && open) await addOrgans(connection, open, imported);
      onDone(imported, isAdded);
      return;
    } catch (failure) {
      if (signal.aborted) setStopped(true);
      else setError(failure as Error);
    }
    setProgress(null);
  };
  return (
    <Section title="Import a mesh">
      <Readings rows={[["file", file.name], ["size", `${(file.size / 1e6).toFixed(2)} MB`]]} />
      {leftOut.length > 0 && (
        <p class="warning" role="status">One file is imported at a time: {leftOut.join(", ")} {leftOut.length === 1 ? "was" : "were"} left out. Drop {leftOut.length === 1 ? "it" : "the next"} when this one is there.</p>
      )}
      {open?.doc && (
        <fieldset class="choice">
          <legend>becomes</legend>
          <label><input type="radio" name="into" checked={!isAdded} onChange={() => setAdded(false)} /> a scene of its own</label>
          <label><input type="radio" name="into" checked={isAdded} onChange={() => setAdded(true)} /> an organ of {open.doc.path} too</label>
        </fieldset>
      )}
      <label class="field"><span>tissue</span>
        <select value={organ} aria-describedby="tissue-source" onChange={(e) => setOrgan(e.currentTarget.value)}>{presets.map((p) => <option key={p.name} title={p.source}>{p.name}</option>)}</select>
      </label>
      <p class="hint source" id="tissue-source">How stiff, damped, heavy and tough it is.{tissue && ` Its values: ${tissue.source}.`}</p>
      {isMap && (
        <label class="field"><span>labels to take, with commas between; empty: the only one</span>
          <input value={labels} onInput={(e) => setLabels(e.currentTarget.value)} />
        </label>
      )}
      <label class="field"><span>unit of the file</span>
        <select value={unit} onChange={(e) => setUnit(e.currentTarget.value)}>
          <option value="">guessed</option>
          {Object.entries(kUnits).map(([metres, name]) => <option key={metres} value={metres}>{name}</option>)}
        </select>
      </label>
      <label class="field"><span>radius of the spheres [mm]; empty: as fine as holds 1 kHz here</span>
        <NumberInput step="0.1" value={radius} onInput={(e) => setRadius(e.currentTarget.value)} />
      </label>
      <label class="field"><span>largest hole that is closed [mm]; empty: a tenth of its size</span>
        <NumberInput step="1" value={hole} onInput={(e) => setHole(e.currentTarget.value)} />
      </label>
      <label class="field"><span>scene to write</span>
        <input value={scene} onInput={(e) => setScene(e.currentTarget.value)} />
      </label>
      {progress ? <Working what={progress[0]} done={progress[1]} total={1} onCancel={() => stop.current.abort()} />
        : (
          <div class="buttons">
            <button type="button" class="main" disabled={!organ || !scene || wrong.length > 0} onClick={() => void start()}>Import</button>
            <button type="button" onClick={onCancel}>Back</button>
          </div>
        )}
      {wrong.map((why) => <p key={why} class="warning" role="status">{why}.</p>)}
      {isStopped && <p class="hint" role="status">Stopped; nothing was written.</p>}
      <Problems error={error} />
      {refused !== null && !progress && (
        <button type="button" class="main" onClick={() => void start(String(refused))}>Close holes up to {refused} mm and import</button>
      )}
      {isAdded && <p class="hint">The command writes the organ into the file at once. Here it is added to the text, which you save, and {target} stays a scene of its own.</p>}
      <ShownCommand text={command("import", file.name, ...names.flatMap((name) => ["--label", name]), ...(organ ? ["--organ", organ] : []), ...(unit ? ["--unit", kUnits[unit]] : []),
        ...(radius ? ["--radius-mm", radius] : []), ...(hole ? ["--largest-hole-mm", hole] : []), ...(isAdded && open?.doc ? ["--into", open.doc.path, "--beside"] : ["-o", target]))} />
    </Section>
  );
}
