// Where the page is, in its address.
import type { CameraView, ComparisonResult } from "./protocol";

export type Room = "author" | "train" | "review";

export interface Place {
  scene?: string; // to try at once, in Train
  text?: string; // of that scene, as its author has it now
  seen?: CameraView; // the scene that is tried
  session?: string;
  beside?: string;
  ahead?: number; // of the session beside [s]; none: both begin at first contact
  time?: number; // of the session [s]
  besideTime?: number; // in place of time: of the session beside, of which this is the comparison [s]
  comparison?: ComparisonResult;
}

/** What the address says after its #: a link leads to sessions and a moment of them. */
export function hashOf(room: Room, place: Place): string {
  const hash = new URLSearchParams({ room });
  if (place.session) hash.set("session", place.session);
  if (place.beside) hash.set("beside", place.beside);
  if (place.beside && place.ahead !== undefined) hash.set("ahead", place.ahead.toFixed(3));
  if (place.time !== undefined) hash.set("t", place.time.toFixed(3));
  return hash.toString();
}

/** Reads it; what is no number is 0. */
export function readHash(text: string): { room: string | null; place: Place } {
  const hash = new URLSearchParams(text);
  const number = (key: string) => (hash.has(key) ? Number(hash.get(key)) || 0 : undefined);
  return {
    room: hash.get("room"),
    place: { session: hash.get("session") ?? undefined, beside: hash.get("beside") ?? undefined, ahead: number("ahead"), time: number("t") },
  };
}
