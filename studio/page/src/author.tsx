import { redo, undo } from "@codemirror/commands";
import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";
import { AuthorScene } from "./author_scene";
import { Brush } from "./brush";
import type { Connection } from "./connection";
import type { SceneDocument } from "./document";
import { Filling } from "./filling";
import { type GizmoMode, Gizmos, modesOf } from "./gizmos";
import { type Imported, Findings, ImportForm, ImportResult } from "./import_form";
import { Inspector } from "./inspector";
import { type Item, listOf, saidOf } from "./items";
import { findJson } from "./json_edit";
import { Objects } from "./objects";
import { Empty, Problems, Readings, Section, ShownCommand } from "./parts";
import type { CameraView, Listing } from "./protocol";
import { SceneEditor } from "./scene_editor";
import { SceneList } from "./scene_list";
import { Behaviour } from "./settings";
import type { Shown } from "./stage_scene";
import { command, freePath, isFileName, ofStep, verdictOf } from "./text";
import { kTurns, Viewer } from "./viewer";

const kLookOnDisk = 2000; // [ms]
const kPainting = "Painting anchors: arrow keys move the brush, Space paints, Shift and Space erase, Escape ends it";
const kPaintingByHand = "A drag paints, with Shift it erases; A, D, W, S, + and - turn the view.";
type Panel = "place" | "filling" | "scene";

/** What the room works with, made when its canvas is there. */
interface Desk {
  viewer: Viewer;
  scene: AuthorScene;
  gizmos: Gizmos;
  brush: Brush;
}

/** A scene keeps one organ. */
function canRemove(item: Item | null, items: Item[]): boolean {
  return item?.kind !== "organ" || items.filter(({ kind }) => kind === "organ").length > 1;
}

/** The organ that an item is, or belongs to. */
function organOf(item: Item | null): number | null {
  return item?.path[0] === "organs" ? Number(item.path[1]) : null;
}

