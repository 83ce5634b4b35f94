import { useEffect, useRef, useState } from "preact/hooks";
import type { Connection } from "./connection";
import { Problems, Section, useFocusBack } from "./parts";
import type { Player } from "./player";
import type { Note, Notes } from "./protocol";
import { hashOf } from "./place";
import { seconds } from "./text";

/** Of sessions by path; an error: they cannot be read. */
export type ReadNotes = Record<string, Notes | Error>;

export interface KeptNotes {
  all: ReadNotes;
  /** Writes them over those that are shown. Where somebody else wrote meanwhile it fails, and shows what is there. */
  write(path: string, notes: Note[]): Promise<void>;
}

/** The notes of sessions that are open, read again when `isShown` changes; somebody else may have written some. */
export function useNotes(connection: Connection, paths: string[], isShown: boolean): KeptNotes {
  const [all, setAll] = useState<ReadNotes>({});
  const turns = useRef(new Map<string, number>()); // of each path: what was begun last has the highest
  const begin = (path: string) => {
    const turn = (turns.current.get(path) ?? 0) + 1;
    turns.current.set(path, turn);
    return () => turns.current.get(path) === turn;
  };
  const take = (path: string, read: Notes | Error) => setAll((now) => ({ ...now, [path]: read }));
  const read = async (path: string) => {
    const isNewest = begin(path);
    const answer = await connection.call<Notes>("notes.read", { path }).catch((failure: Error) => failure);
    if (isNewest()) take(path, answer);
  };
  const write = async (path: string, notes: Note[]) => {
    const { revision } = all[path] as Notes;
    try {
      const written = await connection.call<Notes>("notes.write", { path, revision, notes });
      begin(path); // what is read at this time may be what was there before
      take(path, written);
    } catch (failure) {
      await read(path);
      throw failure;
    }
  };
  useEffect(() => {
    for (const path of paths) void read(path);
  }, [...[0, 1].map((stage) => paths[stage]), isShown]);
  return { all, write };
}

function withNote(notes: Note[], note: Note): Note[] {
  return [...notes, note].sort((a, b) => a.time_s - b.time_s);
}
function withoutNote(notes: Note[], gone: Note): Note[] {
  const at = notes.findIndex((note) => isSame(note, gone));
  return notes.filter((_, i) => i !== at);
}
function isSame(a: Note, b: Note): boolean {
  return a.time_s === b.time_s && a.text === b.text;
}

/** The words of a note, written with Ctrl+Enter. */
function NoteText({ label, text, onText, onDone }: { label: string; text: string; onText: (text: string) => void; onDone: () => void }) {
  return (
    <label class="field">
      <span>{label}</span>
      <textarea rows={3} value={text} onInput={(e) => onText(e.currentTarget.value)}
        onKeyDown={(e) => {
          if (e.key === "Enter" && (e.ctrlKey || e.metaKey)) onDone();
        }} />
    </label>
  );
}

/** Other words for a note. `isThere`: it still is as it was when they were begun. */
function NoteEditor({ note, isThere, canSave, onSave, onClose }: {
  note: Note;
  isThere: boolean;
  canSave: boolean;
  onSave: (text: string) => void;
  onClose: () => void;
}) {
  const [text, setText] = useState(note.text), box = useRef<HTMLDivElement>(null);
  const isReady = canSave && text.trim() !== "", save = () => isReady && onSave(text.trim());
  useFocusBack();
  useEffect(() => box.current?.querySelector("textarea")?.focus(), []);
  return (
    <div ref={box} class="note-editor" onKeyDown={(e) => e.key === "Escape" && onClose()}>
      {!isThere && <p class="warning" role="status">Somebody else changed or deleted this note; what you save is one more.</p>}
      <NoteText label={`the note at ${seconds(note.time_s)}`} text={text} onText={setText} onDone={save} />
      <div class="buttons">
        <button type="button" class="main" disabled={!isReady} onClick={save}>Save</button>
        <button type="button" onClick={onClose}>Cancel</button>
      </div>
    </div>
  );
}

let begunNotes: Record<string, string> = {}; // words of each session's next note, while the page is there

