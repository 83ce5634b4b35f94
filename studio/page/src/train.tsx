import { useCallback, useEffect, useRef, useState } from "preact/hooks";
import { Measures, Outcome } from "./compare";
import type { Connection } from "./connection";
import { DeviceForm } from "./device";
import { deviceParameters, deviceWords, storedDevice, storeDevice } from "./device_choice";
import { ExpertChoice, proposedExpert } from "./expert_choice";
import { Empty, HeldButton, Problems, Readings, Section, ShownCommand, Working } from "./parts";
import { type CameraView, type Comparable, type ComparisonResult, type EndedTraining, type Listing, type Motion, problemText, type SceneOfSession } from "./protocol";
import { behind, command, millimetres, newtons, seconds, tickRows, underMs } from "./text";
import type { Place } from "./place";
import { ForceSound } from "./sound";
import { kGhostAhead, Trainer } from "./trainer";
import { Viewer } from "./viewer";

/** What keys do, for hands that have none. */
const kHeld: [string, string][] = [["farther", "PageUp"], ["closer", "PageDown"], ["turn left", "q"], ["turn right", "e"], ["tip up", "w"], ["tip down", "s"]];

const kNumbers = 50, kNumbersBeside = 200; // from one reading to the next; where the processor draws pictures beside them [ms]
const kPoseWait = "From the moment when the page sent where the hand is until a tick took it";
const kForceLimit = 10; // of a scene that has none [N]

/** Moves the bar of the force with each picture: it is scaled, so that nothing is laid out anew. */
function showForce(bar: HTMLElement | null, trainer: Trainer): void {
  const force = Math.hypot(...(trainer.ownFrame?.force ?? [0]));
  bar?.style.setProperty("transform", `scaleY(${Math.min(1, force / (trainer.scene?.view.damage_force_n || kForceLimit))})`);
}

const kLabelEdge = 16; // of the picture, that a label leaves free [px]

/** Moves the ring that shows where a pointer takes the tool up; what is written below it stays in the picture. */
function placeRing(ring: HTMLElement | null, trainer: Trainer): void {
  if (!ring) return;
  const at = trainer.toolPixel;
  ring.hidden = at === null;
  if (!at) return;
  const half = (ring.firstElementChild!.clientWidth + kLabelEdge) / 2, width = ring.parentElement!.clientWidth;
  ring.style.setProperty("transform", `translate(${at.x}px, ${at.y}px)`);
  ring.style.setProperty("--aside", `${Math.max(half, Math.min(width - half, at.x)) - at.x}px`);
}

type Phase = "choose" | "loading" | "running" | "ended";

const kUsualName = "mine-1.ctpm";

const withEnding = (name: string) => (name === "" || name.endsWith(".ctpm") ? name : `${name}.ctpm`);

/** A name for a session that does not exist yet: that name, or with the next number. */
function freeName({ sessions }: Listing, name: string): string {
  const taken = new Set(sessions.map(({ path }) => path)), stem = name.replace(/(-\d+)?\.ctpm$/, "");
  for (let i = 1, free = name; ; free = `${stem}-${++i}.ctpm`) if (!taken.has(free)) return free;
}