/** Scenes: from a mesh, in the picture, and as text. */
export function Author({ connection, listing, onTry, onChanged }: {
  connection: Connection;
  listing: Listing;
  onTry: (scene: string, text: string, seen: CameraView) => void;
  onChanged: () => void;
}) {
  const canvas = useRef<HTMLCanvasElement>(null), overlay = useRef<HTMLDivElement>(null);
  const [desk, setDesk] = useState<Desk | null>(null);
  const [, setVersion] = useState(0);
  const [imported, setImported] = useState<Imported | null>(null);
  const [dropped, setDropped] = useState<File | null>(null), [leftOut, setLeftOut] = useState<string[]>([]);
  const [isOver, setOver] = useState(false); // a file that is dragged
  const [endings, setEndings] = useState<string[]>([]); // of the files that an import reads
  const [panel, setPanel] = useState<Panel>("place");
  const [selected, setSelected] = useState("");
  const [mode, setMode] = useState<GizmoMode>("move");
  const [brushRadius, setBrushRadius] = useState<number | null>(null);
  const [brushSays, setBrushSays] = useState(""); // why the brush did nothing
  const [error, setError] = useState<Error | null>(null);
  const scene = desk?.scene ?? null, doc = scene?.doc ?? null;

  useEffect(() => {
    if (!canvas.current || !overlay.current) return;
    const viewer = new Viewer(canvas.current), made = new AuthorScene(connection, viewer);
    const gizmos = new Gizmos(viewer, overlay.current), brush = new Brush(viewer);
    for (const hand of [gizmos, brush]) {
      hand.onPreview = (values) => made.preview(values);
      hand.onCommit = () => made.doc?.commit();
    }
    brush.newest = () => made.items;
    brush.onNothing = setBrushSays;
    gizmos.newest = (key) => made.items.find((item) => item.key === key);
    made.onChange = () => setVersion((v) => v + 1);
    setDesk({ viewer, scene: made, gizmos, brush });
    if (listing.scenes.some((entry) => entry.path === AuthorScene.lastOpen)) void made.open(AuthorScene.lastOpen);
    return () => {
      made.onChange = () => {};
      gizmos.dispose();
      brush.use(null, []);
      made.dispose();
      viewer.dispose();
    };
  }, [connection]);

  const items = scene?.items ?? [];
  const item = items.find((candidate) => candidate.key === selected) ?? null;
  const modes = modesOf(item), used = modes.includes(mode) ? mode : "move";
  const select = (key: string) => {
    setSelected(key);
    // The filling is of organs: anything else that is chosen, or was just added, shows where it is.
    setPanel((shown) => (key && (shown === "scene" || (shown === "filling" && !/^organs\/\d+$/.test(key))) ? "place" : shown));
  };

  /** Strokes add and remove anchors: what is selected by its place in a list would be another one afterwards. */
  const paint = (radius: number | null) => {
    if (brushRadius === null) setSelected("");
    setBrushRadius(radius);
  };

  // The picture follows the text.
  useLayoutEffect(() => {
    if (!desk || !scene) return;
    desk.gizmos.onSelect = (key) => key !== selected && select(key);
    desk.gizmos.set(scene.stage, items, brushRadius === null ? selected : "", used, brushRadius !== null);
    desk.brush.radius = brushRadius ?? desk.brush.radius;
    desk.brush.use(brushRadius === null ? null : scene.stage, items);
    scene.poseOrgans();
  });
  useEffect(() => {
    if (doc) doc.onPlace = (path) => {
      const depth = items.map((i) => i.path).filter((p) => p.every((key, k) => path[k] === key)).sort((a, b) => b.length - a.length)[0];
      if (depth) select(depth.join("/"));
    };
  });
  useEffect(() => {
    if (doc && item && !doc.view.hasFocus) doc.reveal(item.path);
  }, [doc, selected]);

  const open = (path: string) => {
    setImported(null), setDropped(null), setSelected(""), setBrushRadius(null), setError(null);
    void scene?.open(path);
  };
  const save = () => doc?.save().then(() => setError(null), (failure: Error) => {
    setError(failure);
    doc.lookOnDisk().catch(() => {});
  });
  const settle = (how: Promise<void>) => void how.then(() => setError(null), setError);
  const remove = (gone: Item) => {
    doc?.set([[gone.path, undefined]]);
    select("");
  };

  // At once with the picture: a key that follows a click belongs to what was clicked.
  useLayoutEffect(() => {
    const press = (event: KeyboardEvent) => {
      const key = event.key.toLowerCase(), isEditing = (event.target as HTMLElement).closest(".editor") !== null;
      if (event.key === "Escape" && brushRadius !== null) setBrushRadius(null);
      else if (event.key === "Delete" && item && canRemove(item, items) && !(event.target as HTMLElement).closest("input, textarea, select, .editor")) remove(item);
      else if (event.target === canvas.current && key in kTurns && !event.ctrlKey && !event.metaKey && !event.altKey) desk?.viewer.turn(...kTurns[key]);
      else if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
      else if (key === "s") void save();
      else if (isEditing) return; // the editor has its own keys
      else if (key === "z" && !event.shiftKey) doc?.undo();
      else if (key === "y" || key === "z") doc?.redo();
      else return;
      event.preventDefault();
    };
    addEventListener("keydown", press);
    return () => removeEventListener("keydown", press);
  });
  // A file that somebody else wrote is noticed while the page is seen, and when its author comes back to it.
  useEffect(() => {
    const look = () => {
      if (doc && document.visibilityState === "visible") doc.lookOnDisk().catch(() => {}); // a program that has ended is told of elsewhere
    };
    const timer = setInterval(look, kLookOnDisk);
    addEventListener("focus", look);
    return () => {
      clearInterval(timer);
      removeEventListener("focus", look);
    };
  }, [doc]);

  useEffect(() => void connection.call<string[]>("scene.formats").then(setEndings, setError), [connection]);
  /** Takes the first file that an import reads; an import is of one. */
  const take = (files: File[]) => {
    const file = files.find(({ name }) => endings.some((ending) => name.toLowerCase().endsWith(ending))) ?? files[0];
    if (file) setDropped(file), setImported(null), setLeftOut(files.filter((other) => other !== file).map(({ name }) => name));
  };
  const drag = (event: DragEvent) => {
    event.preventDefault();
    // It is left for what lies within the room too.
    setOver(event.type === "dragover" ? event.dataTransfer?.types.includes("Files") ?? false
      : event.type === "dragleave" && isOver && (event.currentTarget as Element).contains(event.relatedTarget as Node | null));
  };
  const path = doc?.path ?? "";
  return (
    <div class="room author" onDragOver={drag} onDragLeave={drag} onDrop={(e) => {
      drag(e);
      take([...e.dataTransfer?.files ?? []]);
    }}>
      <nav class={`list ${doc ? "" : "alone"}`} aria-label="Scenes">
        <SceneList connection={connection} listing={listing} scene={scene} onOpen={open} onChanged={onChanged} />
        <label class="pick">
          Import a mesh…
          <input type="file" accept={endings.join(",")} onChange={(e) => {
            take([...e.currentTarget.files ?? []]);
            e.currentTarget.value = "";
          }} />
        </label>
        {scene && doc && (
          <Objects scene={scene} viewer={desk!.viewer} items={items} selected={selected} onSelect={select} brushRadius={brushRadius} onBrush={paint} />
        )}
      </nav>
      <div class="view">
        <canvas ref={canvas} tabIndex={0} aria-label={brushRadius !== null ? kPainting : scene?.shown ? `The scene ${scene.shown.view.name} at rest; A, D, W, S, + and - turn the view, arrow keys move what is chosen` : "No scene"} />
        <div class="handles" ref={overlay} />
        {desk && doc && <ViewBar desk={desk} item={item} modes={modes} mode={used} onMode={setMode} onVersion={() => setVersion((v) => v + 1)} />}
        {!doc && !scene?.isLoading && (
          <Empty title="Drop a mesh of an organ here">
            <p>STL, OBJ, PLY and others, also volume meshes and segmentations. It is checked, repaired and filled with spheres, and becomes a scene that runs. Or choose a scene.</p>
          </Empty>
        )}
        {scene?.isLoading && !scene.shown && <Empty title={`Loading ${path}`}><p>Its organs are read and filled with spheres{scene.filled === null ? "" : `: ${Math.round(100 * scene.filled)} %`}.</p></Empty>}
        {doc && scene && !scene.isLoading && !scene.shown && scene.problems.errors.length > 0 && <Empty title={`${path} cannot be shown`}><p>What is wrong stands beside its text. The picture comes when that is mended.</p></Empty>}
        {scene?.isLoading && scene.shown && <p class="busy" role="status">{scene.fillingText}</p>}
        {brushRadius !== null && brushSays && !scene?.isLoading && <p class="busy brush-says" role="status">{brushSays}</p>}
        {scene?.error && !doc && <Problems error={scene.error} />}
        {isOver && <div class="drop-target">Drop it here to import it</div>}
      </div>
      <div class="time">
        {desk && scene && doc && <Toolbar scene={scene} taken={listing.scenes.map((entry) => entry.path)} onSave={() => void save()}
          onLoad={() => settle(doc.reread())} onKeep={() => settle(doc.keep())} onTry={() => onTry(path, doc.text, desk.viewer.seen())} onCopied={(copy) => {
            onChanged();
            open(copy);
          }} error={error} />}
      </div>
      <aside class="side">
        {dropped ? (
          <div class="panel">
            <ImportForm key={dropped.name} connection={connection} file={dropped} leftOut={leftOut} open={scene?.shown ? scene : null} onCancel={() => setDropped(null)} onDone={(result, isAdded) => {
              setDropped(null);
              if (!isAdded) open(result.scene);
              setImported(result);
              setPanel("scene");
              onChanged();
            }} />
          </div>
        ) : scene && doc ? (
          <>
            <div class="tabs" role="tablist" aria-label="Panels">
              {(["place", "filling", "scene"] as const).map((name) => (
                <button key={name} type="button" role="tab" id={`tab-${name}`} aria-selected={panel === name} aria-controls="panel" onClick={() => setPanel(name)}>{name}</button>
              ))}
            </div>
            <div id="panel" class="panel" role="tabpanel" aria-labelledby={`tab-${panel}`} tabIndex={0}>
              {panel === "place" && brushRadius !== null && <p class="hint">{kPainting}. {kPaintingByHand}</p>}
              {panel === "place" && brushRadius === null && <Inspector scene={scene} item={item} viewer={desk!.viewer} onRemove={canRemove(item, items) ? remove : null} />}
              {panel === "filling" && <Filling connection={connection} scene={scene} chosen={organOf(item)} />}
              {panel === "scene" && <>{imported && <ImportResult imported={imported} />}<About scene={scene} /></>}
            </div>
            <SceneEditor scene={scene} onSelect={select} />
          </>
        ) : <p class="hint">A scene is a JSON file with the unit in every key. It opens here with its organs, and its text beside them.</p>}
      </aside>
    </div>
  );
}

