// An editor of scene text: colours, completion from the schema, underlined errors, history.
import { autocompletion, closeBrackets, closeBracketsKeymap, type Completion, type CompletionContext, completionKeymap, type CompletionResult } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyField, historyKeymap, undoDepth } from "@codemirror/commands";
import { json } from "@codemirror/lang-json";
import { bracketMatching, HighlightStyle, syntaxHighlighting } from "@codemirror/language";
import { type Diagnostic, setDiagnostics } from "@codemirror/lint";
import { Annotation, EditorState, type Extension, type Text, type Transaction, type TransactionSpec } from "@codemirror/state";
import { drawSelection, EditorView, keymap, lineNumbers } from "@codemirror/view";
import { tags } from "@lezer/highlight";
import { type Problem, problemText } from "./protocol";
import { offersAt, type Schema } from "./scene_schema";

const kUndoSteps = 500;
const kKeptSteps = 200, kMostKept = 500_000; // of them, for another visit, and of its text: the browser's storage is small [characters]
const kTogether = 500; // between two keys that are undone together [ms]

/** Of changes that belong to one drag, whose number it is: they are one step of the history. */
export const gesture = Annotation.define<number>();

const kTheme = EditorView.theme({
  "&": { color: "#e7eaee", backgroundColor: "#111317", height: "100%", fontSize: "12px" },
  ".cm-scroller": { fontFamily: 'ui-monospace, "DejaVu Sans Mono", monospace', lineHeight: "1.5", overflow: "auto" },
  ".cm-content": { caretColor: "#fff" },
  ".cm-cursor": { borderLeftColor: "#fff" },
  ".cm-gutters": { backgroundColor: "#15181d", color: "#8d96a3", border: "none" },
  ".cm-selectionBackground, &.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground": { backgroundColor: "#264a70" },
  "&.cm-focused": { outline: "2px solid #7cc0ff", outlineOffset: "-2px" },
  ".cm-matchingBracket, &.cm-focused .cm-matchingBracket": { backgroundColor: "#33405a", outline: "none" },
  ".cm-tooltip": { backgroundColor: "#21252c", border: "1px solid #4a5361", color: "#e7eaee", maxWidth: "380px" },
  ".cm-tooltip-autocomplete ul li[aria-selected]": { backgroundColor: "#2563a8", color: "#fff" },
  ".cm-tooltip-autocomplete ul li[aria-selected] .cm-completionDetail": { color: "#fff" },
  ".cm-completionDetail": { color: "#aab2bd", fontStyle: "normal" },
  ".cm-diagnostic-error": { borderLeftColor: "#ff8f86" },
  ".cm-diagnostic-warning": { borderLeftColor: "#ffb35c" },
}, { dark: true });

const kColours = HighlightStyle.define([
  { tag: tags.propertyName, color: "#9ccfff" },
  { tag: tags.string, color: "#a9d8a0" },
  { tag: tags.number, color: "#ffc58a" },
  { tag: [tags.bool, tags.null], color: "#d9c7ff" },
  { tag: [tags.separator, tags.squareBracket, tags.brace], color: "#aab2bd" },
]);

/** The history: a drag is one step, and so are neighbouring keys within a moment. */
function steps(): Extension {
  let before: { gesture: number | undefined; time: number } = { gesture: undefined, time: 0 };
  const remember = EditorView.updateListener.of((update) => {
    for (const change of update.transactions) if (change.docChanged) before = { gesture: change.annotation(gesture), time: Date.now() };
  });
  const joinToEvent = (change: Transaction, isAdjacent: boolean) => {
    const own = change.annotation(gesture);
    return own !== undefined || before.gesture !== undefined ? own === before.gesture : isAdjacent && Date.now() - before.time < kTogether;
  };
  return [history({ minDepth: kUndoSteps, newGroupDelay: Infinity, joinToEvent }), remember];
}

interface KeptState {
  doc: string;
  history: { done: unknown[]; undone: unknown[] };
}

