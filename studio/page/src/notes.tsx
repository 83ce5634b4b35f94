import { useEffect, useState } from "preact/hooks";
import type { Connection } from "./connection";
import { Problems, Section } from "./parts";
import type { Player } from "./player";
import type { Note, Notes } from "./protocol";
import { hashOf } from "./place";
import { seconds } from "./text";

/** Of sessions by path; an error: they cannot be read. */
export type ReadNotes = Record<string, Notes | Error>;

/** The notes of sessions that are open, read again when `isShown` changes; somebody else may have written some. */
export function useNotes(connection: Connection, paths: string[], isShown: boolean): [ReadNotes, (path: string, notes: Notes) => void] {
  const [all, setAll] = useState<ReadNotes>({});
  const take = (path: string, read: Notes | Error) => setAll((now) => ({ ...now, [path]: read }));
  useEffect(() => {
    for (const path of paths) connection.call<Notes>("notes.read", { path }).then((read) => take(path, read), (failure) => take(path, failure));
  }, [...[0, 1].map((stage) => paths[stage]), isShown]);
  return [all, take];
}

/** Notes at moments of a session, kept in a file beside it. */
export function NotesPanel({ connection, player, all, onNotes }: {
  connection: Connection;
  player: Player;
  all: ReadNotes;
  onNotes: (path: string, notes: Notes) => void;
}) {
  const second = player.tracks.get(1)?.session.path;
  const [wanted, setWanted] = useState(1); // of a pair: what is reviewed is the trainee's
  const stage = second ? wanted : 0, { path, info } = player.tracks.get(stage)!.session;
  const time = player.timeOf(stage), isIn = time >= 0 && time <= info.duration_s;
  const read = all[path], notes = read && !(read instanceof Error) ? read : null; // until they are there nothing can be added to them
  const [text, setText] = useState("");
  const [error, setError] = useState<Error | null>(null);
  const [copied, setCopied] = useState("");

  const write = async (list: Note[]) => {
    setError(null);
    try {
      onNotes(path, await connection.call<Notes>("notes.write", { path, revision: notes!.revision, notes: list }));
      return true;
    } catch (failure) {
      setError(failure as Error);
      return false;
    }
  };
  const add = async () => {
    if (!text.trim() || !notes || !isIn) return;
    const list = [...notes.notes, { time_s: time, text: text.trim() }].sort((a, b) => a.time_s - b.time_s);
    if (await write(list)) setText("");
  };
  const link = `${location.origin}/#${hashOf("review", player.place)}`;
  const copyLink = () => {
    setCopied(link);
    void navigator.clipboard?.writeText(link).catch(() => {});
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
        <label class="field">
          <span>at {seconds(time)}{!isIn && ", when this session does not run"}</span>
          <textarea rows={3} value={text} onInput={(e) => setText(e.currentTarget.value)}
            onKeyDown={(e) => {
              if (e.key === "Enter" && (e.ctrlKey || e.metaKey)) void add();
            }} />
        </label>
        <button type="button" class="main" disabled={!text.trim() || !notes || !isIn} onClick={() => void add()}>Add note</button>
        <Problems error={error ?? (read instanceof Error ? read : null)} />
        {notes?.notes.length === 0 && <p class="hint">No notes yet. They are kept in a file beside the session, which never changes.</p>}
        <ul class="jumps">
          {notes?.notes.map((note, i) => (
            <li key={i}>
              <button type="button" onClick={() => player.move(stage === 0 ? note.time_s : player.firstAt(note.time_s))}><span class="number">{seconds(note.time_s)}</span> {note.text}</button>
              <button type="button" class="quiet" aria-label={`Delete the note at ${seconds(note.time_s)}`}
                onClick={() => void write(notes.notes.filter((_, k) => k !== i))}>×</button>
            </li>
          ))}
        </ul>
      </Section>
      <Section title="Link to this moment">
        <button type="button" onClick={copyLink}>Copy the link</button>
        {copied === link && <p class="hint" role="status">Opens this moment in this browser while the studio runs: <code>{copied}</code></p>}
      </Section>
    </>
  );
}
