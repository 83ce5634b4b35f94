// Changes of single values in JSON text, which leave the rest of the text, comments too, as its author wrote it.
import { createScanner, findNodeAtLocation, type JSONPath, type Node, parse, type ParseError, parseTree, SyntaxKind } from "jsonc-parser";

export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };

/** A part of a text, and what stands there instead. */
export interface Change {
  from: number;
  to: number;
  insert: string;
}

/** The value of a text with comments; undefined: it is no JSON. */
export function parseJson(text: string): Json | undefined {
  const errors: ParseError[] = [];
  const value = parse(text, errors) as Json | undefined;
  return errors.length === 0 ? value : undefined;
}

const kLine = 100; // characters that stay on one line
const kStep = "  ";

/** A value as text: on one line if it is short, else a line for each of its members. `indent`: that of its first line. */
export function written(value: Json, indent: string): string {
  if (value === null || typeof value !== "object") return JSON.stringify(value);
  const isList = Array.isArray(value);
  const within = indent + kStep;
  const members = (deep: string) => isList ? value.map((v) => written(v, deep)) : Object.entries(value).map(([k, v]) => `${JSON.stringify(k)}: ${written(v, deep)}`);
  const short = members(indent).join(", ");
  if (isList && value.every((v) => typeof v === "number")) return `[${short}]`;
  if (short.length <= kLine && !short.includes("\n")) return isList ? `[${short}]` : short ? `{ ${short} }` : "{}";
  return `${isList ? "[" : "{"}\n${members(within).map((m) => within + m).join(",\n")}\n${indent}${isList ? "]" : "}"}`;
}

/** The blanks with which the line of that place begins. */
function indentAt(text: string, at: number): string {
  return /^[ \t]*/.exec(text.slice(text.lastIndexOf("\n", at - 1) + 1, at))![0];
}

/** Where the next token of that kind begins, from a place on; -1: there is none. */
function findToken(text: string, kind: SyntaxKind, from: number, to: number): number {
  const scanner = createScanner(text.slice(from, to));
  for (let token = scanner.scan(); token !== SyntaxKind.EOF; token = scanner.scan()) if (token === kind) return from + scanner.getTokenOffset();
  return -1;
}

function hasComment(text: string): boolean {
  return findToken(text, SyntaxKind.LineCommentTrivia, 0, text.length) >= 0 || findToken(text, SyntaxKind.BlockCommentTrivia, 0, text.length) >= 0;
}

/** Adds a member after the last one of an object or a list. */
function added(text: string, node: Node, member: (indent: string) => string): Change {
  const last = node.children?.at(-1), nodeEnd = node.offset + node.length;
  if (!last) {
    const indent = indentAt(text, node.offset), body = member(indent);
    const [open, close] = node.type === "array" ? ["[", "]"] : ["{ ", " }"];
    if (hasComment(text.slice(node.offset, nodeEnd))) {
      const end = node.offset + text.slice(node.offset, nodeEnd - 1).trimEnd().length;
      return { from: end, to: nodeEnd - 1, insert: `\n${indent}${kStep}${member(indent + kStep)}\n${indent}` };
    }
    return { from: node.offset, to: node.offset + node.length, insert: open + body + close };
  }
  const end = last.offset + last.length;
  // Members that have lines of their own get a new line.
  const before = text.slice(node.offset, node.children![0].offset);
  const isCommented = hasComment(text.slice(node.offset, nodeEnd));
  if (!before.includes("\n") && !isCommented) {
    const indent = indentAt(text, node.offset), body = member(indent);
    if (node.length + body.length <= kLine) return { from: end, to: end, insert: `, ${body}` };
    // The line would become too long: each member gets a line of its own.
    const members = [...node.children!.map((child) => text.slice(child.offset, child.offset + child.length)), member(indent + kStep)];
    const [open, close] = node.type === "array" ? ["[", "]"] : ["{", "}"];
    return { from: node.offset, to: node.offset + node.length, insert: `${open}\n${members.map((m) => indent + kStep + m).join(",\n")}\n${indent}${close}` };
  }
  // What is said about the last member on its line stays there.
  const indent = indentAt(text, last.offset), line = text.indexOf("\n", end);
  const rest = line >= 0 && line < nodeEnd ? text.slice(end, line).trimEnd() : "";
  return { from: end, to: end + rest.length, insert: `,${rest}\n${indent}${member(indent)}` };
}

