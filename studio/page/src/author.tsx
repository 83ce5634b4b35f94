import { useCallback, useEffect, useRef, useState } from "preact/hooks";
import type { Connection } from "./connection";
import { Empty, Problems, Readings, Section, ShownCommand, Working } from "./parts";
import { CallFailed, type Listing, type Problem, problemText, type SceneView, type ToolShapes, type Triangles, type WaitingFrame } from "./protocol";
import { SceneEditor } from "./scene_editor";
import { command, millimetres } from "./text";
import { StageScene, Viewer } from "./viewer";

export const kAuthorStage = 3;
const kMeshes = ".stl,.obj,.ply,.off,.gltf,.glb,.dae,.fbx,.3ds,.3mf,.vtk";

interface ShownScene {
  view: SceneView;
  organs: { spheres: number; report: string }[];
  spheres: number;
  elements: number;
  warnings: Problem[];
}

interface Preset {
  name: string;
  organ: string;
  radius_m: number;
}

interface Imported {
  scene: string;
  script: string;
  report: string;
  spheres: number;
  anchored: number;
  stiffness_scale?: number;
  fit_problem: string;
}

/** Scenes: from a mesh, and as text. */
export function Author({ connection, listing, onTry, onChanged }: {
  connection: Connection;
  listing: Listing;
  onTry: (scene: string) => void;
  onChanged: () => void;
}) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const [viewer, setViewer] = useState<Viewer | null>(null);
  const [path, setPath] = useState("");
  const [shown, setShown] = useState<ShownScene | null>(null);
  const [imported, setImported] = useState<Imported | null>(null);
  const [dropped, setDropped] = useState<File | null>(null);
  const [panel, setPanel] = useState<"scene" | "text">("scene");
  const [isLoading, setLoading] = useState(false);
  const [error, setError] = useState<Error | null>(null);

  useEffect(() => {
    if (!canvas.current) return;
    const made = new Viewer(canvas.current);
    setViewer(made);
    return () => made.dispose();
  }, [connection]);

  const show = useCallback(async (scene: string) => {
    if (!viewer) return;
    setPath(scene), setError(null), setLoading(true), setDropped(null);
    const early: (ToolShapes | Triangles)[] = [];
    let made: StageScene | null = null, late: WaitingFrame | null = null;
    connection.onStage(kAuthorStage, (message) => {
      if (message.kind === "waiting") late = message;
      else early.push(message);
      if (made) use();
    });
    const use = () => {
      for (const message of early.splice(0)) message.kind === "tools" ? made!.setTools(message) : made!.setTriangles(message);
      if (late) made!.wait(late), (late = null);
      viewer.draw();
    };
    try {
      const result = await connection.call<ShownScene>("scene.show", { path: scene, stage: kAuthorStage });
      made = new StageScene(result.view);
      viewer.set(kAuthorStage, made);
      const camera = result.view.cameras[0];
      if (camera) viewer.look(camera);
      use();
      setShown(result);
    } catch (failure) {
      viewer.set(kAuthorStage, null);
      setShown(null);
      setError(failure as Error);
      setPanel("text");
    }
    setLoading(false);
  }, [connection, viewer]);

  const drop = (event: DragEvent) => {
    event.preventDefault();
    const file = event.dataTransfer?.files[0];
    if (file) setDropped(file), setImported(null);
  };

  return (
    <div class="room author" onDragOver={(e) => e.preventDefault()} onDrop={drop}>
      <nav class="list" aria-label="Scenes">
        <h2>Scenes</h2>
        <ul>
          {listing.scenes.map((entry) => (
            <li key={entry.path}>
              <button type="button" aria-current={path === entry.path} disabled={isLoading} onClick={() => {
                setImported(null);
                void show(entry.path);
              }}><span>{entry.path.replace(/\.json$/, "")}</span></button>
            </li>
          ))}
        </ul>
        <label class="pick">
          Import a mesh…
          <input type="file" accept={kMeshes} onChange={(e) => {
            const file = e.currentTarget.files?.[0];
            if (file) setDropped(file), setImported(null);
            e.currentTarget.value = "";
          }} />
        </label>
      </nav>
      <div class="view">
        <canvas ref={canvas} tabIndex={0} aria-label={shown ? `The scene ${shown.view.name} at rest` : "No scene"} />
        {!shown && !isLoading && (
          <Empty title="Drop a mesh of an organ here">
            <p>STL, OBJ, PLY and others. It is checked, repaired and filled with spheres, and becomes a scene that runs. Or choose a scene.</p>
          </Empty>
        )}
        {isLoading && <Empty title={`Loading ${path}`}><p>Its organs are read and filled with spheres.</p></Empty>}
      </div>
      <div class="time" />
      <aside class="side">
        {dropped ? (
          <ImportForm connection={connection} file={dropped} onCancel={() => setDropped(null)} onDone={(result) => {
            setImported(result);
            onChanged();
            void show(result.scene);
          }} />
        ) : path ? (
          <>
            <div class="tabs" role="tablist" aria-label="Panels">
              {(["scene", "text"] as const).map((name) => (
                <button key={name} type="button" role="tab" id={`tab-${name}`} aria-selected={panel === name} aria-controls="panel"
                  onClick={() => setPanel(name)}>{name}</button>
              ))}
            </div>
            <div id="panel" role="tabpanel" aria-labelledby={`tab-${panel}`}>
              {panel === "scene" ? (
                <>
                  {imported && <ImportResult imported={imported} />}
                  {shown && <Shown path={path} shown={shown} onTry={() => onTry(path)} />}
                  <Problems error={error} />
                  <ShownCommand text={command("check", path)} />
                </>
              ) : (
                <SceneEditor key={path} connection={connection} path={path} loadProblems={error instanceof CallFailed ? error.problems : []}
                  onSaved={() => void show(path)} />
              )}
            </div>
          </>
        ) : <p class="hint">A scene is a JSON file with the unit in every key. It opens here with its organs, and its text beside them.</p>}
      </aside>
    </div>
  );
}

