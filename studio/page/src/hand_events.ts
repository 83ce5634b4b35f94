// What keys, pointer, wheel and fingers say to the hand of a training.
import { type RefObject } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import type { ForceSound } from "./sound";
import type { Trainer } from "./trainer";

type Leading = { trainer: Trainer | null; isRunning: boolean; canvas: RefObject<HTMLCanvasElement>; redraw: () => void };

const kTakesKeys = "input, textarea, select, dialog"; // itself

/** Keys lead the tool wherever the focus is, but for fields and questions. */
function useKeys({ trainer, isRunning, redraw }: Leading, sound: ForceSound): void {
  useEffect(() => {
    if (!trainer || !isRunning) return;
    const press = (event: KeyboardEvent) => {
      if ((event.target as HTMLElement).closest(kTakesKeys) || event.ctrlKey || event.metaKey || event.altKey) return;
      const isLocked = document.pointerLockElement !== null;
      if (event.key === "Escape" && !isLocked) void trainer.end();
      else if (event.key === "Escape" || (event.key === " " && trainer.isLed)) document.exitPointerLock?.(), trainer.letGo();
      else if (event.key === " " && !(event.target as HTMLElement).closest("button, summary")) trainer.isHeld = true;
      else if (event.key.toLowerCase() === "m") sound.switch();
      else if (!trainer.press(event.key, event.shiftKey)) return;
      redraw();
      event.preventDefault();
    };
    // Whoever takes the mouse back goes elsewhere with it.
    const unlock = () => document.pointerLockElement || (trainer.letGo(), redraw());
    addEventListener("keydown", press);
    document.addEventListener("pointerlockchange", unlock);
    return () => {
      removeEventListener("keydown", press);
      document.removeEventListener("pointerlockchange", unlock);
    };
  }, [trainer, isRunning]);
}

function useWheel({ trainer, isRunning, canvas }: Leading): void {
  useEffect(() => {
    const target = canvas.current;
    if (!trainer || !target || !isRunning) return;
    const wheel = (event: WheelEvent) => {
      if (trainer.awaited) return;
      event.preventDefault();
      trainer.moveDeep(-Math.sign(event.deltaY));
    };
    target.addEventListener("wheel", wheel, { passive: false });
    return () => target.removeEventListener("wheel", wheel);
  }, [trainer, isRunning]);
}

/** One finger moves the tool; two look around, and are not followed. `onChange`: one more or one less. */
function useFingers(onChange: () => void): { fingers: Set<number>; isTouch: boolean } {
  const fingers = useRef(new Set<number>());
  const [isTouch, setTouch] = useState(() => matchMedia("(pointer: coarse)").matches);
  useEffect(() => {
    const count = (event: PointerEvent) => {
      if (event.pointerType !== "touch") return;
      if (event.type === "pointerdown") fingers.current.add(event.pointerId), setTouch(true);
      else fingers.current.delete(event.pointerId);
      onChange();
    };
    const kinds = ["pointerdown", "pointerup", "pointercancel"] as const;
    for (const kind of kinds) addEventListener(kind, count);
    return () => kinds.forEach((kind) => removeEventListener(kind, count));
  }, []);
  return { fingers: fingers.current, isTouch };
}

/** Lets whatever is in front of the page lead the hand of a training while it runs. Returns what the picture's element needs
    besides, and whether fingers do. */
export function useHand(leading: Leading, sound: ForceSound) {
  const { trainer, isRunning, canvas, redraw } = leading;
  const last = useRef<{ x: number; y: number } | null>(null); // of the pointer
  useKeys(leading, sound);
  useWheel(leading);
  const { fingers, isTouch } = useFingers(() => (last.current = null));

  const move = (event: PointerEvent) => {
    if (!isRunning || !trainer || trainer.awaited) return;
    // While the view is turned the tool stays, and does not follow afterwards.
    if ((event.buttons & 2) !== 0) return void (last.current = null);
    if (event.pointerType === "touch" && (event.buttons === 0 || fingers.size > 1)) return;
    const from = last.current;
    last.current = { x: event.clientX, y: event.clientY };
    if (!trainer.isHeld) {
      const box = canvas.current!.getBoundingClientRect();
      trainer.reach(event.clientX - box.left, event.clientY - box.top);
      if (trainer.isHeld) redraw();
    } else if (document.pointerLockElement === canvas.current) trainer.movePixels(event.movementX, event.movementY);
    else if (from) trainer.movePixels(event.clientX - from.x, event.clientY - from.y);
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

  const onPointerLeave = () => {
    last.current = null;
    trainer?.leave();
    redraw();
  };
  const onPointerDown = (event: PointerEvent) => {
    // What holds the mouse needs no looking around, and a locked pointer cannot be captured for it.
    if (isRunning && !trainer?.awaited && event.pointerType === "mouse" && (event.button === 0 || document.pointerLockElement)) event.stopImmediatePropagation();
    if (!isRunning || !trainer || trainer.awaited || event.button !== 0) return;
    trainer.isHeld = true; // wherever it is
    redraw();
    if (event.pointerType === "mouse") void Promise.resolve(canvas.current?.requestPointerLock?.()).catch(() => {});
  };
  return { isTouch, onPointerDown, onPointerLeave };
}