export function Train({ connection, listing, tryScene, tryText, tryView, onReview, onAuthor, onChanged }: {
  connection: Connection;
  listing: Listing;
  tryScene: string | undefined; // at once, and nothing is recorded
  tryText: string | undefined; // of that scene, as its author has it now
  tryView: CameraView | undefined; // as its author sees it
  onReview: (place: Place) => void;
  onAuthor: () => void; // back to the scene that was tried
  onChanged: () => void;
}) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const [trainer, setTrainer] = useState<Trainer | null>(null);
  const [phase, setPhase] = useState<Phase>("choose");
  const [scene, setScene] = useState("");
  const [chosenName, setChosenName] = useState<string | null>(tryScene ? "" : null); // null: the page's; empty: nothing is recorded
  const [output, setOutput] = useState(""); // the session that is recorded; empty: none
  const [sceneKey, setSceneKey] = useState(""); // of the scene of the session that runs or has ended; empty: not known
  const [scenes, setScenes] = useState<SceneOfSession[]>([]); // of the sessions, once they are known
  const [chosenExpert, setChosenExpert] = useState<string | null>(null); // null: the page's proposal for what is recorded; empty: none
  const [device, setDevice] = useState(storedDevice), [waits, setWaits] = useState(""), [note, setNote] = useState("");
  const [ended, setEnded] = useState<EndedTraining | null>(null);
  const [error, setError] = useState<Error | null>(null);
  const [, setTick] = useState(0);
  const last = useRef<{ x: number; y: number } | null>(null);
  const [isTouch, setTouch] = useState(() => matchMedia("(pointer: coarse)").matches);
  const fingers = useRef(new Set<number>()), bar = useRef<HTMLDivElement>(null), ring = useRef<HTMLDivElement>(null);
  const loading = useRef<AbortController | null>(null);
  const sound = useRef(new ForceSound());

  useEffect(() => {
    if (!canvas.current) return;
    const viewer = new Viewer(canvas.current);
    viewer.controls.enableZoom = false;
    viewer.controls.enablePan = false;
    viewer.controls.mouseButtons = { LEFT: null, MIDDLE: null, RIGHT: 0 };
    const made = new Trainer(connection, viewer);
    let last = 0;
    const interval = viewer.isByProcessor ? kNumbersBeside : kNumbers;
    made.onFrame = () => {
      showForce(bar.current, made);
      if (performance.now() - last < interval) return;
      last = performance.now();
      setTick((t) => t + 1);
    };
    viewer.onDraw = () => placeRing(ring.current, made);
    made.onWaiting = setWaits;
    made.onNote = setNote;
    made.onFailing = (problem) => setError(new Error(`Recording fails now: ${problem}`));
    made.onEnded = (content) => {
      document.exitPointerLock?.();
      sound.current.end();
      setEnded(content);
      setPhase("ended");
      onChanged();
    };
    setTrainer(made);
    return () => {
      void made.end().catch(() => {});
      sound.current.end();
      viewer.dispose();
    };
  }, [connection]);

  /** `like`: the session before, of which this one's name differs by its number. */
  const begin = useCallback(async (path: string, like?: string) => {
    if (!trainer) return;
    setScene(path), setSceneKey(""), setError(null), setEnded(null), setWaits(""), setNote(""), setPhase("loading");
    storeDevice(device);
    loading.current = new AbortController();
    try {
      // Somebody else may have taken a name meanwhile.
      const free = like || (chosenName === null && kUsualName), name = free ? freeName(await connection.call<Listing>("folder.list"), free) : withEnding(chosenName!);
      setOutput(name);
      const begun = await trainer.begin(path, path === tryScene && !name ? tryText : undefined, name || undefined,
        path === tryScene ? undefined : deviceParameters(device), path === tryScene ? tryView : undefined, loading.current.signal);
      setSceneKey(begun.scene_key);
      setPhase("running");
      canvas.current?.focus();
    } catch (failure) {
      setError(failure as Error);
      setPhase("choose");
    }
  }, [trainer, chosenName, device, tryScene, tryText, tryView]);

  useEffect(() => {
    if (trainer && tryScene) void begin(tryScene);
  }, [trainer]);

  useEffect(() => void connection.call<SceneOfSession[]>("session.scenes").then(setScenes, () => {}), [connection, listing]);
  const expert = chosenExpert ?? (output && phase !== "choose" ? proposedExpert(scenes, sceneKey, output) : "");
  useEffect(() => {
    if (!trainer) return;
    trainer.setExpert(null);
    if (expert) connection.call<Motion>("session.motion", { path: expert, rate_hz: 60 }).then((motion) => {
      trainer.setExpert(motion);
      setTick((t) => t + 1);
    }, setError);
  }, [trainer, expert]);

  useEffect(() => {
    if (!trainer || phase !== "running") return;
    const press = (event: KeyboardEvent) => {
      if ((event.target as HTMLElement).closest("input, textarea, select") || event.ctrlKey || event.metaKey || event.altKey) return;
      const isLocked = document.pointerLockElement !== null;
      if (event.key === "Escape" && !isLocked) void trainer.end();
      else if (event.key === "Escape" || (event.key === " " && trainer.isHeld)) document.exitPointerLock?.(), trainer.letGo();
      else if (event.key === " " && !(event.target as HTMLElement).closest("button")) trainer.isHeld = true;
      else if (event.key.toLowerCase() === "m") sound.current.switch();
      else if (!trainer.press(event.key, event.shiftKey)) return;
      setTick((t) => t + 1);
      event.preventDefault();
    };
    // Whoever takes the mouse back goes elsewhere with it.
    const unlock = () => document.pointerLockElement || (trainer.letGo(), setTick((t) => t + 1));
    addEventListener("keydown", press);
    document.addEventListener("pointerlockchange", unlock);
    return () => {
      removeEventListener("keydown", press);
      document.removeEventListener("pointerlockchange", unlock);
    };
  }, [trainer, phase]);

  useEffect(() => {
    const target = canvas.current;
    if (!trainer || !target || phase !== "running") return;
    const wheel = (event: WheelEvent) => {
      if (trainer.awaited) return;
      event.preventDefault();
      trainer.moveDeep(-Math.sign(event.deltaY));
    };
    target.addEventListener("wheel", wheel, { passive: false });
    return () => target.removeEventListener("wheel", wheel);
  }, [trainer, phase]);

  // One finger moves the tool; two look around, and are not followed.
  useEffect(() => {
    const count = (event: PointerEvent) => {
      if (event.pointerType !== "touch") return;
      if (event.type === "pointerdown") fingers.current.add(event.pointerId), setTouch(true);
      else fingers.current.delete(event.pointerId);
      last.current = null;
    };
    const kinds = ["pointerdown", "pointerup", "pointercancel"] as const;
    for (const kind of kinds) addEventListener(kind, count);
    return () => kinds.forEach((kind) => removeEventListener(kind, count));
  }, []);

  const move = (event: PointerEvent) => {
    if (phase !== "running" || !trainer || trainer.awaited) return;
    // While the view is turned the tool stays, and does not follow afterwards.
    if ((event.buttons & 2) !== 0) return void (last.current = null);
    if (event.pointerType === "touch" && (event.buttons === 0 || fingers.current.size > 1)) return;
    const from = last.current;
    last.current = { x: event.clientX, y: event.clientY };
    if (!trainer.isHeld) {
      const box = canvas.current!.getBoundingClientRect();
      trainer.reach(event.clientX - box.left, event.clientY - box.top);
      if (trainer.isHeld) setTick((t) => t + 1);
    } else if (document.pointerLockElement === canvas.current) trainer.movePixels(event.movementX, event.movementY);
    else if (from) trainer.movePixels(event.clientX - from.x, event.clientY - from.y);
  };
  const leave = () => {
    last.current = null;
    trainer?.leave();
    setTick((t) => t + 1);
  };
  // The pointer's motion as it comes, not with the screen's next frame.
  const moved = useRef(move);
  moved.current = move;
  useEffect(() => {
    const target = canvas.current!, kind = "onpointerrawupdate" in target ? "pointerrawupdate" : "pointermove";
    const take = (event: Event) => moved.current(event as PointerEvent);
    target.addEventListener(kind, take);
    return () => target.removeEventListener(kind, take);
  }, []);
  const press = (event: PointerEvent) => {
    // What holds the mouse needs no looking around, and a locked pointer cannot be captured for it.
    if (phase === "running" && !trainer?.awaited && event.pointerType === "mouse" && (event.button === 0 || document.pointerLockElement)) event.stopImmediatePropagation();
    if (phase !== "running" || !trainer || trainer.awaited || event.button !== 0) return;
    trainer.isHeld = true; // wherever it is
    setTick((t) => t + 1);
    if (event.pointerType === "mouse") void Promise.resolve(canvas.current?.requestPointerLock?.()).catch(() => {});
  };

  const choose = () => {
    trainer?.clear();
    setChosenName(tryScene ? null : chosenName && freeName(listing, chosenName));
    setPhase("choose"), setEnded(null), setSceneKey("");
  };
  const frame = trainer?.scene?.frame ?? null, view = trainer?.scene?.view ?? null;
  const hands = frame?.second ? [frame, frame.second] : frame ? [frame] : [];
  const force = Math.hypot(...(trainer?.ownFrame?.force ?? [0]));
  const limit = view?.damage_force_n || kForceLimit, givesWay = trainer?.givesWay ?? null;
  sound.current.sound(force / limit);

  return (
    <div class="room train">
      <nav class="list" aria-label="Scenes">
        <h2>Scenes</h2>
        {listing.scenes.length === 0 && <p class="hint">No scene in this folder yet. Make one in Author, or with <code>ctpm import</code>.</p>}
        <ul>
          {listing.scenes.map((entry) => (
            <li key={entry.path}>
              <button type="button" aria-current={scene === entry.path} title={entry.path} disabled={phase === "running" || phase === "loading"} onClick={() => void begin(entry.path)}>
                <span>{entry.path.replace(/\.json$/, "")}</span>
              </button>
            </li>
          ))}
        </ul>
      </nav>
      <div class={`view ${phase}${trainer?.awaited ? " watched" : trainer?.isHeld ? " held" : ""}`}>
        <canvas ref={canvas} tabIndex={0} aria-label={view ? `The scene ${view.name}; arrow keys move the tool` : "No scene"}
          onPointerDown={press} onPointerLeave={leave} onContextMenu={(e) => e.preventDefault()} />
        {phase === "choose" && (
          <Empty title="Choose a scene to train in">
            <p>The tool follows the mouse. The session is recorded, and measured against an expert's when you end it.</p>
          </Empty>
        )}
        {phase === "loading" && (
          <Empty title={`Loading ${scene}`}>
            <p>Its organs are filled with spheres and settle under gravity.</p>
          </Empty>
        )}
        {phase === "running" && trainer?.awaited && !frame?.tick && (
          <Empty title={`${trainer.awaited[0].toUpperCase()}${trainer.awaited.slice(1)}`}>
            <p role="status">{waits || "The session begins with its first pose."}</p>
          </Empty>
        )}
        {phase === "running" && frame && trainer && !trainer.awaited && !trainer.isHeld && !trainer.isLedByKeys && !isTouch && (
          <div ref={ring} class="take-up" hidden aria-hidden="true"><span>{trainer.isLetGo ? "Space or a click takes it up" : "move the pointer here to take it up"}</span></div>
        )}
        {phase === "running" && frame && (
          <div class="force-bar" role="meter" aria-label="Force" aria-valuemin={0} aria-valuemax={limit} aria-valuenow={Number(force.toFixed(2))}>
            <div ref={bar} class={force > limit ? "over" : ""} />
            <output>{newtons(force)}</output>
          </div>
        )}
        {phase === "running" && givesWay && (
          <p class="busy" role="status">The hand gives way: a mouse presses {"force_n" in givesWay ? `with ${newtons(givesWay.force_n, 0)} at most` : `${millimetres(givesWay.depth_m, 0)} deep at most`}</p>
        )}
        <Problems error={error} />
      </div>
      <div class="time">
        {phase === "running" && trainer && view && (
          <div class="transport">
            <button type="button" class="main" onClick={() => void trainer.end()}>{!isTouch && <kbd>Esc</kbd>} End</button>
            {trainer.handCount > 1 && !trainer.awaited && (
              <div class="buttons" role="group" aria-label="Hand">
                {[0, 1].map((hand) => (
                  <button key={hand} type="button" aria-pressed={trainer.led === hand} onClick={() => trainer.lead(hand)}>
                    {trainer.led !== hand && <kbd>X</kbd>} {hand === 0 ? "right hand" : "left hand"}
                  </button>
                ))}
              </div>
            )}
            {!trainer.awaited && (
              <div class="buttons" role="group" aria-label="Tool">
                {view.tools.map((tool, i) => (
                  <button key={tool.name} type="button" aria-pressed={trainer.tool === i} disabled={trainer.isTaken(i)} onClick={() => {
                    trainer.setTool(i);
                    setTick((t) => t + 1);
                  }}>
                    <kbd>{i + 1}</kbd> {tool.name}
                  </button>
                ))}
              </div>
            )}
            <span class="recorded">{output ? <><i aria-hidden="true" /> records {output}</> : "not recorded"}</span>
            <output class="clock">{trainer.hasBegun ? seconds(frame?.time ?? 0, 1) : "not begun"}</output>
            {!trainer.awaited && isTouch && (
              <div class="buttons held" role="group" aria-label="Depth and turning">
                {kHeld.map(([text, key]) => <HeldButton key={key} text={text} onHeld={() => trainer.press(key, false)} />)}
              </div>
            )}
            {trainer.awaited ? <span class="hint">the device leads · mouse and wheel: look around · C: next camera</span> : <span class="hint">{trainer.hasGamepad ? "gamepad: left stick moves, triggers press and lift, right stick turns, shoulders: tool · " : ""}{isTouch ? "one finger: move · two: look around" : `mouse, arrows: move · Space: let go of the tool, or take it up · click: hold the mouse · wheel, PgUp, PgDn: depth · Q E, W S, A D: turn · right button: look · C: next camera${trainer.cameraName && ` (${trainer.cameraName})`}`}</span>}
          </div>
        )}
      </div>
      <aside class="side">
        {phase !== "running" && phase !== "ended" && (
          <Section title="Session">
            <label class="field">
              <span>record as (empty: nothing is recorded)</span>
              <input value={phase === "loading" ? output : chosenName ?? freeName(listing, kUsualName)} disabled={phase === "loading"} onInput={(e) => setChosenName(e.currentTarget.value)} />
            </label>
            <DeviceForm choice={device} onChoice={setDevice} isDisabled={phase === "loading"} />
            <ExpertChoice listing={listing.sessions} scenes={scenes} sceneKey={sceneKey} expert={phase === "choose" ? chosenExpert : expert} onExpert={setChosenExpert} use="shown as a ghost" />
            {device.how && chosenName !== "" && <ShownCommand text={command("record", scene || "SCENE.json", "-o", chosenName ?? freeName(listing, kUsualName), ...deviceWords(device))} />}
            {phase === "loading" && <button type="button" onClick={() => loading.current?.abort()}>Cancel</button>}
          </Section>
        )}
        {phase === "running" && (
          <>
            <Section title="Now">
              {note && <p class="warning" role="status">Of the device: {note}.</p>}
              <Readings rows={[
                ...hands.flatMap((hand, i): [string, string, string?][] => {
                  const of = hands.length < 2 ? "" : i === 0 ? ", right" : ", left";
                  return [
                    [`force${of}`, newtons(Math.hypot(...hand.force))],
                    [`depth${of}`, millimetres(hand.depth, 2), "How far a ball dents the organ, or a blade is in it"],
                    [`touched${of}`, `${hand.contacts} points`],
                  ];
                }),
                ["severed", `${frame?.severed ?? 0} elements`],
                ["newest step", `${(1e3 * (frame?.tickTime ?? 0)).toFixed(2)} ms`, "How long the program worked on it"],
                ["99 of 100 steps", frame?.tickP99 ? underMs(frame.tickP99, 2) : "–", "How long the program worked on the newest 500; the longest of each 100 are left out"],
                ["late steps", String(frame?.lateTicks ?? 0)],
                ["behind the clock", seconds(frame?.slip ?? 0, 3)],
                ["frames missed", String(frame?.missed ?? 0)],
              ]} />
            </Section>
            <Section title="Expert">
              <ExpertChoice listing={listing.sessions.filter(({ path }) => path !== output)} scenes={scenes} sceneKey={sceneKey} expert={expert} onExpert={setChosenExpert} use="shown as a ghost" />
              {trainer?.isExpertOfOtherScene && <p class="warning" role="alert">{expert} is of another scene than this one: its ghost is not shown, and it cannot be compared with.</p>}
              {expert && trainer && !trainer.isExpertOfOtherScene && (
                <label class="field">
                  <span>the ghost is</span>
                  <select value={trainer.ghostAhead} onChange={(e) => {
                    trainer.ghostAhead = Number(e.currentTarget.value);
                    setTick((t) => t + 1);
                  }}>
                    <option value={kGhostAhead}>a little ahead</option>
                    <option value={0}>where you are on its path</option>
                  </select>
                </label>
              )}
              {trainer && trainer.ghostAway !== null && <Readings rows={[["away from your tool", millimetres(trainer.ghostAway)]]} />}
            </Section>
            <label class="tick"><input type="checkbox" checked={sound.current.isOn} onChange={() => {
              sound.current.switch();
              setTick((t) => t + 1);
            }} /> <span>the force as a sound <kbd>M</kbd></span></label>
          </>
        )}
        {phase === "ended" && ended && (
          <Ended connection={connection} listing={listing} scenes={scenes} sceneKey={sceneKey} ended={ended} expert={expert} onExpert={setChosenExpert} onReview={onReview}
            onAgain={() => void begin(scene, output)} onChoose={choose} onAuthor={tryScene ? onAuthor : null} />
        )}
      </aside>
    </div>
  );
}

