import { useCallback, useEffect, useRef, useState } from "preact/hooks";
import type { Connection } from "./connection";
import { DeviceForm } from "./device";
import { deviceParameters, deviceWords, storedDevice, storeDevice } from "./device_choice";
import { hasDraft } from "./drafts";
import { Ended } from "./ended";
import { ExpertChoice, proposedExpert } from "./expert_choice";
import { useHand } from "./hand_events";
import { endOf, forgetTraining, keepTraining, lastTraining } from "./last_training";
import type { Recording } from "./leaving";
import { forceLimit, forceOf, OverPicture, placeMarks, useMarks } from "./over_picture";
import { Empty, Problems, Readings, Section, ShownCommand, useRedraw } from "./parts";
import type { Place } from "./place";
import type { CameraView, EndedTraining, Listing, Motion, SceneOfSession } from "./protocol";
import { ForceSound } from "./sound";
import { command, freePath, millimetres } from "./text";
import { TrainBar } from "./train_bar";
import { Now, Task } from "./train_now";
import { kGhostAhead, Trainer } from "./trainer";
import { Viewer } from "./viewer";

const kNumbers = 50, kNumbersBeside = 200; // from one reading to the next; where the processor draws pictures beside them [ms]

type Phase = "choose" | "loading" | "running" | "ended";

const kUsualName = "mine-1.ctpm";

const withEnding = (name: string) => (name === "" || name.endsWith(".ctpm") ? name : `${name}.ctpm`);

/** A name for a session that does not exist yet. */
const freeName = ({ sessions }: Listing, name: string) => freePath(sessions.map(({ path }) => path), name);

