import { type ComponentChildren, render } from "preact";
import { useEffect, useErrorBoundary, useRef, useState } from "preact/hooks";
import { Connection, onNewToken, takeToken } from "./connection";
import { Author } from "./author";
import { LeaveQuestion, type Recording } from "./leaving";
import { Empty } from "./parts";
import type { Listing } from "./protocol";
import { hashOf, type Place, readHash, type Room } from "./place";
import { Review } from "./review";
import { command } from "./text";
import { Train } from "./train";

const kRooms: [Room, string][] = [["author", "Author"], ["train", "Train"], ["review", "Review"]];

function readPlace(): { room: Room; place: Place } {
  const { room: named, place } = readHash(location.hash.slice(1));
  return { room: kRooms.find(([room]) => room === named)?.[0] ?? "author", place };
}

function writePlace(room: Room, place: Place): void {
  history.replaceState(history.state, "", `#${hashOf(room, place)}`);
}

let token = takeToken();
const start = readPlace();
const kAskAgain = 2000; // whether the program is back [ms]

/** A room: an error of the page ends what is shown of it, and not the others. */
function Guarded({ children }: { children: ComponentChildren }) {
  const [error, openAgain] = useErrorBoundary((failure) => console.error(failure)) as [Error | undefined, () => void];
  if (!error) return <>{children}</>;
  return (
    <Empty title="This room has stopped">
      <p role="alert">The page made an error: {error.message ?? String(error)}. Scenes that were not saved are kept as drafts, and a session that was being recorded is in its file.</p>
      <p><button type="button" class="main" onClick={openAgain}>Open the room again</button></p>
    </Empty>
  );
}

function App() {
  const [connection, setConnection] = useState<Connection | null>(null);
  const [isClosed, setClosed] = useState(false), [otherVersion, setOtherVersion] = useState(""), [unreadable, setUnreadable] = useState("");
  const [listing, setListing] = useState<Listing | null>(null);
  const [room, setRoom] = useState<Room>(start.room);
  const recording = useRef<Recording | null>(null); // which leaving the room would end
  const [leaving, setLeaving] = useState<{ recording: Recording; go: () => void } | null>(null); // once that is wanted

  // A program that was ended, or this machine's sleep, ends the connection. It is looked for until it is back.
  useEffect(() => {
    let timer: ReturnType<typeof setTimeout> | undefined, newest: Connection | null = null;
    const connect = () => {
      clearTimeout(timer);
      const made: Connection = new Connection(token, () => {
        setConnection(made);
        setClosed(false);
      }, (differs) => {
        if (newest !== made) return;
        setClosed(true);
        setLeaving(null);
        setOtherVersion(differs);
        if (!differs) timer = setTimeout(connect, kAskAgain); // a program of this page's version has another token
      });
      made.onUnreadable = setUnreadable;
      newest = made;
    };
    connect();
    return onNewToken((given) => {
      token = given;
      connect();
    });
  }, []);
  const [place, setPlace] = useState<Place>(start.place);
  const list = () => void connection?.call<Listing>("folder.list").then(setListing, () => {});
  useEffect(list, [connection, room]);
  // A command may have made files since the window was left, or while it is only looked at.
  useEffect(() => (addEventListener("focus", list), () => removeEventListener("focus", list)), [connection]);
  const listAnew = ({ target, relatedTarget }: FocusEvent) => {
    const opened = (target as Element).closest("select, .list");
    if (opened && !opened.contains(relatedTarget as Node | null)) list();
  };
  const reviewed = useRef<Place>({}); // what was in review last, for whoever looks into another room
  const keepReviewed = (there: Place) => (reviewed.current = there, writePlace("review", there));
  const show = (to: Room, there: Place) => {
    setPlace(there);
    setRoom(to);
  };
  /** Goes to another room: at once, or once it is sure that a recording is to end here. */
  const leave = (goOn: () => void) => (recording.current ? setLeaving({ recording: recording.current, go: goOn }) : goOn());
  const go = (to: Room, there: Place) => {
    const enter = () => {
      if (to !== room) history.pushState(null, "", location.hash); // Back leads to the room before
      show(to, there);
      writePlace(to, there);
    };
    if (to === room) enter();
    else leave(enter);
  };
  useEffect(() => {
    const back = () => {
      if (new URLSearchParams(location.hash.slice(1)).has("token")) return; // the program's new address, in this tab: the page goes on
      const to = readPlace();
      if (!recording.current || to.room === room) return show(to.room, to.place);
      history.pushState(null, "", `#${hashOf(room, {})}`); // the address waits for the answer too
      leave(() => history.back());
    };
    addEventListener("popstate", back);
    return () => removeEventListener("popstate", back);
  }, [room]);

  return (
    <>
      <header>
        <h1>ctpm <span>studio</span></h1>
        <nav aria-label="Rooms">
          {kRooms.map(([name, title]) => (
            <button key={name} type="button" aria-current={room === name ? "page" : undefined} onClick={() => go(name, name === "review" && room !== name ? reviewed.current : {})}>{title}</button>
          ))}
        </nav>
        <span class="folder" title="The folder that the studio was started in">{listing?.folder ?? ""}</span>
      </header>
      {unreadable && (
        <div class="unreadable" role="alert">
          <p>The program sent something that this page cannot read, and it was left out: {unreadable}. If it was updated while this page was open, load the page again.</p>
          <button type="button" onClick={() => location.reload()}>Load again</button>
          <button type="button" class="quiet" onClick={() => setUnreadable("")}>Close</button>
        </div>
      )}
      {leaving && (
        <LeaveQuestion recording={leaving.recording} onStay={() => setLeaving(null)} onLeave={() => {
          recording.current = null;
          setLeaving(null);
          leaving.go();
        }} />
      )}
      <main onFocusIn={listAnew}>
        {isClosed && otherVersion ? (
          <Empty title="The program was updated">
            <p>This page was loaded from another version of it: {otherVersion}. Scenes that were not saved are kept as drafts.</p>
            <p><button type="button" class="main" onClick={() => location.reload()}>Load the page again</button></p>
          </Empty>
        ) : isClosed ? (
          <Empty title={connection ? "The studio has ended" : "The program does not answer at this address"}>
            <p>{connection ? "Start it again" : "An address holds the key of one run: open the one that the program printed, or start it"}: <code>{command("studio", listing?.folder)}</code>. Where its address is opened, here or in
              another tab, this page goes on. Scenes that were not saved are kept as drafts, and a session that was being recorded is there up to its last whole second: <code>{command("recover", "SESSION.ctpm", "-o", "saved.ctpm")}</code></p>
          </Empty>
        ) : connection && listing ? (
          <Guarded key={room}>{room === "review" ? (
            <Review connection={connection} listing={listing} place={place} onPlace={keepReviewed} />
          ) : room === "author" ? (
            <Author connection={connection} listing={listing} onChanged={list} onTry={(scene, text, seen) => go("train", { scene, text, seen })} />
          ) : (
            <Train connection={connection} listing={listing} tryScene={place.scene} tryText={place.text} tryView={place.seen} onChanged={list}
              onRecording={(running) => (recording.current = running)} onReview={(there) => go("review", there)} onAuthor={() => go("author", {})} />
          )}</Guarded>
        ) : (
          <Empty title="Connecting"><p>to the program on this machine.</p></Empty>
        )}
      </main>
    </>
  );
}

render(<App />, document.getElementById("app")!);
