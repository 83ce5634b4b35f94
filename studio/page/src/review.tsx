import type { ComponentChildren } from "preact";
import { useCallback, useEffect, useMemo, useRef, useState } from "preact/hooks";
import type { Connection } from "./connection";
import { Compare, knownComparison } from "./compare";
import { drawInto, sizeOf, watchSize } from "./drawing";
import { ExpertLegend } from "./expert_line";
import { ExportForm, useExport } from "./export_form";
import { freeCamera, isFree, kPlainLook, type Look, lookText, mirrored, planeOf } from "./look";
import { LegendBar, LookFields } from "./look_fields";
import { marksOf } from "./marks";
import { NotesPanel, useNotes } from "./notes";
import { Moment } from "./moment";
import { Panel } from "./panel";
import { Empty, Problems } from "./parts";
import type { Place } from "./place";
import { Player, type Track } from "./player";
import type { ComparisonResult, Legend, Listing } from "./protocol";
import { StillForm } from "./still_form";
import { Clocks, ownTime } from "./time_axis";
import { Timeline } from "./timeline";
import { bytes } from "./text";
import { kTurns, Viewer } from "./viewer";

const kSpeeds = [0.1, 0.25, 0.5, 1, 2, 4];
const kPanels = ["moment", "compare", "notes", "export"] as const;
type PanelName = (typeof kPanels)[number];

