import type { ComponentChildren } from "preact";
import { useCallback, useEffect, useRef, useState } from "preact/hooks";
import { CallFailed, problemText } from "./protocol";

/** Numbers in a column, each with its unit; some say more when they are pointed at. */
export function Readings({ rows }: { rows: [string, ComponentChildren, string?][] }) {
  return (
    <dl class="readings">
      {rows.map(([name, value, more]) => (
        <div key={name} title={more}>
          <dt>{name}</dt>
          <dd>{value}</dd>
        </div>
      ))}
    </dl>
  );
}

/** Numbers of the machine, which say nothing of the hand: folded in a line that says in short how it does. */
export function OfMachine({ says, rows }: { says: string; rows: [string, ComponentChildren, string?][] }) {
  return (
    <details class="of-machine">
      <summary>The machine: {says}</summary>
      <Readings rows={rows} />
    </details>
  );
}

/** What went wrong, in the program's words; it is brought into view. With `onClose` it can be put away. */
export function Problems({ error, onClose }: { error: Error | null; onClose?: () => void }) {
  const box = useRef<HTMLDivElement>(null);
  useEffect(() => box.current?.scrollIntoView({ block: "nearest" }), [error]);
  if (!error) return null;
  const lines = error instanceof CallFailed ? error.problems.map(problemText) : [error.message];
  return (
    <div ref={box} class="problems" role="alert">
      <ul>
        {lines.map((line, i) => (
          <li key={i}>{line}</li>
        ))}
      </ul>
      {onClose && <button type="button" class="quiet" onClick={onClose}>Close</button>}
    </div>
  );
}

/** The command that does the same in a terminal. */
export function ShownCommand({ text }: { text: string }) {
  const [copied, setCopied] = useState(false);
  const copy = () => {
    void navigator.clipboard?.writeText(text).then(() => setCopied(true), () => setCopied(false));
  };
  return (
    <div class="command">
      <code>{text}</code>
      <button type="button" class="quiet" onClick={copy} aria-label={`Copy the command ${text}`}>
        {copied ? "copied" : "copy"}
      </button>
    </div>
  );
}

const kRepeat = 60; // of what a held button does [ms]

/** A button that does something as long as it is held, for hands without keys. */
export function HeldButton({ text, onHeld }: { text: string; onHeld: () => void }) {
  const timer = useRef<ReturnType<typeof setInterval>>();
  const stop = () => clearInterval(timer.current);
  useEffect(() => stop, []);
  return (
    <button type="button" onPointerDown={(e) => {
      e.currentTarget.setPointerCapture(e.pointerId);
      stop(), onHeld();
      timer.current = setInterval(onHeld, kRepeat);
    }} onPointerUp={stop} onPointerCancel={stop} onContextMenu={(e) => e.preventDefault()} onClick={(e) => e.detail === 0 && onHeld()}>{text}</button>
  );
}

/** Work that goes on: how far it is, and how to end it. */
export function Working({ what, done, total, onCancel }: { what: string; done: number; total: number; onCancel?: () => void }) {
  const share = total > 0 ? done / total : 0;
  return (
    <div class="working">
      <label>
        <span>{what} {Math.round(100 * share)} %</span>
        <progress max={1} value={share} />
      </label>
      {onCancel && <button type="button" class="quiet" onClick={onCancel}>cancel</button>}
    </div>
  );
}

export function Section({ title, children, aside }: { title: string; children: ComponentChildren; aside?: ComponentChildren }) {
  return (
    <section>
      <h2>{title}{aside}</h2>
      {children}
    </section>
  );
}

/** Draws what calls it once more, for what changes outside of its state. */
export function useRedraw(): () => void {
  const [, setCount] = useState(0);
  return useCallback(() => setCount((count) => count + 1), []);
}

/** Once what calls it is gone, the focus is where it was before, unless it is elsewhere by then. */
export function useFocusBack(): void {
  const before = useRef(document.activeElement as HTMLElement | null);
  useEffect(() => () => void setTimeout(() => {
    if (document.activeElement === document.body) before.current?.focus();
  }), []);
}

/** What to do where there is nothing yet. */
export function Empty({ title, children }: { title: string; children: ComponentChildren }) {
  return (
    <div class="empty">
      <h2>{title}</h2>
      {children}
    </div>
  );
}
