import { useEffect, useState } from "preact/hooks";
import type { Connection } from "./connection";
import { Problems, Section } from "./parts";
import type { Player } from "./player";
import type { Note, Notes } from "./protocol";
import { hashOf } from "./place";
import { seconds } from "./text";

/** Notes at moments of a session, kept in a file beside it. */
export function NotesPanel({ connection, player, onNotes }: { connection: Connection; player: Player; onNotes: (notes: Note[], stage: number) => void }) {
  const second = player.tracks.get(1)?.session.path;
  const [wanted, setWanted] = useState(1); // of a pair: what is reviewed is the trainee's
  const stage = second ? wanted : 0, { path, info } = player.tracks.get(stage)!.session;
  const time = player.timeOf(stage), isIn = time >= 0 && time <= info.duration_s;
  const [notes, setNotes] = useState<Notes | null>(null);
  const [text, setText] = useState("");
  const [error, setError] = useState<Error | null>(null);
  const [copied, setCopied] = useState("");
  const take = (read: Notes) => {
    setNotes(read);
    onNotes(read.notes, stage);
  };
  useEffect(() => {
    let isWanted = true;
    setNotes(null); // until they are there nothing can be added to them: they were those of the other session
    connection.call<Notes>("notes.read", { path }).then((read) => isWanted && take(read), (failure) => isWanted && setError(failure));
    return () => void (isWanted = false);
  }, [path]);

  const write = async (list: Note[]) => {
    setError(null);
    try {
      take(await connection.call<Notes>("notes.write", { path, revision: notes!.revision, notes: list }));
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
        <Problems error={error} />
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
