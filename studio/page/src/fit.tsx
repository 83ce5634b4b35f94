// The stiffness of an organ, fitted for the spheres that it has now.
import { useEffect, useRef, useState } from "preact/hooks";
import type { AuthorScene } from "./author_scene";
import type { Connection } from "./connection";
import { differences, findJson, parseJson } from "./json_edit";
import { Problems, ShownCommand, Working } from "./parts";
import { command, millimetres, newtons } from "./text";

interface Fitted {
  text: string; // of the scene
  stiffness_scale: number;
  is_of_table: boolean;
  rows: { depth_m: number; force_n: number; scatter: number; closed_form_n: number; error: number }[];
}

/** Fits as the command does, into the text: one step of its history. */
export function Fit({ connection, scene, organ, name, radius }: {
  connection: Connection;
  scene: AuthorScene;
  organ: number; // its place in the list
  name: string;
  radius: number; // of its spheres [mm]
}) {
  const [result, setResult] = useState<{ fitted: Fitted; material: string } | null>(null);
  const [progress, setProgress] = useState<[number, number] | null>(null);
  const [error, setError] = useState<Error | null>(null);
  const stop = useRef(new AbortController());
  const doc = scene.doc!, path = ["organs", organ];
  useEffect(() => () => stop.current.abort(), [doc]);
  const fitted = findJson(doc.lastValue, [...path, "material", "fitted_for", "sphere_radius_mm"]);
  const materialNow = () => JSON.stringify(findJson(doc.value, [...path, "material"]));

  const fit = async () => {
    const { text } = doc, before = findJson(parseJson(text), path), { signal } = (stop.current = new AbortController());
    setError(null), setResult(null), setProgress([0, 1]);
    try {
      const made = await connection.call<Fitted>("scene.fit", { path: doc.path, text, organ: name }, { progress: (done, total) => setProgress([done, total]), signal });
      if (signal.aborted) return setProgress(null);
      if (JSON.stringify(findJson(doc.value, path)) !== JSON.stringify(before)) throw new Error(`${name} was changed while it was fitted, so that the fit is none of it: fit it again.`);
      doc.set(differences(before, findJson(parseJson(made.text), path), path));
      setResult({ fitted: made, material: materialNow() });
    } catch (failure) {
      if (!signal.aborted) setError(failure as Error);
    }
    setProgress(null);
  };
  return (
    <>
      {fitted === undefined ? <p class="hint">Its stiffness is not fitted: what the preset says of tissue is not yet what these spheres do.</p>
        : fitted !== radius && <p class="warning">The stiffness was fitted with spheres of {String(fitted)} mm, and is another one with these.</p>}
      {progress ? <Working what="fitting" done={progress[0]} total={progress[1]} onCancel={() => stop.current.abort()} /> : fitted !== radius && (
        <>
          <div class="buttons"><button type="button" disabled={!scene.shown} title="Until the paper's ball meets the same force at 12 mm as in its Table 1" onClick={() => void fit()}>Fit the stiffness</button></div>
          <ShownCommand text={command("fit", doc.path, "--organ", name, "--write")} />
        </>
      )}
      <Problems error={error} />
      {result && result.material === materialNow() && <FitResult result={result.fitted} />}
    </>
  );
}

function FitResult({ result: { stiffness_scale: scale, is_of_table: isOfTable, rows } }: { result: Fitted }) {
  const percent = (share: number) => `${(100 * share).toFixed(1).replace("-0.0", "0.0")} %`;
  return (
    <>
      <p class="good" role="status">Stiffness scale {Number(scale.toPrecision(6))}, fitted at 12 mm.</p>
      <table class="fitted">
        <thead><tr><th scope="col">depth</th><th scope="col">force</th><th scope="col">scatter</th><th scope="col">{isOfTable ? "Table 1" : "closed form"}</th><th scope="col">error</th></tr></thead>
        <tbody>
          {rows.map((row) => (
            <tr key={row.depth_m}>
              <th scope="row">{millimetres(row.depth_m, 0)}</th><td>{newtons(row.force_n)}</td><td>{percent(row.scatter)}</td><td>{newtons(row.closed_form_n)}</td><td>{percent(row.error)}</td>
            </tr>
          ))}
        </tbody>
      </table>
      <p class="hint">The other depths show how the shape of the curve differs.{!isOfTable && " The paper has no forces of this material: the closed form is that of its five spheres with these moduli."}</p>
    </>
  );
}
