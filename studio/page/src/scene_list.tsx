// The scenes of the folder: one is opened, renamed or removed, and what was removed comes back.
import { useEffect, useRef, useState } from "preact/hooks";
import type { AuthorScene } from "./author_scene";
import type { Connection } from "./connection";
import { dropNeedlessDrafts } from "./document";
import { hasDraft } from "./drafts";
import { parseJson } from "./json_edit";
import { Problems, useFocusBack } from "./parts";
import type { Listing, Removal, SceneOfSession } from "./protocol";
import { RemovedScenes } from "./removed_scenes";
import { counted, isFileName, sceneName } from "./text";

/** A scene that was removed in this page, which says so until it is told that this is known. */
interface Gone {
  path: string;
  removed: string; // its number
  folder: string; // where its files are
  wasOpen: boolean;
}
let goneHere: Gone[] = []; // while the page is there

export function SceneList({ connection, listing, scene, onOpen, onChanged }: {
  connection: Connection;
  listing: Listing;
  scene: AuthorScene | null;
  onOpen: (path: string) => void;
  onChanged: () => void;
}) {
  const [chosen, setChosen] = useState(""); // to be renamed or removed; empty: none
  const [gone, setGone] = useState(goneHere);
  const [error, setError] = useState<Error | null>(null); // of what comes back
  const [, setVersion] = useState(0);
  const path = scene?.doc?.path ?? "";
  useEffect(() => void (goneHere = gone), [gone]);
  // A file may have been written meanwhile, by a command or in another tab, as its draft is.
  useEffect(() => void dropNeedlessDrafts(connection, listing.scenes.map((entry) => entry.path).filter(hasDraft)).then((any) => any && setVersion((v) => v + 1)), [connection, listing]);

  const rename = (to: string, rewritten: string[]) => {
    scene?.renamed(chosen, to);
    onChanged();
    if (rewritten.length === 0) setChosen("");
  };
  const removed = (where: { removed: string; folder: string }) => {
    if (scene) setGone([...gone, { path: chosen, ...where, wasOpen: scene.removed(chosen, where.folder) }]);
    setChosen("");
    onChanged();
  };
  const known = (number: string) => (setGone((all) => all.filter(({ removed }) => removed !== number)), setError(null));
  const undo = (one: Gone) => connection.call("scene.restore", { removed: one.removed }).then(() => restored(one.path, one.removed, one.folder), setError);
  const restored = (back: string, number: string, folder: string) => {
    scene?.restored(back, folder);
    known(number);
    onChanged();
    if (gone.some(({ removed, wasOpen }) => removed === number && wasOpen)) onOpen(back);
  };
  return (
    <>
      <h2>Scenes</h2>
      {listing.scenes.length === 0 && <p class="hint">No scene in this folder yet.</p>}
      <ul class="scenes">
        {listing.scenes.map((entry, i) => (
          <li key={entry.path}>
            <button type="button" aria-current={path === entry.path} aria-describedby={hasDraft(entry.path) ? `draft-${i}` : undefined} title={entry.path} onClick={() => onOpen(entry.path)}><span>{sceneName(entry.path)}</span></button>
            <button type="button" class="quiet more" aria-expanded={chosen === entry.path} aria-label={`Rename or remove ${sceneName(entry.path)}`} title="Rename or remove"
              onClick={() => setChosen(chosen === entry.path ? "" : entry.path)}>…</button>
            {hasDraft(entry.path) && <small id={`draft-${i}`} class="draft">unsaved changes</small>}
          </li>
        ))}
      </ul>
      {chosen && <SceneForm key={chosen} connection={connection} path={chosen} isChanged={hasDraft(chosen)} onRenamed={rename} onRemoved={removed} onClose={() => setChosen("")} />}
      {gone.map((one) => (
        <div key={one.removed} class="scene-form" role="status">
          <p>{sceneName(one.path)} was removed. Its files are in <code>{one.folder}</code>.</p>
          <Problems error={error} />
          <div class="buttons">
            <button type="button" onClick={() => void undo(one)}>Undo</button>
            <button type="button" class="quiet" onClick={() => known(one.removed)}>Close</button>
          </div>
        </div>
      ))}
      <RemovedScenes connection={connection} listing={listing} onRestored={restored} onDeleted={(of, number, folder) => {
        scene?.deleted(of, folder);
        known(number);
        onChanged();
      }} onOutdated={onChanged} />
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
  useFocusBack();
  const first = useRef<HTMLInputElement>(null), sure = useRef<HTMLButtonElement>(null);
  useEffect(() => (first.current?.focus(), first.current?.select()), []);
  useEffect(() => sure.current?.focus(), [removal]);
  const isName = isFileName(name) && name !== stem, to = `${folder}${name}.json`;

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
        <p>{sceneName(path)} is {name} now, and so it is named in {rewritten.join(", ")}.</p>
        <div class="buttons"><button type="button" class="quiet" onClick={onClose}>Close</button></div>
      </div>
    );
  if (removal)
    return (
      <div class="scene-form" role="group" aria-label={`Remove ${sceneName(path)}`} onKeyDown={keys}>
        <p><b>Remove {sceneName(path)}?</b> These files go, and Undo brings them back:</p>
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
    <form class="scene-form" aria-label={`Rename or remove ${sceneName(path)}`} onKeyDown={keys} onSubmit={(e) => {
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