/** The newest steps of the history as text, as many as fit; null: not one does. */
export function keptHistory(state: EditorState): string | null {
  const { history: all, ...rest } = state.toJSON({ history: historyField }) as KeptState;
  for (let steps = kKeptSteps; steps >= 1; steps = Math.floor(steps / 2)) {
    const text = JSON.stringify({ ...rest, history: { done: all.done.slice(-steps), undone: all.undone.slice(-steps) } });
    if (text.length <= kMostKept) return text;
  }
  return null;
}

/** A state that goes on with a history that keptHistory() made; null: it ends in another text, or nothing `hasToUndo` what led there. */
export function withHistory(kept: string | null, text: string, hasToUndo: boolean, extensions: Extension[]): EditorState | null {
  try {
    const json = JSON.parse(kept ?? "null") as KeptState | null;
    if (json?.doc !== text) return null;
    const state = EditorState.fromJSON(json, { extensions }, { history: historyField });
    return hasToUndo && undoDepth(state) === 0 ? null : state;
  } catch {
    return null; // it is of another version of the page
  }
}

/** Everything an editor of a scene has. `schema` may not be known yet. */
export function editorOf(label: string, schema: () => Schema | null, more: Extension[]): Extension[] {
  const complete = (context: CompletionContext): CompletionResult | null => {
    const known = schema();
    if (!known || (!context.explicit && !context.matchBefore(/["\w]+/))) return null;
    const offers = offersAt(context.state.doc.toString(), context.pos, known);
    if (offers.length === 0) return null;
    const options = offers.map((offer): Completion => ({
      label: offer.label, detail: offer.detail, info: offer.info || undefined, type: offer.isKey ? "property" : "enum",
      apply: (view, _, __, to) => {
        const text = view.state.doc.toString();
        const end = text[to] === '"' && text[offer.from] === '"' ? to + 1 : to;
        view.dispatch({ changes: { from: offer.from, to: end, insert: offer.insert }, selection: { anchor: offer.from + offer.insert.length }, userEvent: "input.complete" });
      },
    }));
    const from = offers[0].from + (context.state.sliceDoc(offers[0].from, offers[0].from + 1) === '"' ? 1 : 0);
    return { from: Math.min(from, context.pos), options, validFor: /^\w*$/ };
  };
  return [
    lineNumbers(), EditorView.lineWrapping, steps(), drawSelection(), json(), bracketMatching(), closeBrackets(),
    syntaxHighlighting(kColours), kTheme, autocompletion({ override: [complete], icons: false }),
    EditorState.tabSize.of(2), EditorView.contentAttributes.of({ "aria-label": label, spellcheck: "false", tabindex: "0" }),
    keymap.of([...completionKeymap, ...closeBracketsKeymap, ...defaultKeymap, ...historyKeymap]),
    ...more,
  ];
}

/** Line and column of a problem, counted from 1; null: it has none. */
export function placeOf(problem: Problem): { line: number; column: number } | null {
  const found = /:(\d+):(\d+)$/.exec(problem.where);
  return found ? { line: Number(found[1]), column: Number(found[2]) } : null;
}

/** The part of a text that a problem is about: from its place to the end of that value, or of the line. */
export function rangeOf(doc: Text, problem: Problem): { from: number; to: number } | null {
  const place = placeOf(problem);
  if (!place || place.line > doc.lines) return null;
  const line = doc.line(place.line), from = Math.min(line.from + place.column - 1, line.to);
  const rest = doc.sliceString(from, line.to);
  const length = /^"(?:[^"\\]|\\.)*"|^[\w.+-]+|^\[[^[\]]*\]/.exec(rest)?.[0].length ?? 1;
  return { from, to: Math.min(from + Math.max(length, 1), doc.length) };
}

/** Underlines problems of the text. */
export function underlined(state: EditorState, errors: Problem[], warnings: Problem[]): TransactionSpec {
  const diagnostics: Diagnostic[] = [];
  for (const [list, severity] of [[errors, "error"], [warnings, "warning"]] as const)
    for (const problem of list) {
      const range = rangeOf(state.doc, problem);
      if (range) diagnostics.push({ ...range, severity, message: problemText({ ...problem, where: "" }) });
    }
  return setDiagnostics(state, diagnostics.sort((a, b) => a.from - b.from));
}