/** What became of a session: its numbers, its verdict, and how it compares with the expert's. */
function Ended({ connection, listing, scenes, sceneKey, ended, expert, onExpert, onReview, onAgain, onChoose, onAuthor }: {
  connection: Connection;
  listing: Listing;
  scenes: SceneOfSession[];
  sceneKey: string;
  ended: EndedTraining;
  expert: string;
  onExpert: (path: string | null) => void;
  onReview: (place: Place) => void;
  onAgain: () => void;
  onChoose: () => void; // of another scene
  onAuthor: (() => void) | null;
}) {
  const [verdict, setVerdict] = useState<{ same: boolean; text: string } | null>(null);
  const [comparison, setComparison] = useState<ComparisonResult | null>(null);
  const [progress, setProgress] = useState<[number, number] | null>(null);
  const [error, setError] = useState<Error | null>(null);
  const running = useRef<AbortController | null>(null);
  const path = ended.errors.length === 0 ? ended.path : ""; // a file of that name may be somebody else's
  const [otherScene, setOtherScene] = useState(""); // why the expert's session cannot be compared with

  useEffect(() => {
    let isWanted = true;
    setOtherScene(""), setComparison(null);
    if (expert && path)
      connection.call<Comparable>("session.comparable", { expert, trainee: path })
        .then(({ text }) => isWanted && setOtherScene(text), (failure) => isWanted && setError(failure));
    return () => void (isWanted = false);
  }, [expert, path]);
  const isCompared = expert !== "" && otherScene === "";
  const others = listing.sessions.filter((session) => session.path !== path);
  const compare = async () => {
    const progress = (done: number, total: number) => setProgress([done, total]);
    setError(null), setComparison(null), setVerdict(null), progress(0, 1);
    running.current = new AbortController();
    const { signal } = running.current;
    try {
      setVerdict(await connection.call("session.verify", { path }, { progress, signal }));
      progress(0, 1);
      if (isCompared) setComparison(await connection.call<ComparisonResult>("session.compare", { expert, trainee: path }, { progress, signal }));
    } catch (failure) {
      setError(failure as Error);
    }
    setProgress(null);
  };
  return (
    <>
      {ended.errors.map((problem, i) => <p key={i} class="warning" role="alert">{problemText(problem)}</p>)}
      {ended.fault && <p class="warning">{ended.fault}</p>}
      {ended.refused && <p class="warning">The simulation was refused; what came before is saved.</p>}
      {path && (
        <Section title="Verify and compare">
          <ExpertChoice listing={others} scenes={scenes} sceneKey={sceneKey} expert={expert} onExpert={onExpert} use="to compare with" />
          {otherScene && <p class="warning" role="alert">{otherScene}. They cannot be compared.</p>}
          {progress ? <Working what={verdict ? "comparing" : "verifying"} done={progress[0]} total={progress[1]} onCancel={() => running.current?.abort()} />
            : <button type="button" class="main" onClick={() => void compare()}>{isCompared ? "Verify and compare" : "Verify"}</button>}
          {verdict && <p class={verdict.same ? "good" : "warning"} role="status">The recording, replayed: {verdict.text}</p>}
          <Problems error={error} />
        </Section>
      )}
      {comparison && <Outcome comparison={comparison} onMoment={(besideTime) => onReview({ session: expert, beside: path, besideTime, comparison })} />}
      <Section title="This session">
        {ended.ticks !== undefined && (
          <Readings rows={[
            ["recorded as", path || "not recorded"],
            ["duration", seconds(ended.ticks * (ended.tick_s ?? 1e-3), 1)],
            ["largest force", newtons(ended.max_force_n ?? 0)],
            ["largest depth", ended.max_depth_m ? millimetres(ended.max_depth_m, 2) : "–", "Of a ball; how deep a cut is the comparison says"],
            ["severed", `${ended.severed} elements`],
            ["late steps", String(ended.late_ticks)],
            ["behind the clock", behind(ended.slip_s ?? 0, ended.slip_max_s ?? 0)],
            ...tickRows(ended.tick_time_p50_s ?? 0, ended.tick_time_p99_s ?? 0, ended.tick_s ?? 1e-3),
            ["half of the poses", underMs(ended.pose_wait_p50_s ?? 0, 1), kPoseWait],
            ["99 of 100 poses", underMs(ended.pose_wait_p99_s ?? 0, 1), kPoseWait],
            ["within 5 ms", `${(1e2 * (ended.poses_within_5ms ?? 0)).toFixed(1)} %`, kPoseWait],
          ]} />
        )}
        <button type="button" onClick={onAgain}>Train again</button>
        <button type="button" onClick={onChoose}>Choose a scene</button>
        {onAuthor && <button type="button" onClick={onAuthor}>Back to Author</button>}
        {path && <button type="button" onClick={() => onReview({ session: path, time: 0 })}>Open in Review</button>}
      </Section>
      {comparison && <Measures comparison={comparison} />}
      {path && (
        <Section title="The same in a terminal">
          <ShownCommand text={command("verify", path)} />
          {isCompared && <ShownCommand text={command("compare", expert, path, "-o", "report")} />}
        </Section>
      )}
    </>
  );
}
