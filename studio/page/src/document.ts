// A scene's text while its author works on it: one history for everything that changes it, a draft until it is saved.
import { redo, redoDepth, undo, undoDepth } from "@codemirror/commands";
import { EditorState, Transaction } from "@codemirror/state";
import { EditorView } from "@codemirror/view";
import { findNodeAtLocation, getLocation, type JSONPath, parseTree } from "jsonc-parser";
import type { Connection } from "./connection";
import { dropDraft, type FileText, onDraftElsewhere, putDraft, putHistory, readDraft, readHistory } from "./drafts";
import { applied, type Change, differences, findJson, type Json, parseJson, removeValue, setValue } from "./json_edit";
import { editorOf, gesture, keptHistory, rangeOf, underlined, withHistory } from "./json_editor";
import { CallFailed, type Problem } from "./protocol";
import type { Schema } from "./scene_schema";
import { sceneName } from "./text";

const kOneStep = 500; // changes of the same values that follow each other within it are one step [ms]
const kKeepAfter = 300; // without a change the history is kept for the next visit [ms]

/** What became of the file since it was read, by somebody else's hand. */
export type OnDisk = "same" | "changed" | "gone";

export class SceneDocument {
  readonly host = document.createElement("div"); // of the editor, for whoever shows it
  readonly view: EditorView;
  onChange: () => void = () => {}; // text, history or what is saved
  onPlace: (path: JSONPath) => void = () => {}; // the cursor was put there by hand
  private before: string | null = null; // a change that goes on began with this
  private gestures = 0; // begun so far
  private last: { what: string; text: string; at: number } | null = null; // the change that preview() made last
  onDisk: OnDisk = "same";
  private drafted: string | null = null; // the draft that it began with
  private keeping: ReturnType<typeof setTimeout> | null = null; // until the history is kept; null: it is
  private followed = -Infinity; // when it followed last [ms]
  private isFollowing = false; // a text that another tab keeps
  private isBehind = false; // what another tab made of the scene, while nobody sees this one
  private valid: Json | undefined;
  private parsed: { text: string; value: Json | undefined } | null = null;

  private constructor(public connection: Connection, public path: string, private saved: string, private revision: string, text: string, schema: () => Schema | null) {
    this.host.className = "editor";
    // In a root of its own, the editor's styles are objects and not elements, which the page's security policy refuses.
    const root = this.host.attachShadow({ mode: "open" });
    const listen = EditorView.updateListener.of((update) => {
      if (update.docChanged) this.remember(), this.onChange();
      if (update.selectionSet && update.transactions.some((t) => t.isUserEvent("select.pointer")))
        this.onPlace(getLocation(this.text, update.state.selection.main.head).path);
    });
    const extensions = editorOf("The text of the scene", schema, [listen]);
    const state = withHistory(readHistory(path), text, text !== saved, extensions) ?? EditorState.create({ doc: saved, extensions });
    this.view = new EditorView({ state, root, parent: root });
    this.setText(text, ++this.gestures); // without its history a draft is one step after the file
    if (text !== saved) this.drafted = text;
    else dropDraft(path);
    addEventListener("pagehide", () => this.keepHistory());
    onDraftElsewhere(() => this.path, (draft) => {
      this.isBehind = document.hidden;
      if (!this.isBehind) void this.follow(draft);
    });
    addEventListener("visibilitychange", () => {
      if (this.isBehind && !document.hidden) this.isBehind = false, void this.follow(readDraft(this.path)?.text ?? null);
    });
  }

  /** Reads a scene and the draft of it that this browser kept. A draft of another text than the file has by now stays one
      of that text, so that it is not written over the file unasked. */
  static async open(connection: Connection, path: string, schema: () => Schema | null): Promise<SceneDocument> {
    const file = await readText(connection, path), draft = readDraft(path);
    const began = draft?.file && draft.text !== file.text ? draft.file : file;
    const made = new SceneDocument(connection, path, began.text, began.revision, draft?.text ?? file.text, schema);
    made.onDisk = began.revision === file.revision ? "same" : "changed";
    return made;
  }

  get text(): string {
    return this.view.state.doc.toString();
  }

  /** The text's value, without its comments; undefined: it is no JSON. */
  get value(): Json | undefined {
    const { text } = this;
    if (this.parsed?.text !== text) {
      const value = parseJson(text);
      this.valid = value ?? this.valid;
      this.parsed = { text, value };
    }
    return this.parsed.value;
  }

  /** The value of the last text that was JSON. */
  get lastValue(): Json | undefined {
    return this.value ?? this.valid;
  }

  /** The value of the text before the change that goes on, if one does. */
  get begun(): Json | undefined {
    return this.before === null ? this.value : parseJson(this.before);
  }