/** What a scene tells trainees is one line. */
function taskOf(typed: string): string | undefined {
  return typed.trim() ? typed.replace(/[\u0000-\u001f\u007f]+/g, " ") : undefined;
}

/** What the picture shows, and what dragging in it does. */
function ViewBar({ desk, item, modes, mode, onMode, onVersion }: { desk: Desk; item: Item | null; modes: GizmoMode[]; mode: GizmoMode; onMode: (mode: GizmoMode) => void; onVersion: () => void }) {
  const { scene, gizmos } = desk;
  return (
    <div class="view-bar">
      <div class="buttons joined" role="group" aria-label="What is shown">
        {(["surface", "both", "spheres"] as Shown[]).map((how) => <button key={how} type="button" aria-pressed={scene.how === how}
          title={how === "both" ? "The spheres half as large as they are, so that the surface is seen around them" : undefined} onClick={() => scene.show(how)}>{how}</button>)}
      </div>
      <div class="right">
        {modes.length > 1 && (
          <div class="buttons joined" role="group" aria-label="What dragging does">
            {modes.map((name) => <button key={name} type="button" aria-pressed={mode === name} onClick={() => onMode(name)}>{name}</button>)}
          </div>
        )}
        {item?.kind === "organ" && (
          <label title="Its anchors, and the tools, probes, loads and forbidden regions that no other organ is nearer to, go where it goes">
            <input type="checkbox" checked={scene.isTakingAlong} onChange={(e) => {
              scene.isTakingAlong = e.currentTarget.checked;
              onVersion();
            }} /> take along what belongs to it
          </label>
        )}
        <label title="What is dragged by its handle follows the surface">
          <input type="checkbox" checked={gizmos.isSnapping} onChange={(e) => {
            gizmos.isSnapping = e.currentTarget.checked;
            onVersion();
          }} /> snap to surface
        </label>
      </div>
    </div>
  );
}

