// Where the page is, in its address.
import { kPlainLook, type Look } from "./look";
import type { CameraView, ComparisonResult } from "./protocol";

export type Room = "author" | "train" | "review";

/** What brings two sessions together, in the words of `export --align`. */
export type Alignment = "path" | "contact" | "cut";
const kAlignments: Alignment[] = ["path", "contact", "cut"];
/** Of those that are events, how the program names them. */
export const kEventOf = { contact: "contact begins", cut: "cut" } as const;

export interface Place {
  scene?: string; // to try at once, in Train
  text?: string; // of that scene, as its author has it now
  seen?: CameraView; // the scene that is tried
  session?: string;
  beside?: string;
  ahead?: number; // of the session beside at that time [s]; none: both begin at first contact
  align?: Alignment; // what brings both together; none: `ahead`
  look?: Look; // how it is seen; none: as it was
  time?: number; // of the session [s]
  zoom?: { from: number; to: number }; // what its timeline shows [s]; none: everything
  besideTime?: number; // in place of time: of the session beside, of which this is the comparison [s]
  comparison?: ComparisonResult;
}

const kLookKeys = ["view", "by", "cutaway", "camera"] as const;

/** What the address says after its #: a link leads to sessions, a moment of them, and how it is seen. */
export function hashOf(room: Room, place: Place): string {
  const hash = new URLSearchParams({ room });
  if (place.session) hash.set("session", place.session);
  if (place.beside) hash.set("beside", place.beside);
  if (place.beside && place.ahead !== undefined) hash.set("ahead", place.ahead.toFixed(3));
  if (place.beside && place.align) hash.set("align", place.align);
  if (place.time !== undefined) hash.set("t", place.time.toFixed(3));
  if (place.session && place.zoom) hash.set("from", place.zoom.from.toFixed(3)), hash.set("to", place.zoom.to.toFixed(3));
  if (place.session && place.look) for (const key of kLookKeys) if (place.look[key] !== kPlainLook[key]) hash.set(key, place.look[key]);
  return hash.toString();
}

/** Reads it; what is no number is 0. */
export function readHash(text: string): { room: string | null; place: Place } {
  const hash = new URLSearchParams(text);
  const number = (key: string) => (hash.has(key) ? Number(hash.get(key)) || 0 : undefined);
  const from = number("from"), to = number("to");
  const look: Look = { ...kPlainLook };
  for (const key of kLookKeys) look[key] = hash.get(key) ?? kPlainLook[key];
  return {
    room: hash.get("room"),
    place: {
      session: hash.get("session") ?? undefined, beside: hash.get("beside") ?? undefined, ahead: number("ahead"), time: number("t"),
      align: kAlignments.find((known) => known === hash.get("align")), look,
      zoom: from !== undefined && to !== undefined && to > from ? { from, to } : undefined,
    },
  };
}
