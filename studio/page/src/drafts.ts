// What the browser keeps of a scene's text: a draft until it is saved, and its history.

/** A file as it was read. */
export interface FileText {
  text: string;
  revision: string;
}

/** A text that was not saved. */
export interface Draft {
  text: string;
  file: FileText | null; // that it began with
}

type Kind = "draft" | "drafted" | "history"; // the text, the file that it began with, the steps that led to it
const kKinds: Kind[] = ["draft", "drafted", "history"];

function keyOf(kind: Kind, path: string): string {
  return `ctpm.${kind}:${path}`;
}

/** Where the browser's storage is full, histories make room for what is kept now. */
function put(kind: Kind, path: string, value: string): void {
  const key = keyOf(kind, path);
  try {
    localStorage.setItem(key, value);
  } catch {
    for (const other of Object.keys(localStorage)) if (other.startsWith(keyOf("history", ""))) localStorage.removeItem(other);
    localStorage.setItem(key, value);
  }
}

export function readDraft(path: string): Draft | null {
  const text = localStorage.getItem(keyOf("draft", path)), file = localStorage.getItem(keyOf("drafted", path));
  return text === null ? null : { text, file: file === null ? null : (JSON.parse(file) as FileText) };
}

export function hasDraft(path: string): boolean {
  return localStorage.getItem(keyOf("draft", path)) !== null;
}

export function putDraft(path: string, text: string, file: FileText): void {
  put("drafted", path, JSON.stringify(file));
  put("draft", path, text);
}

/** Tells when another tab of this browser keeps a draft of a scene, or drops it: null. */
export function onDraftElsewhere(path: () => string, tell: (text: string | null) => void): void {
  addEventListener("storage", ({ key, newValue }) => key === keyOf("draft", path()) && tell(newValue));
}

export function dropDraft(path: string): void {
  for (const kind of ["draft", "drafted"] as const) localStorage.removeItem(keyOf(kind, path));
}

/** The history of a scene as putHistory() had it; null: there is none. */
export function readHistory(path: string): string | null {
  return localStorage.getItem(keyOf("history", path));
}

/** Keeps a history where there is room for it; null: there is none to keep. */
export function putHistory(path: string, history: string | null): void {
  localStorage.removeItem(keyOf("history", path));
  try {
    if (history !== null) put("history", path, history);
  } catch {
    // The text is kept without it.
  }
}

export function dropKept(path: string): void {
  for (const kind of kKinds) localStorage.removeItem(keyOf(kind, path));
}

/** What is kept of a scene goes where its file goes; what was left there by another file is none of it. */
export function moveKept(from: string, to: string): void {
  const kept = kKinds.map((kind) => [kind, localStorage.getItem(keyOf(kind, from))] as const);
  dropKept(from), dropKept(to);
  for (const [kind, value] of kept) if (value !== null) localStorage.setItem(keyOf(kind, to), value);
}
