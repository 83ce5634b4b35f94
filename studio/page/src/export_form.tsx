import { useRef, useState } from "preact/hooks";
import type { Connection } from "./connection";
import { LookFields } from "./look_fields";
import { type Look, lookParameters, lookWords } from "./look";
import { Problems, Section, ShownCommand, Working } from "./parts";
import type { Player } from "./player";
import { bytes, command, seconds } from "./text";

interface Exported {
  path: string;
  frames: number;
  bytes: number;
  codec: string;
  same_as_recorded: boolean;
  elapsed_s: number;
  note: string;
}

/** The number in a field; undefined where it is empty. */
function number(text: string): number | undefined {
  return text.trim() === "" ? undefined : Number(text);
}

/** A video of what is seen. */
export function ExportForm({ connection, player, look, onLook, onOtherSide }: {
  connection: Connection;
  player: Player;
  look: Look;
  onLook: (look: Look) => void;
  onOtherSide: () => void;
}) {
  const { session } = player.tracks.get(0)!;
  const beside = player.tracks.get(1)?.session.path;
  const [output, setOutput] = useState(() => session.path.replace(/\.ctpm$/, "") + ".mp4");
  const [from, setFrom] = useState("0"), [to, setTo] = useState("");
  const [speed, setSpeed] = useState("1");
  const [progress, setProgress] = useState<[number, number] | null>(null);
  const [result, setResult] = useState<Exported | null>(null);
  const [error, setError] = useState<Error | null>(null);
  const stop = useRef<AbortController | null>(null);

  const start = async () => {
    stop.current = new AbortController();
    setError(null), setResult(null), setProgress([0, 1]);
    const params = {
      path: session.path, beside, output, from_s: number(from), to_s: number(to), speed: number(speed),
      ...lookParameters(look),
    };
    try {
      setResult(await connection.call<Exported>("session.export", params,
        { signal: stop.current.signal, progress: (done, total) => setProgress([done, total]) }));
    } catch (failure) {
      setError(failure as Error);
    }
    setProgress(null);
  };
  const around = () => {
    setFrom(Math.max(0, player.time - 1).toFixed(2));
    setTo(Math.min(session.info.duration_s, player.time + 1).toFixed(2));
  };
  const shown = command("export", session.path, "-o", output, ...(beside ? ["--beside", beside] : []),
    ...(number(from) ? ["--from-s", from] : []), ...(number(to) !== undefined ? ["--to-s", to] : []),
    ...(number(speed) !== 1 ? ["--speed", speed] : []), ...lookWords(look));
  const field = (label: string, value: string, set: (value: string) => void, type = "text") => (
    <label class="field">
      <span>{label}</span>
      <input type={type} step="any" value={value} onInput={(e) => set(e.currentTarget.value)} />
    </label>
  );
  return (
    <Section title="Video">
      {field("file in the folder: .mp4, .avi", output, setOutput)}
      <div class="pair">
        {field("from [s]", from, setFrom, "number")}
        {field("to [s]", to, setTo, "number")}
      </div>
      <button type="button" onClick={around}>1 s around {seconds(player.time, 2)}</button>
      {field("times real speed", speed, setSpeed, "number")}
      <p class="hint">A video shows what is seen:</p>
      <LookFields look={look} onLook={onLook} onOtherSide={onOtherSide} view={session.view} />
      {progress ? <Working what="exporting" done={progress[0]} total={progress[1]} onCancel={() => stop.current?.abort()} />
        : <button type="button" class="main" disabled={!output} onClick={() => void start()}>Export</button>}
      <Problems error={error} />
      {result && (
        <p class="good" role="status">{result.path}: {result.frames} frames, {result.codec}, {bytes(result.bytes)}, in {seconds(result.elapsed_s, 1)}; replay {result.same_as_recorded ? "same as recorded" : "DIFFERS"}{result.note && `; ${result.note}`}</p>
      )}
      {beside && player.offset !== 0 && <p class="hint">A video runs both sessions from their beginnings, not aligned as here.</p>}
      <ShownCommand text={shown} />
    </Section>
  );
}