export function Train({ connection, listing, tryScene, tryText, tryView, onReview, onAuthor, onChanged, onRecording }: {
  connection: Connection;
  listing: Listing;
  tryScene: string | undefined; // at once, and nothing is recorded
  tryText: string | undefined; // of that scene, as its author has it now
  tryView: CameraView | undefined; // as its author sees it
  onReview: (place: Place) => void;
  onAuthor: () => void; // back to the scene that was tried
  onChanged: () => void;
  onRecording: (recording: Recording | null) => void; // which leaving the room would end
}) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const [trainer, setTrainer] = useState<Trainer | null>(null);
  const [last] = useState(() => (tryScene ? null : lastTraining(listing.folder))); // to which somebody comes back
  const [phase, setPhase] = useState<Phase>(last ? "ended" : "choose");
  const [scene, setScene] = useState(last?.scene ?? "");
  const [chosenName, setChosenName] = useState<string | null>(last ? last.chosenName : tryScene ? "" : null); // null: the page's; empty: nothing is recorded
  const [output, setOutput] = useState(last?.output ?? ""); // the session that is recorded; empty: none
  const [sceneKey, setSceneKey] = useState(last?.sceneKey ?? ""); // of the scene of the session that runs or has ended; empty: not known
  const [scenes, setScenes] = useState<SceneOfSession[]>([]); // of the sessions, once they are known
  const [chosenExpert, setChosenExpert] = useState(last?.chosenExpert ?? null); // null: the page's proposal for what is recorded; empty: none
  const [device, setDevice] = useState(last?.device ?? storedDevice), [waits, setWaits] = useState(""), [note, setNote] = useState("");
  const [ended, setEnded] = useState<EndedTraining | null>(null);
  const [error, setError] = useState<Error | null>(null);
  const redraw = useRedraw(), marks = useMarks();
  const loading = useRef<AbortController | null>(null);
  const bar = useRef<HTMLDivElement>(null), barHeight = useRef(0); // that of a training that ran last, so that the picture stays at its end [px]
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
      if (performance.now() - last < interval) return;
      last = performance.now();
      redraw();
    };
    viewer.onDraw = () => (made.lookDown(), placeMarks(marks, made));
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
      redraw();
    }, setError);
  }, [trainer, expert]);

  const { isTouch, onPointerDown, onPointerLeave } = useHand({ trainer, isRunning: phase === "running", canvas, redraw }, sound.current);

  const choose = () => {
    forgetTraining();
    trainer?.clear();
    setChosenName(tryScene ? null : chosenName && freeName(listing, chosenName));
    setPhase("choose"), setEnded(null), setSceneKey("");
  };

  // A scene as its author has it now may be another one when somebody comes back.
  const isKept = (phase === "running" || phase === "ended") && (output !== "" || scene !== tryScene);
  useEffect(() => {
    if (isKept) keepTraining({ folder: listing.folder, scene, output, sceneKey, chosenName, chosenExpert, device, ended });
  }, [isKept, phase, output, sceneKey, chosenExpert, ended]);
  useEffect(() => {
    if (!last || phase !== "ended" || ended) return;
    let isWanted = true;
    endOf(connection, last).then((end) => isWanted && setEnded(end), () => isWanted && choose());
    return () => void (isWanted = false);
  }, [connection, phase, ended]);

  const recorded = phase === "running" && trainer?.scene?.frame?.tick ? output : "";
  useEffect(() => {
    if (!recorded || !trainer) return;
    const ask = (event: BeforeUnloadEvent) => event.preventDefault();
    onRecording({ name: recorded, end: () => trainer.end(), resume: () => canvas.current?.focus() });
    addEventListener("beforeunload", ask);
    return () => {
      onRecording(null);
      removeEventListener("beforeunload", ask);
    };
  }, [recorded, trainer]);

  useEffect(() => {
    if (phase === "running" && bar.current) barHeight.current = bar.current.getBoundingClientRect().height;
  });
  const view = trainer?.scene?.view ?? null;
  sound.current.sound(forceOf(trainer) / forceLimit(view));

  return (
    <div class="room train">
      <nav class="list" aria-label="Scenes">
        <h2>Scenes</h2>
        {listing.scenes.length === 0 && <p class="hint">No scene in this folder yet. Make one in Author, or with <code>ctpm import</code>.</p>}
        <ul>
          {listing.scenes.map((entry) => (
            <li key={entry.path}>
              <button type="button" aria-current={scene === entry.path} title={entry.path} disabled={phase === "running" || phase === "loading"} onClick={() => void begin(entry.path, phase === "ended" ? output : undefined)}>
                <span>{entry.path.replace(/\.json$/, "")}</span>
              </button>
              {hasDraft(entry.path) && <small class="draft" title="Save them in Author to train with them">without its unsaved changes</small>}
            </li>
          ))}
        </ul>
      </nav>
      <div class={`view ${phase}${trainer?.awaited ? " watched" : trainer?.isHeld ? " held" : ""}`}>
        <canvas ref={canvas} tabIndex={0} aria-label={view ? `The scene ${view.name}; arrow keys move the tool` : "No scene"}
          onPointerDown={onPointerDown} onPointerLeave={onPointerLeave} onContextMenu={(e) => e.preventDefault()} />
        {phase === "choose" && (
          <Empty title="Choose a scene to train in">
            <p>The tool follows the mouse. {chosenName === "" ? "Nothing is recorded: beside the picture a session gets a name." : "The session is recorded, and measured against an expert's when you end it."}</p>
          </Empty>
        )}
        {phase === "loading" && (
          <Empty title={`Loading ${scene}`}>
            <p>Its organs are filled with spheres and settle under gravity.</p>
          </Empty>
        )}
        {phase === "ended" && !view && (
          <Empty title={output ? `${output} has ended` : "The training has ended"}>
            <p>What can be done with it is beside the picture; or choose another scene.</p>
          </Empty>
        )}
        {phase === "running" && trainer && <OverPicture trainer={trainer} marks={marks} isTouch={isTouch} waits={waits} />}
        <Problems error={error} />
      </div>
      <div class="time" ref={bar} style={{ minHeight: phase === "ended" && view ? barHeight.current : 0 }}>
        {phase === "running" && trainer?.scene && <TrainBar trainer={trainer} output={output} isTouch={isTouch} redraw={redraw} />}
      </div>
      <aside class="side">
        {phase !== "running" && phase !== "ended" && (
          <Section title="Session">
            <label class="field">
              <span>record as (empty: nothing is recorded)</span>
              <input value={phase === "loading" ? output : chosenName ?? freeName(listing, kUsualName)} disabled={phase === "loading"} onInput={(e) => setChosenName(e.currentTarget.value.trim() && e.currentTarget.value)} />
            </label>
            <DeviceForm choice={device} onChoice={setDevice} isDisabled={phase === "loading"} />
            <ExpertChoice listing={listing.sessions} scenes={scenes} sceneKey={sceneKey} expert={phase === "choose" ? chosenExpert : expert} onExpert={setChosenExpert} use="shown as a ghost" />
            {device.how && chosenName !== "" && <ShownCommand text={command("record", scene || "SCENE.json", "-o", chosenName ?? freeName(listing, kUsualName), ...deviceWords(device))} />}
            {phase === "loading" && <button type="button" onClick={() => loading.current?.abort()}>Cancel</button>}
          </Section>
        )}
        {phase === "running" && trainer && (
          <>
            <Task task={view?.task ?? ""} />
            <Now trainer={trainer} note={note} />
            <Section title="Expert">
              <ExpertChoice listing={listing.sessions.filter(({ path }) => path !== output)} scenes={scenes} sceneKey={sceneKey} expert={expert} onExpert={setChosenExpert} use="shown as a ghost" />
              {trainer.isExpertOfOtherScene && <p class="warning" role="alert">{expert} is of another scene than this one: its ghost is not shown, and it cannot be compared with.</p>}
              {expert && !trainer.isExpertOfOtherScene && (
                <>
                  <p class="hint">The pale blue tool is the expert's: yours should go where it goes.</p>
                  <label class="field">
                    <span>the ghost is</span>
                    <select value={trainer.ghostAhead} onChange={(e) => {
                      trainer.ghostAhead = Number(e.currentTarget.value);
                      redraw();
                    }}>
                      <option value={kGhostAhead}>a little ahead</option>
                      <option value={0}>where you are on its path</option>
                    </select>
                  </label>
                </>
              )}
              {trainer.ghostAway !== null && <Readings rows={[["away from your tool", millimetres(trainer.ghostAway)]]} />}
            </Section>
            <label class="tick"><input type="checkbox" checked={sound.current.isOn} onChange={() => {
              sound.current.switch();
              redraw();
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
