// The scenes of the folder: one is opened, renamed or removed, and what was removed comes back.
import { useEffect, useRef, useState } from "preact/hooks";
import type { AuthorScene, Gone } from "./author_scene";
import type { Connection } from "./connection";
import { hasDraft } from "./document";
import { parseJson } from "./json_edit";
import { Problems } from "./parts";
import type { Listing, Removal, SceneOfSession } from "./protocol";
import { counted } from "./text";

/** A scene that was removed, and how it is brought back. */
interface Removed extends Gone {
  removed: string; // its number
  folder: string; // where its files are
}
let removedHere: Removed[] = []; // while the page is there

const nameOf = (path: string) => path.replace(/\.json$/, "");

export function SceneList({ connection, listing, scene, onOpen, onChanged }: {
  connection: Connection;
  listing: Listing;
  scene: AuthorScene | null;
  onOpen: (path: string) => void;
  onChanged: () => void;
}) {
  const [chosen, setChosen] = useState(""); // to be renamed or removed; empty: none
  const [gone, setGone] = useState(removedHere);
  const [error, setError] = useState<Error | null>(null); // of what comes back
  const path = scene?.doc?.path ?? "";
  useEffect(() => void (removedHere = gone), [gone]);

  const rename = (to: string, rewritten: string[]) => {
    scene?.renamed(chosen, to);
    onChanged();
    if (rewritten.length === 0) setChosen("");
  };
  const removed = ({ removed, folder }: { removed: string; folder: string }) => {
    if (scene) setGone([...gone, { ...scene.removed(chosen), removed, folder }]);
    setChosen("");
    onChanged();
  };
  const bringBack = (one: Removed) => connection.call("scene.restore", { removed: one.removed }).then(() => {
    scene?.restored(one);
    setGone((all) => all.filter((other) => other !== one));
    onChanged();
    if (one.wasOpen) onOpen(one.path);
  }, setError);
  return (
    <>
      <h2>Scenes</h2>
      {listing.scenes.length === 0 && <p class="hint">No scene in this folder yet.</p>}
      <ul class="scenes">
        {listing.scenes.map((entry) => (
          <li key={entry.path}>
            <button type="button" aria-current={path === entry.path} title={entry.path} onClick={() => onOpen(entry.path)}><span>{nameOf(entry.path)}</span></button>
            <button type="button" class="quiet more" aria-expanded={chosen === entry.path} aria-label={`Rename or remove ${nameOf(entry.path)}`} title="Rename or remove"
              onClick={() => setChosen(chosen === entry.path ? "" : entry.path)}>…</button>
          </li>
        ))}
      </ul>
      {chosen && <SceneForm key={chosen} connection={connection} path={chosen} isChanged={hasDraft(chosen)} onRenamed={rename} onRemoved={removed} onClose={() => setChosen("")} />}
      {gone.map((one) => (
        <div key={one.removed} class="scene-form" role="status">
          <p>{nameOf(one.path)} was removed. Its files are in <code>{one.folder}</code>.</p>
          <Problems error={error} />
          <div class="buttons">
            <button type="button" onClick={() => void bringBack(one)}>Undo</button>
            <button type="button" class="quiet" onClick={() => (setGone(gone.filter((other) => other !== one)), setError(null))}>Close</button>
          </div>
        </div>
      ))}
    </>
  );
}

/** Asks for a new name, or whether the scene is to go; says what goes with it and what stays. */
function SceneForm({ connection, path, isChanged, onRenamed, onRemoved, onClose }: {
  connection: Connection;
  path: string;
  isChanged: boolean; // and not saved
  onRenamed: (to: string, rewritten: string[]) => void;
  onRemoved: (where: { removed: string; folder: string }) => void;
  onClose: () => void;
}) {
  const [, folder = "", stem] = /^(.*\/)?(.*?)\.json$/.exec(path)!;
  const [name, setName] = useState(stem), [removal, setRemoval] = useState<Removal | null>(null);
  const [recordings, setRecordings] = useState({ count: 0, of: "" }); // sessions of a scene whose text has that name
  const [rewritten, setRewritten] = useState<string[]>([]);
  const [error, setError] = useState<Error | null>(null);
  const first = useRef<HTMLInputElement>(null), sure = useRef<HTMLButtonElement>(null);
  useEffect(() => (first.current?.focus(), first.current?.select()), []);
  useEffect(() => sure.current?.focus(), [removal]);
  const isName = /^[^/\\]+$/.test(name) && name !== stem, to = `${folder}${name}.json`;

  const rename = () => connection.call<{ rewritten: string[] }>("scene.rename", { path, to }).then((done) => {
    setRewritten(done.rewritten);
    onRenamed(to, done.rewritten);
  }, setError);
  const ask = async () => {
    setError(null);
    try {
      setRemoval(await connection.call<Removal>("scene.removal", { path }));
      const { text } = await connection.call<{ text: string }>("scene.read", { path }), value = parseJson(text) as { name?: string } | undefined;
      const sessions = await connection.call<SceneOfSession[]>("session.scenes"), of = value?.name ?? "";
      setRecordings({ count: sessions.filter(({ scene_name }) => of !== "" && scene_name === of).length, of });
    } catch (failure) {
      setError(failure as Error);
    }
  };
  const remove = () => connection.call<{ removed: string; folder: string }>("scene.remove", { path, files: removal!.goes }).then(onRemoved, setError);
  const keys = (event: KeyboardEvent) => {
    if (event.key === "Escape") event.stopPropagation(), onClose();
  };
  if (rewritten.length > 0)
    return (
      <div class="scene-form" role="status">
        <p>{nameOf(path)} is {name} now, and so it is named in {rewritten.join(", ")}.</p>
        <div class="buttons"><button type="button" class="quiet" onClick={onClose}>Close</button></div>
      </div>
    );
  if (removal)
    return (
      <div class="scene-form" role="group" aria-label={`Remove ${nameOf(path)}`} onKeyDown={keys}>
        <p><b>Remove {nameOf(path)}?</b> These files go, and Undo brings them back:</p>
        <ul class="files">{removal.goes.map((file) => <li key={file}>{file}</li>)}</ul>
        {isChanged && <p class="warning">What is not saved of it goes too.</p>}
        <p>Its recordings stay, and replay without it{recordings.count > 0 && `: ${counted(recordings.count, "session")} of a scene named ${recordings.of}`}.</p>
        {removal.stays.length > 0 && <ul class="files">{removal.stays.map(({ path: file, why }) => <li key={file}>{file} stays: {why}</li>)}</ul>}
        <Problems error={error} />
        <div class="buttons">
          <button ref={sure} type="button" class="main" onClick={() => void remove()}>Remove</button>
          <button type="button" onClick={onClose}>Back</button>
        </div>
      </div>
    );
  return (
    <form class="scene-form" aria-label={`Rename or remove ${nameOf(path)}`} onKeyDown={keys} onSubmit={(e) => {
      e.preventDefault();
      void rename();
    }}>
      <label class="copy-name">{folder}<input ref={first} value={name} aria-label="New name of the scene, without .json" onInput={(e) => (setName(e.currentTarget.value), setError(null))} />.json</label>
      <p class="hint">Recordings know it by the name in its text, which stays.</p>
      <Problems error={error} />
      <div class="buttons">
        <button type="submit" class="main" disabled={!isName}>Rename</button>
        <button type="button" onClick={() => void ask()}>Remove…</button>
        <button type="button" class="quiet" onClick={onClose}>Back</button>
      </div>
    </form>
  );
}