/** What is done with the whole scene. */
function Toolbar({ scene, taken, onSave, onLoad, onKeep, onTry, onCopied, error }: {
  scene: AuthorScene;
  taken: string[]; // scenes that there are
  onSave: () => void;
  onLoad: () => void;
  onKeep: () => void;
  onTry: () => void;
  onCopied: (path: string) => void;
  error: Error | null;
}) {
  const doc = scene.doc!;
  const [isCopying, setCopying] = useState(false);
  const { errors, warnings } = scene.problems;
  const tools = scene.shown?.view.tools.length ?? 0;
  const share = scene.tickTime ? scene.tickTime.measured_tick_time_s / scene.tickTime.tick_s : 0;
  const titled = (word: string, step: typeof undo, key: string) => {
    const what = doc.whatChanges(step);
    return [word, what && saidOf(what.path, what.value), `(${key})`].filter(Boolean).join(" ");
  };
  return (
    <>
      <div class="transport">
        <div class="buttons" role="group" aria-label="History">
          <button type="button" disabled={!doc.canUndo} title={titled("Undo", undo, "Ctrl+Z")} onClick={() => doc.undo()}>Undo</button>
          <button type="button" disabled={!doc.canRedo} title={titled("Redo", redo, "Ctrl+Shift+Z")} onClick={() => doc.redo()}>Redo</button>
        </div>
        <span class={`verdict ${errors.length ? "bad" : "good"}`} role="status" aria-busy={scene.isBehind} title="What `ctpm check` says of the text as it is now; its lines are below the text">
          {verdictOf(errors.length, warnings.length)}{doc.isChanged ? ", not saved" : doc.onDisk === "same" ? ", saved" : ""}
        </span>
        <div class="buttons">
          <button type="button" disabled={!doc.isChanged} title="Ctrl+S" onClick={onSave}>Save</button>
          <button type="button" aria-expanded={isCopying} onClick={() => setCopying(!isCopying)}>Save a copy…</button>
          <button type="button" class="main" disabled={tools === 0 || errors.length > 0} title={errors.length > 0 ? "Its text has errors" : tools === 0 ? "The scene has no tool yet" : "Nothing is recorded"} onClick={onTry}>Try it</button>
        </div>
      </div>
      {isCopying && <CopyForm key={doc.path} doc={doc} taken={taken} onClose={() => setCopying(false)} onCopied={onCopied} />}
      {doc.onDisk === "same" ? error && <div class="conflict"><Problems error={error} /></div> : (
        <div class="conflict" role="alert">
          <p>{doc.onDisk === "gone" ? `${doc.path} is no longer there.` : `${doc.path} was changed on the disk since it was read here.`}</p>
          <div class="buttons">
            {doc.onDisk === "changed" && <button type="button" title="Undo brings your text back" onClick={onLoad}>Load it</button>}
            <button type="button" title="Saving then writes your text over it" onClick={onKeep}>Keep mine</button>
          </div>
        </div>
      )}
      {share > 1 && !scene.isBehind && <p class="earlier-visit warning" role="status">A step of this scene takes {ofStep(scene.tickTime!.measured_tick_time_s, scene.tickTime!.tick_s)}: on this machine it runs in slow motion. Larger spheres (filling){listOf(doc.lastValue, "organs").length > 1 ? ", or organs that do not touch, help" : " help"}.</p>}
      {doc.onDisk === "same" && doc.isOfEarlierVisit && <p class="earlier-visit warning" role="status">These are unsaved changes of an earlier visit: Undo takes them back, Save writes them into the file.</p>}
    </>
  );
}

