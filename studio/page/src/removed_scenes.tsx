// Scenes that were removed: at the end of the list, until they are brought back or deleted for good.
import { useEffect, useRef, useState } from "preact/hooks";
import type { Connection } from "./connection";
import { hasDraft } from "./drafts";
import { Problems, useFocusBack } from "./parts";
import type { Listing } from "./protocol";
import { bytes, sceneName } from "./text";

/** What went in one removal, and is there still. */
interface RemovedScene {
  removed: string; // its number
  path: string; // of the scene, where it was; empty: none is among the files
  removed_s: number; // since 1970
  files: { path: string; bytes: number; used_by: string }[]; // used_by: a scene that needs it; empty: none
}

const folderOf = (one: RemovedScene) => `.ctpm-removed/${one.removed}`;
const nameOf = (one: RemovedScene) => sceneName(one.path || one.files[0].path);
const sizeOf = (one: RemovedScene) => one.files.reduce((sum, file) => sum + file.bytes, 0);

export function RemovedScenes({ connection, listing, onRestored, onDeleted, onOutdated }: {
  connection: Connection;
  listing: Listing; // a new one: what was removed may have changed
  onRestored: (path: string, removed: string, folder: string) => void;
  onDeleted: (path: string, removed: string, folder: string) => void;
  onOutdated: () => void; // somebody else changed it
}) {
  const [all, setAll] = useState<RemovedScene[]>([]);
  const [chosen, setChosen] = useState(""); // to be deleted; empty: none
  const [error, setError] = useState<Error | null>(null);
  const heading = useRef<HTMLElement>(null);
  useEffect(() => void connection.call<RemovedScene[]>("scene.removed").then(setAll, setError), [connection, listing]);
  if (all.length === 0 && !error) return null;

  const tell = (done: (path: string, removed: string, folder: string) => void, one: RemovedScene) => {
    setError(null), setChosen("");
    heading.current?.focus(); // what had it goes
    done(one.path, one.removed, folderOf(one));
  };
  const fail = (failure: Error) => (setError(failure), onOutdated());
  return (
    <details class="removed-scenes">
      <summary ref={heading}>Removed scenes <small>{all.length}</small></summary>
      <Problems error={error} />
      <ul>
        {all.map((one) => (
          <li key={one.removed}>
            <span>{nameOf(one)}</span>
            <small><time dateTime={new Date(1e3 * one.removed_s).toISOString()}>{when(one.removed_s)}</time>, <span class="size">{bytes(sizeOf(one))}</span></small>
            <div class="buttons">
              <button type="button" aria-label={`Bring back ${nameOf(one)}`} title={one.files.map(({ path }) => path).join("\n")}
                onClick={() => void connection.call("scene.restore", { removed: one.removed }).then(() => tell(onRestored, one), fail)}>Bring back</button>
              <button type="button" class="quiet" aria-expanded={chosen === one.removed} aria-label={`Delete ${nameOf(one)} for good`}
                onClick={() => setChosen(chosen === one.removed ? "" : one.removed)}>Delete…</button>
            </div>
            {chosen === one.removed && <DeleteForm one={one} onClose={() => setChosen("")} onSure={() =>
              void connection.call("scene.delete", { removed: one.removed, files: one.files.map(({ path }) => path) }).then(() => tell(onDeleted, one), fail)} />}
          </li>
        ))}
      </ul>
    </details>
  );
}

/** Asks whether a scene is to go for good; says what is deleted, how large it is and who would miss it. */
function DeleteForm({ one, onClose, onSure }: { one: RemovedScene; onClose: () => void; onSure: () => void }) {
  const back = useRef<HTMLButtonElement>(null);
  useFocusBack();
  useEffect(() => (back.current?.focus(), back.current?.scrollIntoView({ block: "nearest" })), []); // nothing is deleted by a key that was pressed twice
  return (
    <div class="scene-form" role="group" aria-label={`Delete ${nameOf(one)} for good`} onKeyDown={(event) => {
      if (event.key === "Escape") event.stopPropagation(), onClose();
    }}>
      <p><b>Delete {nameOf(one)} for good?</b> Nothing brings these {bytes(sizeOf(one))} back:</p>
      <ul class="files">{one.files.map(({ path, bytes: size }) => <li key={path}>{path} <span class="size">{bytes(size)}</span></li>)}</ul>
      {one.files.filter(({ used_by }) => used_by).map(({ path, used_by }) => <p key={path} class="warning">{used_by} needs {path}.</p>)}
      {one.path && hasDraft(`${folderOf(one)}/${one.path}`) && <p class="warning">What is not saved of it goes too.</p>}
      <div class="buttons">
        <button type="button" class="main" onClick={onSure}>Delete</button>
        <button ref={back} type="button" onClick={onClose}>Back</button>
      </div>
    </div>
  );
}

function when(time_s: number): string {
  return new Date(1e3 * time_s).toLocaleString([], { dateStyle: "medium", timeStyle: "short" });
}
