import { useEffect, useRef, useState } from "preact/hooks";
import type { Connection } from "./connection";
import { Problems, Section } from "./parts";
import { type Problem, problemText } from "./protocol";

const kCheckAfter = 300; // without a key [ms]

interface Checked {
  errors: Problem[];
  warnings: Problem[];
}

/** Line and column of a problem, counted from 1; null: it has none. */
function placeOf(problem: Problem): [number, number] | null {
  const found = /:(\d+):(\d+)$/.exec(problem.where);
  return found ? [Number(found[1]), Number(found[2])] : null;
}

/** The text of a scene, judged by the program while it is written. A draft stays in this browser until it is saved. */
export function SceneEditor({ connection, path, loadProblems, onSaved }: {
  connection: Connection;
  path: string;
  loadProblems: Problem[];
  onSaved: () => void;
}) {
  const area = useRef<HTMLTextAreaElement>(null);
  const [text, setText] = useState<string | null>(null);
  const [saved, setSaved] = useState("");
  const [revision, setRevision] = useState("");
  const [checked, setChecked] = useState<Checked | null>(null);
  const [error, setError] = useState<Error | null>(null);
  const draftKey = `ctpm.draft:${path}`;

  const read = async (useDraft: boolean) => {
    setError(null);
    try {
      const file = await connection.call<{ text: string; revision: string }>("scene.read", { path });
      setSaved(file.text), setRevision(file.revision);
      const draft = useDraft ? localStorage.getItem(draftKey) : null;
      if (!useDraft) localStorage.removeItem(draftKey);
      setText(draft ?? file.text);
    } catch (failure) {
      setError(failure as Error);
    }
  };
  useEffect(() => void read(true), [path]);

  useEffect(() => {
    if (text === null) return;
    if (text === saved) localStorage.removeItem(draftKey);
    else localStorage.setItem(draftKey, text);
    const timer = setTimeout(() => {
      connection.call<Checked>("scene.check", { path, text }).then(setChecked, setError);
    }, kCheckAfter);
    return () => clearTimeout(timer);
  }, [text, saved]);

  const save = async () => {
    if (text === null || text === saved) return;
    setError(null);
    try {
      const written = await connection.call<{ revision: string }>("scene.write", { path, text, revision });
      setRevision(written.revision), setSaved(text);
      onSaved();
    } catch (failure) {
      setError(failure as Error);
    }
  };
  const go = (place: [number, number]) => {
    const target = area.current;
    if (!target) return;
    const lines = target.value.split("\n");
    const at = lines.slice(0, place[0] - 1).reduce((sum, line) => sum + line.length + 1, 0) + place[1] - 1;
    target.focus();
    target.setSelectionRange(at, at + 1);
    target.scrollTop = Math.max(0, (place[0] - 6) * (target.scrollHeight / lines.length));
  };
  const list = (problems: Problem[], kind: string) => problems.map((problem, i) => {
    const place = placeOf(problem);
    return (
      <li key={`${kind}${i}`}>
        <button type="button" class={kind} disabled={!place} onClick={() => place && go(place)}>
          {place && <span class="number">{place[0]}:{place[1]}</span>} {problem.message}{problem.hint && ` (${problem.hint})`}
        </button>
      </li>
    );
  });
  const isChanged = text !== null && text !== saved;
  return (
    <Section title="Text" aside={isChanged && <small> not saved; a draft is kept here</small>}>
      <textarea ref={area} class="code" rows={24} spellcheck={false} aria-label={`The text of ${path}`} value={text ?? ""}
        onInput={(e) => setText(e.currentTarget.value)}
        onKeyDown={(e) => {
          if (e.key === "s" && (e.ctrlKey || e.metaKey)) e.preventDefault(), void save();
        }} />
      <div class="buttons">
        <button type="button" class="main" disabled={!isChanged} onClick={() => void save()}>Save</button>
        <button type="button" disabled={!isChanged} onClick={() => void read(false)}>Drop changes</button>
      </div>
      <Problems error={error} />
      <div role="status">
        {checked && checked.errors.length === 0 && <p class="good">No errors in the text.</p>}
        <ul class="jumps">{checked && list(checked.errors, "error")}{checked && list(checked.warnings, "remark")}</ul>
        {!isChanged && loadProblems.map((problem, i) => <p key={i} class="warning">{problemText(problem)}</p>)}
      </div>
    </Section>
  );
}