/** The text as it is now, under another name: beside the file, so that it finds the same meshes. */
function CopyForm({ doc, taken, onClose, onCopied }: { doc: SceneDocument; taken: string[]; onClose: () => void; onCopied: (path: string) => void }) {
  const folder = /^.*\//.exec(doc.path)?.[0];
  const [name, setName] = useState(() => freePath(taken, doc.path).slice(folder?.length ?? 0, -".json".length)), [error, setError] = useState<Error | null>(null);
  const field = useRef<HTMLInputElement>(null);
  useEffect(() => field.current?.select(), []);
  const path = `${folder ?? ""}${name}.json`;
  const isName = isFileName(name);
  return (
    <form class="conflict" onKeyDown={(e) => e.key === "Escape" && onClose()} onSubmit={(e) => {
      e.preventDefault();
      doc.saveCopy(path).then(() => (onClose(), onCopied(path)), setError);
    }}>
      <label class="copy-name">{folder}<input ref={field} value={name} aria-label="Name of the copy, without .json" onInput={(e) => (setName(e.currentTarget.value), setError(null))} />.json</label>
      <Problems error={error} />
      <div class="buttons">
        <button type="submit" class="main" disabled={!isName}>Save the copy</button>
        <button type="button" onClick={onClose}>Back</button>
      </div>
    </form>
  );
}

/** What the program says of the scene. */
function About({ scene }: { scene: AuthorScene }) {
  const { shown, doc } = scene, task = findJson(doc!.lastValue, ["task"]);
  return (
    <>
      <Section title="Task">
        <label class="field">
          <span>what a trainee is to do here</span>
          <textarea rows={3} value={typeof task === "string" ? task : ""} onInput={(e) => doc!.preview([[["task"], taskOf(e.currentTarget.value)]])} onChange={() => doc!.commit()} />
        </label>
      </Section>
      <Behaviour scene={scene} />
      {shown && (
        <Section title={shown.view.name}>
          <div class="numbers" aria-busy={scene.isRefilling}>
            <Readings rows={[
              ...shown.view.organs.map((organ): [string, string] => [organ.name, `${organ.spheres} spheres in ${organ.layers} layers`]),
              ["elements", String(shown.elements)],
              ["tools", shown.view.tools.map((tool) => tool.name).join(", ") || "none"],
            ]} />
          </div>
          <ShownCommand text={command("check", doc!.path)} />
        </Section>
      )}
      {shown?.organs.map((organ, i) => organ.report && (
        <Section key={i} title={`${shown.view.organs[i].name}: its mesh`}>
          {organ.findings.length === 0 ? <p class="hint">Nothing is left to repair in the file that the scene names.</p> : <Findings findings={organ.findings} />}
          <pre>{organ.report}</pre>
        </Section>
      ))}
    </>
  );
}