  get isChanged(): boolean {
    return this.text !== this.saved;
  }
  /** Whether the text is the draft that it began with. */
  get isOfEarlierVisit(): boolean {
    return this.isChanged && this.text === this.drafted;
  }
  get canUndo(): boolean {
    return undoDepth(this.view.state) > 0;
  }
  get canRedo(): boolean {
    return redoDepth(this.view.state) > 0;
  }
  /** What undo() or redo() would change, as the path to all of it in a value; null: nothing that can be told. */
  whatChanges(step: typeof undo): { path: JSONPath; value: Json } | null {
    let text: string | null = null;
    step({ state: this.view.state, dispatch: (change) => (text = change.newDoc.toString()) });
    const { value } = this, after = text === null ? undefined : parseJson(text);
    if (value === undefined || after === undefined) return null;
    const [path, ...others] = differences(value, after, []).map(([path]) => path);
    if (!path) return null;
    const apart = path.findIndex((key, i) => others.some((other) => other[i] !== key)), common = apart < 0 ? path : path.slice(0, apart);
    const [now, then] = [findJson(value, common), findJson(after, common)], whole = now === undefined ? after : value;
    if (!Array.isArray(now) || !Array.isArray(then) || Math.abs(now.length - then.length) !== 1) return { path: common, value: whole };
    // One entry more or less: it is where the lists begin to differ.
    const [longer, shorter] = now.length > then.length ? [now, then] : [then, now];
    const entry = longer.findIndex((member, i) => JSON.stringify(member) !== JSON.stringify(shorter[i]));
    return { path: [...common, entry], value: longer === now ? value : after };
  }
  undo(): void {
    this.commit();
    this.last = null;
    undo(this.view);
  }
  redo(): void {
    this.last = null;
    redo(this.view);
  }

  /** Sets values as one step of the history; undefined removes. Nothing happens while the text is no JSON. */
  set(values: [JSONPath, Json | undefined][]): void {
    if (this.value === undefined) return; // what is no JSON is not changed but by hand
    this.commit();
    this.last = null;
    this.setText(changed(this.text, values), ++this.gestures);
  }

  /** As set(), for a change that goes on: each call begins with the text before the first; all until commit() are one step,
      and so is what follows within half a second and changes the same values. */
  preview(values: [JSONPath, Json | undefined][]): void {
    if (this.value === undefined) return;
    const what = JSON.stringify(values.map(([path, value]) => [path, value === undefined]));
    if (this.before === null) {
      this.before = this.text;
      const { last } = this, goesOn = last?.what === what && last.text === this.text && performance.now() - last.at < kOneStep;
      if (!goesOn) ++this.gestures;
    }
    this.setText(changed(this.before, values), this.gestures);
    this.last = { what, text: this.text, at: performance.now() };
  }
  commit(): void {
    this.before = null;
  }

  /** Writes the file, unless somebody else did since it was read. */
  async save(): Promise<void> {
    this.commit();
    const { text } = this;
    if (text === this.saved) return;
    this.took({ text, revision: (await this.connection.call<{ revision: string }>("scene.write", { path: this.path, text, revision: this.revision })).revision });
  }

  /** Writes the text as it is now into a file that is not there yet, under that file's name; this one stays as it is. */
  async saveCopy(path: string): Promise<void> {
    // Sessions are known by the scene's name, which is mostly that of its file.
    const isNamedSo = findJson(this.value, ["name"]) === nameOf(this.path);
    const text = isNamedSo ? changed(this.text, [[["name"], nameOf(path)]]) : this.text;
    await this.connection.call("scene.write", { path, text, revision: kNoFile });
  }

  /** Goes back to what the file says now; undo brings the changes back. */
  async reread(): Promise<void> {
    const file = await readText(this.connection, this.path);
    this.before = this.last = this.drafted = null;
    this.setText(file.text, ++this.gestures);
    this.took(file);
  }

  /** Stays with this text though the file is another one by now: the next save writes over that. */
  async keep(): Promise<void> {
    const file = await this.readFile();
    this.drafted = null;
    this.took(file ?? { text: "", revision: kNoFile });
  }

  /** Looks whether the file is another one than was read or written here, or gone. */
  async lookOnDisk(): Promise<void> {
    const { revision, onDisk, path } = this, file = await this.readFile();
    if (revision !== this.revision || path !== this.path) return; // it was saved, read or renamed meanwhile
    if (file && file.revision !== revision && file.text === this.text) return this.took(file); // somebody else wrote the same
    this.onDisk = (file?.revision ?? kNoFile) === revision ? "same" : file ? "changed" : "gone";
    if (this.onDisk !== onDisk) this.onChange();
  }

