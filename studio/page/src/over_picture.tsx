// What stands over the picture of a training.
import type { RefObject } from "preact";
import { useRef } from "preact/hooks";
import { Empty } from "./parts";
import type { SceneView } from "./protocol";
import { millimetres, newtons, seconds } from "./text";
import type { Trainer } from "./trainer";

const kForceLimit = 10; // of a scene that has none [N]
const kEdge = 16; // of the picture, that what is written leaves free [px]
const kBesideTool = 12, kLabel = 200; // from the tool to what is written beside it, and room for that and the bar of the force [px]

/** Force at which the bar is full [N]. */
export function forceLimit(view: SceneView | null): number {
  return view?.damage_force_n || kForceLimit;
}

export function forceOf(trainer: Trainer | null): number {
  return Math.hypot(...(trainer?.ownFrame?.force ?? [0]));
}

/** What each picture moves, so that nothing is laid out anew. */
export interface Marks {
  bar: RefObject<HTMLDivElement>;
  ring: RefObject<HTMLDivElement>;
  label: RefObject<HTMLDivElement>;
}

export function useMarks(): Marks {
  return { bar: useRef<HTMLDivElement>(null), ring: useRef<HTMLDivElement>(null), label: useRef<HTMLDivElement>(null) };
}

export function placeMarks({ bar, ring, label }: Marks, trainer: Trainer): void {
  bar.current?.style.setProperty("transform", `scaleY(${Math.min(1, forceOf(trainer) / forceLimit(trainer.scene?.view ?? null))})`);
  const at = trainer.toolPixel;
  if (ring.current) placeRing(ring.current, at);
  if (label.current) placeLabel(label.current, at, trainer);
}

/** The ring shows where a pointer takes the tool up; what is written below it stays in the picture. */
function placeRing(ring: HTMLElement, at: { x: number; y: number } | null): void {
  ring.hidden = at === null;
  if (!at) return;
  const half = (ring.firstElementChild!.clientWidth + kEdge) / 2, width = ring.parentElement!.clientWidth;
  ring.style.setProperty("transform", `translate(${at.x}px, ${at.y}px)`);
  ring.style.setProperty("--aside", `${Math.max(half, Math.min(width - half, at.x)) - at.x}px`);
}

/** How far the tool is above the tissue; empty: it touches, or is in it. */
export function gapText({ gap }: Trainer): string {
  return gap === null ? "" : gap < Infinity ? `${millimetres(gap)} above` : "no tissue below";
}

/** Of two hands, which one is led. */
const handText = ({ handCount, led }: Trainer) => (handCount < 2 ? "" : led === 0 ? "right hand" : "left hand");

/** What stands beside the tool: the hand that is led, if there are two, and how far above the tissue it is. */
function placeLabel(label: HTMLElement, at: { x: number; y: number } | null, trainer: Trainer): void {
  const text = [trainer.awaited ? "" : handText(trainer), gapText(trainer)].filter(Boolean).join("\n");
  label.classList.toggle("gone", at === null || text === "");
  if (!at || !text) return; // what it said fades away where it is
  const beside = trainer.toolSize + kBesideTool, isLeft = at.x + beside + kLabel > label.parentElement!.clientWidth;
  label.style.setProperty("transform", `translate(${isLeft ? at.x - beside : at.x + beside}px, ${at.y}px) translate(${isLeft ? -100 : 0}%, -50%)`);
  if (label.textContent !== text) label.textContent = text; // in the end: what is written is laid out once
}

/** Says that a session runs in slow motion, and what helps, for as long as it does. */
function SlowMotion({ trainer: { pace } }: { trainer: Trainer }) {
  if (!pace.isSlow) return null;
  return (
    <div class="slow-motion" role="status">
      <strong>This machine is too slow for what happens here: {seconds(pace.behind, 0)} behind the clock</strong>
      <p>The tissue moves at {Math.round(1e2 * pace.share)} % of its pace, and takes your hand for that much faster than it is. Move that much slower, close other programs, or give the
        organs larger spheres in Author.</p>
    </div>
  );
}

export function OverPicture({ trainer, marks, isTouch, waits }: {
  trainer: Trainer;
  marks: Marks;
  isTouch: boolean;
  waits: string; // why the device that is awaited does not lead yet
}) {
  const frame = trainer.scene?.frame ?? null, { awaited, givesWay } = trainer;
  const force = forceOf(trainer), limit = forceLimit(trainer.scene?.view ?? null);
  return (
    <>
      {awaited && !frame?.tick && (
        <Empty title={`${awaited[0].toUpperCase()}${awaited.slice(1)}`}>
          <p role="status">{waits || "The session begins with its first pose."}</p>
        </Empty>
      )}
      {frame && !(awaited && !frame.tick) && <div ref={marks.label} class="tool-label gone" aria-hidden="true" />}
      {frame && !awaited && !trainer.isHeld && !trainer.isLedByKeys && !isTouch && (
        <div ref={marks.ring} class="take-up" hidden aria-hidden="true"><span>{trainer.isLetGo ? "Space or a click takes it up" : "move the pointer here to take it up"}</span></div>
      )}
      {frame && (
        <div class="force-bar" role="meter" aria-label="Force" aria-valuemin={0} aria-valuemax={limit} aria-valuenow={Number(force.toFixed(2))}>
          <div ref={marks.bar} class={force > limit ? "over" : ""} />
          <span class="full">{trainer.scene?.view.damage_force_n ? `harms from ${newtons(limit, 1)}` : newtons(limit, 0)}</span>
          <output>{newtons(force)}</output>
        </div>
      )}
      <SlowMotion trainer={trainer} />
      {givesWay && (
        <p class="busy" role="status">The hand gives way: a mouse presses {"force_n" in givesWay ? `with ${newtons(givesWay.force_n, 0)} at most` : `${millimetres(givesWay.depth_m, 0)} deep at most`}</p>
      )}
    </>
  );
}