function Shown({ path, shown, onTry }: { path: string; shown: ShownScene; onTry: () => void }) {
  return (
    <>
      <Section title={shown.view.name}>
        <Readings rows={[
          ...shown.view.organs.map((organ): [string, string] => [organ.name, `${organ.spheres} spheres in ${organ.layers} layers`]),
          ["elements", String(shown.elements)],
          ["tools", shown.view.tools.map((tool) => tool.name).join(", ") || "none"],
        ]} />
        {shown.warnings.map((warning, i) => <p key={i} class="warning">{problemText(warning)}</p>)}
        <button type="button" class="main" disabled={shown.view.tools.length === 0} onClick={onTry}>Try it</button>
      </Section>
      {shown.organs.filter((organ) => organ.report).map((organ, i) => (
        <Section key={i} title={`${shown.view.organs[i]?.name ?? path}: its mesh`}><pre>{organ.report}</pre></Section>
      ))}
    </>
  );
}

function ImportResult({ imported }: { imported: Imported }) {
  return (
    <Section title="Imported">
      <p class="good" role="status">{imported.scene}: {imported.spheres} spheres, {imported.anchored} of them never move</p>
      <p class="hint">{imported.stiffness_scale !== undefined ? `Stiffness scale ${Number(imported.stiffness_scale.toPrecision(6))}, fitted to the paper's Table 1.`
        : `Stiffness is not fitted: ${imported.fit_problem}`}</p>
    </Section>
  );
}

/** What is needed to make a scene of a mesh, and how far it is. */
function ImportForm({ connection, file, onCancel, onDone }: {
  connection: Connection;
  file: File;
  onCancel: () => void;
  onDone: (imported: Imported) => void;
}) {
  const stem = file.name.replace(/\.[^.]*$/, "").replace(/[^\w-]+/g, "-");
  const [presets, setPresets] = useState<Preset[]>([]);
  const [organ, setOrgan] = useState("");
  const [unit, setUnit] = useState("");
  const [radius, setRadius] = useState("");
  const [scene, setScene] = useState(`${stem}-scene.json`);
  const [progress, setProgress] = useState<[string, number] | null>(null);
  const [error, setError] = useState<Error | null>(null);
  const stop = useRef(new AbortController());
  const uploaded = useRef("");
  useEffect(() => {
    connection.call<Preset[]>("scene.presets").then((known) => {
      setPresets(known);
      setOrgan(known.find((preset) => file.name.toLowerCase().includes(preset.organ))?.name ?? known[0]?.name ?? "");
    }, setError);
  }, [connection, file]);

  const start = async () => {
    setError(null);
    stop.current = new AbortController();
    try {
      if (!uploaded.current) {
        setProgress(["uploading", 0]);
        await connection.upload(file.name, file, (share) => setProgress(["uploading", share]), stop.current.signal);
        uploaded.current = file.name;
      }
      setProgress(["importing", 0]);
      const params = {
        mesh: uploaded.current, scene, organ, unit_m: unit ? Number(unit) : undefined, radius_m: radius ? Number(radius) / 1e3 : undefined,
      };
      onDone(await connection.call<Imported>("scene.import", params,
        { progress: (done, total) => setProgress(["importing", done / total]) }));
    } catch (failure) {
      setError(failure as Error);
    }
    setProgress(null);
  };
  const usual = presets.find((preset) => preset.name === organ)?.radius_m;
  const units: Record<string, string> = { "0.001": "mm", "0.01": "cm", "1": "m", "0.0254": "in" };
  return (
    <Section title="Import a mesh">
      <Readings rows={[["file", file.name], ["size", `${(file.size / 1e6).toFixed(2)} MB`]]} />
      <label class="field"><span>tissue</span>
        <select value={organ} onChange={(e) => setOrgan(e.currentTarget.value)}>{presets.map((p) => <option key={p.name}>{p.name}</option>)}</select>
      </label>
      <label class="field"><span>unit of the file</span>
        <select value={unit} onChange={(e) => setUnit(e.currentTarget.value)}>
          <option value="">guessed</option>
          {Object.entries(units).map(([metres, name]) => <option key={metres} value={metres}>{name}</option>)}
        </select>
      </label>
      <label class="field"><span>radius of the spheres [mm]{usual !== undefined && `, ${millimetres(usual)} if empty`}</span>
        <input type="number" min="0.1" step="0.1" value={radius} onInput={(e) => setRadius(e.currentTarget.value)} />
      </label>
      <label class="field"><span>scene to write</span>
        <input value={scene} onInput={(e) => setScene(e.currentTarget.value)} />
      </label>
      {progress ? <Working what={progress[0]} done={progress[1]} total={1} onCancel={progress[0] === "uploading" ? () => stop.current.abort() : undefined} />
        : (
          <div class="buttons">
            <button type="button" class="main" onClick={() => void start()}>Import</button>
            <button type="button" onClick={onCancel}>Cancel</button>
          </div>
        )}
      <Problems error={error} />
      <ShownCommand text={command("import", file.name, "--organ", organ, ...(unit ? ["--unit", units[unit]] : []),
        ...(radius ? ["--radius-mm", radius] : []), "-o", scene)} />
    </Section>
  );
}