  /** Takes what another tab made of the same scene, as one step: its author has one text wherever they look. null: the other
      tab saved it, or went back to its file. */
  private async follow(draft: string | null): Promise<void> {
    const file = draft === null ? await this.readFile() : readDraft(this.path)?.file;
    if (!file || (draft === null && readDraft(this.path))) return; // it is gone, or it was changed again
    const now = performance.now();
    if (now - this.followed > kOneStep) ++this.gestures; // what is typed there without a break is one step here too
    this.followed = now;
    this.isFollowing = true;
    this.before = this.last = null;
    this.setText(draft ?? file.text, this.gestures);
    this.took(file);
    this.isFollowing = false;
  }

  /** From now on changes are those to this file. */
  private took(file: FileText): void {
    this.saved = file.text, this.revision = file.revision, this.onDisk = "same";
    this.remember();
    this.onChange();
  }

  /** The file as it is now; null: there is none. */
  private async readFile(): Promise<FileText | null> {
    try {
      return await readText(this.connection, this.path);
    } catch (failure) {
      if (failure instanceof CallFailed) return null;
      throw failure;
    }
  }

  underline(errors: Problem[], warnings: Problem[]): void {
    this.view.dispatch(underlined(this.view.state, errors, warnings));
  }

  /** Puts the cursor where a problem is. */
  goToProblem(problem: Problem): void {
    const range = rangeOf(this.view.state.doc, problem);
    if (!range) return;
    this.view.dispatch({ selection: { anchor: range.from, head: range.to }, effects: EditorView.scrollIntoView(range.from, { y: "center" }) });
    this.view.focus();
  }

  /** Shows and selects the value at a path, without taking the focus. */
  reveal(path: JSONPath): void {
    const root = parseTree(this.text), node = root && findNodeAtLocation(root, path);
    if (!node) return;
    // It may come in the middle of a drag, which stays one step.
    this.view.dispatch({ selection: { anchor: node.offset, head: node.offset + node.length }, annotations: Transaction.addToHistory.of(false) });
    // The text scrolls, and not the page with it: in a narrow window it is below the picture.
    const { scrollDOM } = this.view;
    scrollDOM.scrollTop = this.view.lineBlockAt(node.offset).top - scrollDOM.clientHeight / 2;
  }

  /** Changes the text where it differs, as a part of a gesture: parts of another one are other steps. */
  private setText(text: string, part: number): void {
    const old = this.text;
    if (text === old) return;
    let from = 0, tail = 0;
    while (from < old.length && old[from] === text[from]) ++from;
    while (tail < Math.min(old.length, text.length) - from && old[old.length - 1 - tail] === text[text.length - 1 - tail]) ++tail;
    this.view.dispatch({
      changes: { from, to: old.length - tail, insert: text.slice(from, text.length - tail) },
      annotations: gesture.of(part),
    });
  }

  /** Keeps the text as a draft at once, while it is none of the file's, and its history soon. */
  private remember(): void {
    if (this.isFollowing) return; // the other tab may be further by now
    const { text, path, saved, revision } = this;
    if (text === saved) dropDraft(path);
    else putDraft(path, text, { text: saved, revision });
    clearTimeout(this.keeping ?? undefined);
    this.keeping = setTimeout(() => this.keepHistory(), kKeepAfter);
  }

  /** Keeps the history, unless it is kept as it is. */
  keepHistory(): void {
    if (this.keeping === null) return;
    clearTimeout(this.keeping);
    this.keeping = null;
    putHistory(this.path, keptHistory(this.view.state));
  }
}

const nameOf = (path: string) => sceneName(path).replace(/^.*\//, "");
const kNoFile = "none"; // revision of a file that is not there

/** A scene's file as the editor has it: each of its lines ends with the same character. */
async function readText(connection: Connection, path: string): Promise<FileText> {
  const { text, revision } = await connection.call<FileText>("scene.read", { path });
  return { text: text.replace(/\r\n?/g, "\n"), revision };
}

/** Drops drafts that say what their files say by now. Whether there were any. */
export async function dropNeedlessDrafts(connection: Connection, paths: string[]): Promise<boolean> {
  const isNeedless = async (path: string) => {
    const file = await readText(connection, path).catch(() => null);
    const isSame = file !== null && readDraft(path)?.text === file.text;
    if (isSame) dropDraft(path);
    return isSame;
  };
  return (await Promise.all(paths.map(isNeedless))).includes(true);
}

function changed(text: string, values: [JSONPath, Json | undefined][]): string {
  for (const [path, value] of values) {
    const change: Change | null = value === undefined ? removeValue(text, path) : setValue(text, path, value);
    if (change) text = applied(text, change);
  }
  return text;
}
