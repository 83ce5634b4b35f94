import { useEffect, useRef } from "preact/hooks";
import type { AuthorScene } from "./author_scene";
import { placeOf } from "./json_editor";
import type { Problem } from "./protocol";

/** The text of a scene, judged by the program while it is written. */
export function SceneEditor({ scene }: { scene: AuthorScene }) {
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
    const place = placeOf(problem);
    return (
      <li key={`${kind}${i}`}>
        <button type="button" class={kind} disabled={!place} onClick={() => doc?.goToProblem(problem)}>
          {place && <span class="number">{place.line}:{place.column}</span>} {problem.message}{problem.hint && ` (${problem.hint})`}
        </button>
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