/** Notes at moments of a session, kept in a file beside it. */
export function NotesPanel({ player, notes: { all, write } }: { player: Player; notes: KeptNotes }) {
  const second = player.tracks.get(1)?.session.path;
  const [wanted, setWanted] = useState(1); // of a pair: what is reviewed is the trainee's
  const stage = second ? wanted : 0, { path, info } = player.tracks.get(stage)!.session;
  const time = player.timeOf(stage), isIn = time >= 0 && time <= info.duration_s;
  const read = all[path], notes = read && !(read instanceof Error) ? read.notes : null; // until they are there nothing can be added to them
  const [begun, setBegun] = useState(begunNotes), text = begun[path] ?? "";
  const setText = (words: string) => setBegun((begunNotes = { ...begunNotes, [path]: words }));
  const [edited, setEdited] = useState<Record<string, Note | undefined>>({}); // of each session one, so that none is lost on the way to another
  const [deleted, setDeleted] = useState<Record<string, Note | undefined>>({}); // last
  const edit = (note?: Note) => setEdited((now) => ({ ...now, [path]: note }));
  const isEdited = (note: Note) => edited[path] !== undefined && isSame(note, edited[path]);
  const [error, setError] = useState<Error | null>(null);
  const [isWriting, setWriting] = useState(false);
  useEffect(() => setError(null), [path]);

  /** Whether they were written. */
  const change = async (to: Note[]) => {
    setError(null), setWriting(true);
    const failure = await write(path, to).then(() => null, (why: Error) => why);
    setWriting(false), setError(failure);
    return !failure;
  };
  const canAdd = text.trim() !== "" && notes !== null && isIn && !isWriting;
  const add = async () => {
    if (canAdd && (await change(withNote(notes, { time_s: time, text: text.trim() })))) setText("");
  };
  const save = async (old: Note, words: string) => {
    if (await change(withNote(withoutNote(notes!, old), { ...old, text: words }))) edit();
  };
  const remove = async (note: Note) => {
    if (!(await change(withoutNote(notes!, note)))) return;
    setDeleted((now) => ({ ...now, [path]: note }));
    if (isEdited(note)) edit();
  };
  const undo = async (note: Note) => {
    if (await change(withNote(notes!, note))) setDeleted((now) => ({ ...now, [path]: undefined }));
  };
  return (
    <>
      <Section title="Notes">
        {second && (
          <label class="field">
            <span>of</span>
            <select value={stage} onChange={(e) => setWanted(Number(e.currentTarget.value))}>
              {[0, 1].map((each) => <option key={each} value={each}>{player.tracks.get(each)!.session.path}</option>)}
            </select>
          </label>
        )}
        <NoteText label={`at ${seconds(time)}${isIn ? "" : ", when this session does not run"}`} text={text} onText={setText} onDone={() => void add()} />
        <button type="button" class="main" disabled={!canAdd} onClick={() => void add()}>Add note</button>
        <Problems error={error ?? (read instanceof Error ? read : null)} />
        {error && notes && <p class="hint">They were read again: below they are as they are now.</p>}
        {notes?.length === 0 && <p class="hint">No notes yet. They are kept in a file beside the session, which never changes.</p>}
        {Object.entries(edited).map(([of, note]) => note && (
          <div key={of} hidden={of !== path}>
            <NoteEditor note={note} isThere={of !== path || isWriting || !notes || notes.some(isEdited)} canSave={!isWriting && notes !== null}
              onSave={(words) => void save(note, words)} onClose={() => edit()} />
          </div>
        ))}
        <ul class="jumps">
          {notes?.map((note, i) => (
            <li key={i}>
              <button type="button" aria-current={isEdited(note)} onClick={() => player.move(stage === 0 ? note.time_s : player.firstAt(note.time_s))}><span class="number">{seconds(note.time_s)}</span> {note.text}</button>
              <button type="button" class="quiet" aria-label={`Edit the note at ${seconds(note.time_s)}`} disabled={isWriting || edited[path] !== undefined}
                onClick={() => edit(note)}>edit</button>
              <button type="button" class="quiet" aria-label={`Delete the note at ${seconds(note.time_s)}`} disabled={isWriting}
                onClick={() => void remove(note)}>×</button>
            </li>
          ))}
        </ul>
        {deleted[path] && notes && (
          <p class="hint" role="status">The note at {seconds(deleted[path].time_s)} was deleted. <button type="button" disabled={isWriting} onClick={() => void undo(deleted[path]!)}>Undo</button></p>
        )}
      </Section>
      <LinkHere player={player} />
    </>
  );
}

function LinkHere({ player }: { player: Player }) {
  const [copied, setCopied] = useState("");
  const link = `${location.origin}/#${hashOf("review", player.place)}`;
  const copyLink = () => {
    setCopied(link);
    void navigator.clipboard?.writeText(link).catch(() => {});
  };
  return (
    <Section title="Link to this moment">
      <button type="button" onClick={copyLink}>Copy the link</button>
      {copied === link && <p class="hint" role="status">Opens this moment in this browser while the studio runs: <code>{copied}</code></p>}
    </Section>
  );
}
