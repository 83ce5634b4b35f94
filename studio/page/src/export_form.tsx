import type { JSX } from "preact";
import { useEffect, useState } from "preact/hooks";
import { faultText } from "./compare";
import type { Connection } from "./connection";
import { download } from "./download";
import { NumberInput } from "./fields";
import { asSeen, isFree, type Look, lookParameters, lookWords } from "./look";
import { Problems, Section, ShownCommand, useRedraw, Working } from "./parts";
import type { Player } from "./player";
import type { ComparisonResult } from "./protocol";
import { bytes, command, newtons, seconds, whyNot } from "./text";
import { alignedText } from "./time_axis";
import { valueAt } from "./timeline";

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

/** Choices of the command; the first is its default. */
const kSizes = ["1280x720", "1920x1080", "854x480", "1080x1080", "720x1280"];
const kOverlays: [string, string][] = [["full", "full"], ["small", "small"], ["none", "none"]];
const kAligned: [string, string][] = [["path", "path of the tool, slowing one down"], ["contact", "first contact, slowing one down"], ["cut", "first cut, slowing one down"], ["clock", "both clocks, as they were recorded"]];
/** How the command brings both together as they are seen here: at an event the page moves one of them, which the command says in
    seconds, by which the clock of the second one shows more: the trainee's, or that of a ghost, which is the expert's. */
export const seenAlign = (player: Player, isGhost: boolean) => player.path ? "path" : player.offset === 0 ? "clock" : String(Number((isGhost ? -player.offset : player.offset).toFixed(6)));
const kNoMoment = { name: "", fault: "" };
const kNear = 2e-3; // of two times that are one moment [s]
const kSlow: [string, string][] = [["cut", "cuts"], ["damage", "damage"], ["worst", "largest force and depth"]];

/** What a film is called unless something else is chosen: beside the session, a trainee's beside an expert's or with its ghost after
    both; around a moment, with that. */