/** Sets the value at a path; what is missing on the way is made, and a list takes new values at its end. Null: the text cannot take it. */
export function setValue(text: string, path: JSONPath, value: Json): Change | null {
  const root = parseTree(text);
  if (!root) return null;
  const present = findNodeAtLocation(root, path);
  if (present?.type === "array" && Array.isArray(value) && value.length === present.children?.length && hasComment(text.slice(present.offset, present.offset + present.length))) {
    // Comments stand between the numbers.
    let insert = "", at = present.offset;
    present.children.forEach((child, i) => {
      insert += text.slice(at, child.offset) + written(value[i], "");
      at = child.offset + child.length;
    });
    return { from: present.offset, to: present.offset + present.length, insert: insert + text.slice(at, present.offset + present.length) };
  }
  if (present) return { from: present.offset, to: present.offset + present.length, insert: written(value, indentAt(text, present.offset)) };
  for (let depth = path.length - 1; depth >= 0; --depth) {
    const parent = depth === 0 ? root : findNodeAtLocation(root, path.slice(0, depth));
    if (!parent) continue;
    // What is missing below the parent becomes a part of the value.
    let whole = value;
    for (const key of path.slice(depth + 1).reverse()) whole = typeof key === "number" ? [whole] : { [key]: whole };
    const key = path[depth];
    if (parent.type === "array" && typeof key === "number") return added(text, parent, (indent) => written(whole, indent));
    if (parent.type === "object" && typeof key === "string")
      return added(text, parent, (indent) => `${JSON.stringify(key)}: ${written(whole, indent)}`);
    return null;
  }
  return null;
}

/** Removes the member at a path with its comma. Null: there is none. */
export function removeValue(text: string, path: JSONPath): Change | null {
  const root = parseTree(text);
  const value = root && findNodeAtLocation(root, path);
  if (!value) return null;
  const member = value.parent?.type === "property" ? value.parent : value;
  const siblings = member.parent?.children ?? [];
  const i = siblings.indexOf(member), end = member.offset + member.length;
  if (siblings.length === 1 && !hasComment(text.slice(member.parent!.offset, member.parent!.offset + member.parent!.length)))
    return { from: member.parent!.offset + 1, to: member.parent!.offset + member.parent!.length - 1, insert: "" };
  if (siblings.length === 1) return { from: member.offset, to: end, insert: "" };
  const isLast = i === siblings.length - 1;
  const from = i > 0 ? siblings[i - 1].offset + siblings[i - 1].length : member.offset, next = isLast ? end : siblings[i + 1].offset;
  if (i > 0 && !hasComment(text.slice(from, member.offset))) return { from, to: end, insert: "" };
  if (!isLast) return { from: member.offset, to: next, insert: withoutComma(text, end, next).trimStart() };
  // Comments between the two stay; what follows must not become a part of one.
  const kept = withoutComma(text, from, member.offset).trimEnd();
  return { from, to: end, insert: /^\s*\n/.test(text.slice(end)) ? kept : `${kept}\n` };
}

/** A part of a text without its first comma. */
function withoutComma(text: string, from: number, to: number): string {
  const comma = findToken(text, SyntaxKind.CommaToken, from, to);
  return comma < 0 ? text.slice(from, to) : text.slice(from, comma) + text.slice(comma + 1, to);
}

export function applied(text: string, change: Change): string {
  return text.slice(0, change.from) + change.insert + text.slice(change.to);
}

/** The value at a path; undefined: there is none. */
export function findJson(value: Json | undefined, path: JSONPath): Json | undefined {
  for (const key of path) {
    if (typeof value !== "object" || value === null) return undefined;
    value = Array.isArray(value) ? value[key as number] : value[key as string];
  }
  return value;
}

/** The values below a path that are others afterwards; undefined: one that is gone. */
export function differences(before: Json | undefined, after: Json | undefined, path: JSONPath): [JSONPath, Json | undefined][] {
  if (JSON.stringify(before) === JSON.stringify(after)) return [];
  const isDeep = (value: Json | undefined) => typeof value === "object" && value !== null;
  const isAlike = isDeep(before) && isDeep(after) && Array.isArray(before) === Array.isArray(after);
  if (!isAlike || (Array.isArray(before) && (before.length !== (after as Json[]).length || !before.some(isDeep)))) return [[path, after]];
  const keys = Array.isArray(before) ? [...before.keys()] : [...new Set([...Object.keys(before!), ...Object.keys(after!)])];
  return keys.flatMap((key) => differences(findJson(before, [key]), findJson(after, [key]), [...path, key]));
}