export function Review({ connection, listing, place, onPlace }: {
  connection: Connection;
  listing: Listing;
  place: Place;
  onPlace: (place: Place) => void;
}) {
  const canvas = useRef<HTMLCanvasElement>(null), drawn = [useRef<HTMLCanvasElement>(null), useRef<HTMLCanvasElement>(null)];
  const [player, setPlayer] = useState<Player | null>(null);
  const [, setTick] = useState(0);
  const [version, setVersion] = useState(0);
  const [error, setError] = useState<Error | null>(null); // of what is seen: the next picture is without it
  const [unopened, setUnopened] = useState<{ path: string; error: Error } | null>(null); // said until another session is chosen
  const [panel, setPanel] = useState<PanelName>("moment");
  const [comparison, setComparison] = useState<ComparisonResult | null>(null);
  const [look, setLook] = useState<Look>(place.look ?? kPlainLook);
  const exporting = useExport(connection); // goes on while another tab or session is looked at
  const turned = useRef<string | null>(null); // camera to which a hand has turned the view, until another one is chosen
  const [hasExpertLine, showExpertLine] = useState(true); // on the trainee's organ
  const newest = useRef(look);
  newest.current = look;
  const [legend, setLegend] = useState<Legend | null>(null);

  useEffect(() => {
    if (!canvas.current) return;
    const viewer = new Viewer(canvas.current);
    const made = new Player(connection, viewer);
    made.onFailure = setError;
    made.onChange = () => setVersion((v) => v + 1);
    made.onDrawing = (stage, drawing) => drawn[stage].current && drawInto(drawn[stage].current!, drawing);
    let wanted = false;
    made.onTime = () => {
      if (wanted) return;
      wanted = true;
      setTimeout(() => {
        wanted = false;
        setTick((t) => t + 1);
      }, 50);
    };
    connection.onEvent("stage_failed", (content) => {
      const { stage, errors } = content as { stage: number; errors: { message: string }[] };
      if (!made.tracks.has(stage)) return; // of a session that was closed meanwhile
      setError(new Error(errors.map((e) => e.message).join("\n")));
    });
    setPlayer(made);
    const stopWatching = watchSize(canvas.current, () => setVersion((v) => v + 1));
    return () => {
      stopWatching();
      made.pause();
      for (const stage of [1, 0]) made.close(stage);
      viewer.dispose();
    };
  }, [connection]);

  const openAt = useCallback(async (there: Place) => {
    if (!player) return;
    setError(null), setUnopened(null);
    setComparison(null);
    // A view that a hand has turned is one of the session before.
    turned.current = null;
    setLook((now) => there.look ?? (isFree(now) ? { ...now, camera: "" } : now));
    if (there.align === "path") setPanel("compare"); // which compares them
    try {
      await player.openAt(there);
    } catch (failure) {
      const isBeside = player.tracks.has(0);
      setUnopened({ path: (isBeside ? there.beside : there.session) ?? "", error: failure as Error });
      if (!isBeside) onPlace({}); // a link leads to what is shown
    }
  }, [player]);
  /** The session beside; undefined: none. */
  const openBeside = useCallback(async (path: string | undefined) => {
    if (!player) return;
    setError(null), setUnopened(null);
    setComparison(null);
    try {
      if (path !== undefined) await player.openBeside(path);
      else {
        player.close(1);
        player.setOffset(0);
      }
    } catch (failure) {
      setUnopened({ path: path!, error: failure as Error });
    }
  }, [player]);

  /** The trainee's session becomes the expert's, at the same moment of both. */
  const swap = async () => {
    if (!player || !first || !second) return;
    const [expert, trainee] = [first, second].map(({ session }) => session.path), { aligned } = player;
    const beside = player.timeOf(1), ahead = beside - player.time;
    await openAt({ session: trainee, beside: expert, ahead: -ahead, align: aligned === "path" ? undefined : aligned || undefined, time: beside, look });
  };

  // The address names a session and a moment: a link leads there.
  useEffect(() => {
    if (!player || !place.session || player.tracks.get(0)?.session.path === place.session) return;
    void openAt(place);
    if (place.comparison) setComparison(place.comparison), setPanel("compare");
  }, [player]);

  const first = player?.tracks.get(0), second = player?.tracks.get(1);
  // Who comes back finds what was compared.
  useEffect(() => {
    if (!first || !second || comparison) return;
    let isWanted = true;
    void knownComparison(connection, first.session.path, second.session.path).then((known) => isWanted && known && setComparison(known));
    return () => void (isWanted = false);
  }, [first?.session.path, second?.session.path]);
  const notes = useNotes(connection, [...(player?.tracks.values() ?? [])].map(({ session }) => session.path), panel === "notes");
  const frame = first?.scene.frame ?? null, other = second?.scene.frame ?? null;

  // The program says from where it is seen, unless a hand has turned the view.
  const size = canvas.current && player ? sizeOf(canvas.current, player.tracks.size) : "";
  useEffect(() => {
    if (!player || !first) return;
    player.hasExpertLine = hasExpertLine;
    player.see(look, size, (seen, as) => {
      setError(null);
      setLegend(seen.title ? seen : null);
      // A hand may have turned it meanwhile, or a camera was chosen.
      if (turned.current === null && as.camera === newest.current.camera) player.viewer.look(seen.camera);
      setVersion((v) => v + 1); // what an export sees
    }).catch(setError);
  }, [player, first, second, look, size, hasExpertLine]);
  useEffect(() => {
    if (!player || !first) return;
    const { viewer } = player;
    viewer.onTurn = () => {
      const camera = (turned.current = freeCamera(viewer.seen(), first.session.view.up));
      setLook((now) => ({ ...now, camera }));
    };
  }, [player, first]);
  const chooseLook = (to: Look) => {
    if (to.camera !== turned.current) turned.current = null;
    setLook(to);
  };
  const otherSide = () => {
    const plane = first && planeOf(look, first.session.view);
    if (!player || !plane) return;
    player.viewer.look(mirrored(player.viewer.seen(), plane.axis));
    player.viewer.onTurn();
  };

  useEffect(() => {
    if (!player || !first) return;
    // A browser may take 10 ms for a new address, and pictures wait for that: it is written once a moment stays.
    let shown = "", written = "";
    const timer = setInterval(() => {
      const { place } = player, before = shown;
      shown = JSON.stringify(place);
      if (player.isPlaying || player.isWaiting || shown !== before || shown === written) return;
      onPlace(place);
      written = shown;
    }, 300);
    return () => clearInterval(timer);
  }, [player, first, second]);

  useEffect(() => {
    if (!player) return;
    const press = (event: KeyboardEvent) => {
      const target = event.target as HTMLElement;
      if (target.closest("input:not([type=range]), textarea, select") || event.ctrlKey || event.metaKey || event.altKey) return;
      const by = event.shiftKey ? 0.1 : 0.01;
      if (event.key === " " && !target.closest("button")) player.isPlaying ? player.pause() : player.play();
      else if (event.key === "ArrowLeft") player.pause(), player.move(player.time - by);
      else if (event.key === "ArrowRight") player.pause(), player.move(player.time + by);
      else if (event.key === "Home") player.move(player.span.from);
      else if (event.key === "End") player.move(player.span.to);
      else if (event.key === "n") setPanel("notes");
      else if (event.key in kTurns) player.viewer.turn(...kTurns[event.key]);
      else return;
      event.preventDefault();
    };
    addEventListener("keydown", press);
    return () => removeEventListener("keydown", press);
  }, [player]);

  const marks = useMemo(() => (first ? marksOf(player!, notes.all, comparison) : []), [first, second, notes.all, comparison, version]);

  const contentOf = (shown: Player, { session }: Track): Record<PanelName, ComponentChildren> => ({
    moment: <Moment connection={connection} player={shown} frame={frame} other={other} />,
    compare: (
      <Compare connection={connection} player={shown} listing={listing} comparison={comparison} onComparison={setComparison}
        onBeside={openBeside} onSwap={() => void swap()} />
    ),
    notes: <NotesPanel player={shown} notes={notes} />,
    export: (
      <>
        <StillForm key={`still ${session.path} ${second?.session.path ?? ""}`} connection={connection} player={shown} look={look} />
        <ExportForm key={session.path} connection={connection} player={shown} look={look} comparison={comparison} job={exporting} />
      </>
    ),
  });

  return (
    <div class="room review">
      <nav class="list" aria-label="Sessions">
        <h2>Sessions</h2>
        {listing.sessions.length === 0 && <p class="hint">No session in this folder yet. Record one in Train, or with <code>ctpm record</code>.</p>}
        <ul>
          {listing.sessions.map((entry) => (
            <li key={entry.path}>
              <button type="button" aria-current={first?.session.path === entry.path} title={entry.path} onClick={() => void openAt({ session: entry.path })}>
                <span>{entry.path.replace(/\.ctpm$/, "")}</span>
                <small>{bytes(entry.bytes)}</small>
              </button>
            </li>
          ))}
        </ul>
      </nav>
      <div class="view">
        <canvas ref={canvas} aria-label={first ? `The scene ${first.session.view.name}` : "No scene"} tabIndex={0} />
        <div class={second ? "drawings halves" : "drawings"} aria-hidden="true">
          <canvas ref={drawn[0]} hidden />
          {second && <canvas ref={drawn[1]} hidden />}
        </div>
        {!first && (
          <Empty title={unopened ? `${unopened.path} cannot be shown` : "Choose a session"}>
            <p>{unopened && "Choose another session. "}Its force, depth and speed appear below; any moment is a press away.</p>
          </Empty>
        )}
        {first && (
          <div class="captions">
            <span class="first"><b>{second && "expert: "}{first.session.path}{second && ` ${ownTime(player!, 0)}`}</b></span>
            {second && <span class="second"><b>trainee: {second.session.path} {ownTime(player!, 1)}</b></span>}
          </div>
        )}
        {second && player!.otherScene && (
          <div class="other-scene" role="alert">
            <b>Different scenes: they cannot be compared.</b> {player!.otherScene}.
          </div>
        )}
        {first && legend && <LegendBar legend={legend} />}
        {second && <ExpertLegend marks={second.scene.expert} />}
        {first && (
          <div class="look-bar">
            <LookFields look={look} onLook={chooseLook} onOtherSide={otherSide} view={first.session.view}>
              {second && !player!.otherScene && (
                <label><input type="checkbox" checked={hasExpertLine} onChange={(e) => showExpertLine(e.currentTarget.checked)} /> expert's line</label>
              )}
            </LookFields>
          </div>
        )}
        {player?.isDrawing && !error && <p class="busy drawing" role="status">drawing: {lookText(player.look)} …</p>}
        {player?.isPlaying && player.reached < 0.9 * player.speed && (
          <p class="busy pace">plays at {player.reached.toFixed(2)} ×: this machine simulates no faster</p>
        )}
        <Problems error={unopened?.error ?? error} onClose={unopened && first ? () => setUnopened(null) : undefined} />
      </div>
      <div class="time">
        {player && first && (
          <>
            <div class="transport">
              <button type="button" class="main" onClick={() => (player.isPlaying ? player.pause() : player.play())}>
                {player.isPlaying ? "Pause" : "Play"}
              </button>
              <label>
                speed
                <select value={player.speed} onChange={(e) => {
                  player.speed = Number(e.currentTarget.value);
                  setVersion((v) => v + 1);
                }}>
                  {kSpeeds.map((speed) => <option key={speed} value={speed}>{speed} ×</option>)}
                </select>
              </label>
              <Clocks player={player} />
            </div>
            <Timeline player={player} marks={marks} version={version} />
          </>
        )}
      </div>
      <aside class="side">
        {player && first ? (
          <>
            <div class="tabs" role="tablist" aria-label="Panels">
              {kPanels.map((name) => (
                <button key={name} type="button" role="tab" id={`tab-${name}`} aria-selected={panel === name} aria-controls="panel"
                  onClick={() => setPanel(name)}>{name}</button>
              ))}
            </div>
            {kPanels.map((name) => <Panel key={name} name={name} isShown={panel === name} version={version}>{contentOf(player, first)[name]}</Panel>)}
          </>
        ) : (
          <p class="hint">Space plays, ← and → move by 10 ms, with Shift by 100 ms. The mouse turns the view and its wheel comes closer; so do A, D, W, S, + and −. Comma and full stop zoom the timeline, 0 shows all of it.</p>
        )}
      </aside>
    </div>
  );
}
