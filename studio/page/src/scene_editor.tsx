import { useEffect, useRef } from "preact/hooks";
import type { AuthorScene } from "./author_scene";
import type { Item } from "./items";
import { placeOf } from "./json_editor";
import type { Problem } from "./protocol";

/** The thing whose path a message begins with. */
function thingOf({ message }: Problem, items: Item[]): Item | undefined {
  const [, path] = /^\/(\S+?):? /.exec(message) ?? [];
  return path === undefined ? undefined : items.filter(({ key }) => path === key || path.startsWith(`${key}/`)).sort((a, b) => b.key.length - a.key.length)[0];
}

/** The text of a scene, judged by the program while it is written. */
export function SceneEditor({ scene, onSelect }: { scene: AuthorScene; onSelect: (key: string) => void }) {
  const frame = useRef<HTMLDivElement>(null);
  const { doc } = scene;
  useEffect(() => {
    if (!doc || !frame.current) return;
    frame.current.append(doc.host);
    doc.view.requestMeasure();
    return () => doc.host.remove();
  }, [doc]);
  const { errors, warnings } = scene.problems;
  const list = (problems: Problem[], kind: string) => problems.map((problem, i) => {
    const place = placeOf(problem), thing = thingOf(problem, scene.items);
    return (
      <li key={`${kind}${i}`}>
        <button type="button" class={kind} disabled={!place} onClick={() => doc?.goToProblem(problem)}>
          {place && <span class="number">{place.line}:{place.column}</span>} {problem.message}{problem.hint && ` (${problem.hint})`}
        </button>
        {thing && <button type="button" class="quiet" title="Choose it" onClick={() => onSelect(thing.key)}>{thing.name}</button>}
      </li>
    );
  });
  return (
    <section class="text" aria-label="The scene's text">
      <div class="editor-frame" ref={frame} />
      <div class="problem-list" role="status"><ul class="jumps">{list(errors, "error")}{list(warnings, "remark")}</ul></div>
    </section>
  );
}