export function filmName(path: string, beside: string | undefined, how: "beside" | "ghost", moment: string, kind = "mp4"): string {
  const stem = (file: string) => file.replace(/\.ctpm$/, "");
  return `${beside === undefined ? stem(path) : `${stem(beside)}-${how}-${stem(path).replace(/^.*\//, "")}`}${moment}.${kind}`;
}

/** What a film around this moment is to say of a pair's trainee: the worst moment that it is in, else both forces. Empty: nothing. */
function faultAt(player: Player, comparison: ComparisonResult | null): string {
  if (!player.tracks.has(1) || player.otherScene) return "";
  const time = player.timeOf(1), far = ({ worst_s }: { worst_s: number }) => Math.abs(worst_s - time);
  const [moment] = (comparison?.comparison.moments ?? []).filter((one) => far(one) < kNear || (one.from_s <= time && time <= one.to_s))
    .sort((a, b) => far(a) - far(b));
  if (moment) return faultText(moment);
  const [expert, trainee] = [0, 1].map((stage) => {
    const data = player.tracks.get(stage)?.timeline;
    return data ? valueAt(data.force_n, data.duration_s, player.timeOf(stage)) : null;
  });
  return expert !== null && trainee !== null ? `force ${newtons(trainee)}, expert ${newtons(expert)}` : "";
}

/** An export that goes on, or is done: also while another tab, session or room is looked at. */
export class ExportJob {
  onChange: () => void = () => {};
  progress: [number, number] | null = null; // null: none goes on
  result: Exported | null = null;
  error: Error | null = null;
  isStopped = false; // by hand
  private stop = new AbortController();

  constructor(private readonly connection: Connection) {}

  async start(params: object): Promise<void> {
    const { signal } = (this.stop = new AbortController());
    this.change({ error: null, isStopped: false, result: null, progress: [0, 1] });
    try {
      const result = await this.connection.call<Exported>("session.export", params, { signal, progress: (done, total) => this.change({ progress: [done, total] }) });
      this.change({ result, progress: null });
    } catch (failure) {
      this.change({ progress: null, ...(signal.aborted ? { isStopped: true } : { error: failure as Error }) });
    }
  }
  cancel = (): void => this.stop.abort();
  fail = (error: Error): void => this.change({ error });

  private change(to: Partial<Pick<ExportJob, "progress" | "result" | "error" | "isStopped">>): void {
    Object.assign(this, to);
    this.onChange();
  }
}
const jobs = new WeakMap<Connection, ExportJob>();

/** The export of a connection, while a room shows it. */
export function useExport(connection: Connection): ExportJob {
  const redraw = useRedraw(), job = jobs.get(connection) ?? new ExportJob(connection);
  jobs.set(connection, job);
  useEffect(() => {
    job.onChange = redraw;
    return () => void (job.onChange = () => {});
  }, [job]);
  return job;
}

/** A video of what is seen. */
export function ExportForm({ connection, player, look, comparison, job }: {
  connection: Connection;
  player: Player;
  look: Look;
  comparison: ComparisonResult | null;
  job: ExportJob;
}) {
  const { progress, result, error, isStopped, cancel, fail } = job, { session } = player.tracks.get(0)!;
  const beside = player.tracks.get(1)?.session.path;
  const [isGhostWanted, setGhost] = useState(false);
  const canGhost = !!beside && !player.otherScene, isGhost = canGhost && isGhostWanted; // the expert's in the trainee's session
  const [chosenOutput, setOutput] = useState<string | null>(null), [caption, setCaption] = useState("");
  const [moment, setMoment] = useState(kNoMoment); // that the film is around
  const [from, setFrom] = useState("0"), [to, setTo] = useState("");
  const [speed, setSpeed] = useState("1"), [fps, setFps] = useState("30");
  const [size, setSize] = useState(kSizes[0]), [overlay, setOverlay] = useState("full"), [chosenAlign, setAlign] = useState("seen");
  const [isAsSeen, setAsSeen] = useState(true);
  const [slow, setSlow] = useState<string[]>([]), [isDifferentShown, showDifferent] = useState(false);

  const wanted = chosenOutput ?? filmName(session.path, beside, isGhost ? "ghost" : "beside", moment.name);
  const [unused, setUnused] = useState({ by: "", name: "" }); // what is wanted, and what it may be called
  useEffect(() => {
    if (progress) return;
    let isWanted = true;
    connection.call<{ path: string }>("session.export_name", { path: wanted }).then(({ path }) => isWanted && setUnused({ by: wanted, name: path }), () => {}); // an export says why
    return () => void (isWanted = false);
  }, [wanted, progress === null]);
  useEffect(() => {
    if (result?.path === chosenOutput) setOutput(null);
  }, [result]);
  const isKnown = unused.by === wanted, output = chosenOutput ?? (isKnown ? unused.name : wanted), isTaken = isKnown && unused.name !== output;
  const align = chosenAlign === "seen" ? seenAlign(player, isGhost) : chosenAlign;
  const filmed = isAsSeen ? asSeen(look, player.viewer.seen(), session.view.up) : { ...look, camera: "" };
  const slowAt = beside ? "" : slow.join(",");
  const both = isGhost ? { path: beside!, ghost: session.path } : { path: session.path, beside };
  const hasLine = canGhost ? player.hasExpertLine : true;
  const params = {
    ...both, expert_line: hasLine ? undefined : false, output, from_s: number(from), to_s: number(to), speed: number(speed), fps: number(fps), size, overlay,
    align: beside && align, slow_at: slowAt || undefined, caption: caption.trim() || undefined, allow_diverged: isDifferentShown, ...lookParameters(filmed),
  };
  const clock = player.tracks.get(isGhost ? 1 : 0)!, time = player.timeOf(clock.stage); // of the session by whose clock the times are
  const end = Math.floor(100 * clock.session.info.duration_s) / 100; // one that is rounded up is after the session
  const isThere = time > -1e-3 && time < clock.session.info.duration_s + 1e-3; // by its clock
  const around = () => {
    setFrom(Math.max(0, Math.min(time, end) - 1).toFixed(2));
    setTo(Math.min(end, time + 1).toFixed(2));
    goTo({ name: `-${Math.max(0, player.timeOf(beside ? 1 : 0)).toFixed(2)}s`, fault: faultAt(player, comparison) });
  };
  /** A caption that nobody has written is that of the moment. */
  const goTo = (to: typeof moment) => {
    if (caption === moment.fault) setCaption(to.fault);
    setMoment(to);
  };
  /** Times that were chosen are the same moments by the other clock. */
  const changeGhost = (on: boolean) => {
    const inIt = (text: string) => (number(text) ? Math.max(0, on ? player.besideAt(number(text)!) : player.firstAt(number(text)!)).toFixed(2) : text);
    setFrom(inIt(from)), setTo(inIt(to)), setGhost(on);
  };
  useEffect(() => goTo(kNoMoment), [beside]);
  const words = (flag: string, value: string, usual: string) => (value !== usual && value !== "" ? [flag, value] : []);
  const shown = command("export", both.path, "-o", output, ...(isGhost ? ["--ghost", session.path] : beside ? ["--beside", beside] : []),
    ...(beside ? ["--align", align] : []), ...(hasLine ? [] : ["--no-expert-line"]),
    ...(number(from) ? ["--from-s", from] : []), ...words("--to-s", to, ""), ...words("--speed", speed, "1"), ...words("--fps", fps, "30"),
    ...words("--size", size, kSizes[0]), ...words("--overlay", overlay, "full"), ...words("--slow-at", slowAt, ""), ...words("--caption", caption.trim(), ""),
    ...(isDifferentShown ? ["--allow-diverged"] : []), ...lookWords(filmed));
  const wrong = [
    whyNot("The first moment", from, 0, Infinity, "s"), whyNot("The last moment", to, Math.max(0, number(from) ?? 0), Infinity, "s"),
    whyNot("Times real speed", speed, 0.001, 1000), whyNot("Pictures", fps, 1, 240, "a second"),
  ].filter(Boolean);
  const field = (label: string, value: string, set: (value: string) => void, isNumber = false) => {
    const Input = isNumber ? NumberInput : "input";
    return (
      <label class="field">
        <span>{label}</span>
        <Input step="any" value={value} onInput={(e: JSX.TargetedInputEvent<HTMLInputElement>) => set(e.currentTarget.value)} />
      </label>
    );
  };
  const choice = (label: string, value: string, set: (value: string) => void, options: [string, string][]) => (
    <label class="field">
      <span>{label}</span>
      <select value={value} onChange={(e) => set(e.currentTarget.value)}>
        {options.map(([key, name]) => <option key={key} value={key}>{name}</option>)}
      </select>
    </label>
  );
  const tick = (label: string, isOn: boolean, set: (on: boolean) => void) => (
    <label class="tick"><input type="checkbox" checked={isOn} onChange={(e) => set(e.currentTarget.checked)} /> {label}</label>
  );
  return (
    <Section title="Video">
      <p class="hint">View and cutaway are those below the picture.</p>
      {field("file in the folder: .mp4, .avi", output, setOutput)}
      {isTaken && <p class="warning">{output} exists already; {unused.name} does not.</p>}
      <div class="pair">
        {field("from [s]", from, (text) => (setFrom(text), goTo(kNoMoment)), true)}
        {field("to [s]", to, (text) => (setTo(text), goTo(kNoMoment)), true)}
      </div>
      <button type="button" disabled={!isThere} onClick={around}>1 s before {seconds(time, 2)} to 1 s after</button>
      {!isThere && <p class="hint">At this moment the {beside && isGhost ? "trainee" : "first session"} has not begun, or has ended. Another alignment brings both together{beside && !isGhost ? "; so does the expert as a ghost" : ""}.</p>}
      {beside && <p class="hint">These times are by the {isGhost ? "trainee" : "expert"}'s clock.</p>}
      <div class="pair">
        {field("times real speed", speed, setSpeed, true)}
        {field("pictures a second", fps, setFps, true)}
      </div>
      {beside ? (
        <>
          {canGhost && tick(`ghost: ${session.path}, whose tool is shown through in the picture, and its way`, isGhost, changeGhost)}
          {choice("bring both together", chosenAlign, setAlign, [["seen", `as seen here: ${alignedText(player)}`], ...kAligned])}
          {!isGhost && <p class="hint">As seen here, each goes at its own pace. What slows one down, the half that is ahead, shows other moments beside each other than are seen here.</p>}
        </>
      ) : (
        <fieldset>
          <legend>four times slower at</legend>
          {kSlow.map(([key, name]) => tick(name, slow.includes(key), (on) => setSlow(kSlow.map(([k]) => k).filter((k) => (k === key ? on : slow.includes(k))))))}
        </fieldset>
      )}
      {choice("camera", isAsSeen ? "seen" : "", (chosen) => setAsSeen(chosen === "seen"), [
        ["seen", look.camera && !isFree(look) ? `what is seen here: ${look.camera}` : "what is seen here"],
        ["", "automatic: sees the wound or the press"],
      ])}
      <div class="pair">
        {choice("size", size, setSize, kSizes.map((s): [string, string] => [s, s.replace("x", " × ")]))}
        {choice("overlay", overlay, setOverlay, kOverlays)}
      </div>
      {field(beside && !isGhost ? "caption, in the trainee's half in place of what happens" : "caption, in place of what happens", caption, setCaption)}
      <p class="hint">{caption.trim() ? "The caption stands" : "What happens is told"} in the picture unless the overlay is none, and in an .mp4 as subtitles and chapters too.</p>
      {session.info.physics_remark && tick("even if the replay differs, marked on every frame", isDifferentShown, showDifferent)}
      <ShownCommand text={shown} />
      <div class="always-seen">
        {progress ? <Working what="exporting" done={progress[0]} total={progress[1]} onCancel={cancel} />
          : <button type="button" class="main" disabled={!output || isTaken || wrong.length > 0} onClick={() => void job.start(params)}>Export</button>}
        {wrong.map((why) => <p key={why} class="warning" role="status">{why}.</p>)}
        {isStopped && <p class="hint" role="status">Stopped; nothing was written.</p>}
        <Problems error={error} />
        {result && (
          <p class="good" role="status">{result.path}: {result.frames} frames, {result.codec}, {bytes(result.bytes)}, in {seconds(result.elapsed_s, 1)}; replay {result.same_as_recorded ? "same as recorded" : "DIFFERS"}{result.note && `; ${result.note}`}</p>
        )}
        {result && <button type="button" onClick={() => download(connection, result.path).catch(fail)}>Download {result.path.replace(/^.*\//, "")}</button>}
      </div>
    </Section>
  );
}
