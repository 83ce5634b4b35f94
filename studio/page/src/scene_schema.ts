// What the schema of scenes says about a place in the text.
import { getLocation, type JSONPath, type Node, parseTree } from "jsonc-parser";
import { type Json, written } from "./json_edit";

export interface Schema {
  description?: string;
  type?: string | string[];
  properties?: Record<string, Schema>;
  required?: string[];
  items?: Schema;
  enum?: unknown[];
  const?: unknown;
  default?: unknown;
  minimum?: number;
  maximum?: number;
  $ref?: string;
  $defs?: Record<string, Schema>;
}

export interface Offer {
  label: string;
  insert: string;
  detail: string; // type and range
  info: string; // the sentence of the key
  from: number; // what it replaces begins here
  isKey: boolean;
}

function resolved(schema: Schema | undefined, root: Schema): Schema | undefined {
  const name = schema?.$ref && /^#\/\$defs\/(.*)$/.exec(schema.$ref)?.[1];
  return name ? { ...root.$defs?.[name], ...(schema!.description ? { description: schema!.description } : {}) } : schema;
}

/** The schema of the value at a path; undefined: it does not say. */
export function schemaAt(root: Schema, path: JSONPath): Schema | undefined {
  let here: Schema | undefined = root;
  for (const key of path) here = resolved(typeof key === "number" ? here?.items : here?.properties?.[key], root);
  return here;
}

function detailOf(schema: Schema): string {
  const range = schema.minimum !== undefined || schema.maximum !== undefined ? ` ${schema.minimum ?? ""}..${schema.maximum ?? ""}` : "";
  return `${schema.enum ? "choice" : schema.const !== undefined ? "constant" : (schema.type ?? "")}${range}`;
}

/** A value to begin with. */
function beginOf(schema: Schema): string {
  if (schema.const !== undefined) return JSON.stringify(schema.const);
  if (schema.default !== undefined) return written(schema.default as Json, "");
  if (schema.enum) return JSON.stringify(schema.enum[0]);
  if (schema.type === "string") return '""';
  if (schema.type === "array") return schema.items?.type === "number" ? "[0, 0, 0]" : "[]";
  if (schema.type === "object") return "{}";
  if (schema.type === "boolean") return "false";
  return "0";
}

/** What may stand at a place of the text. */
export function offersAt(text: string, at: number, root: Schema): Offer[] {
  const location = getLocation(text, at), node = location.previousNode;
  const begun = at - /"?\w*$/.exec(text.slice(0, at))![0].length; // of a word that is not a whole value yet
  const inNode = node && at >= node.offset && at <= node.offset + node.length;
  if (location.isAtPropertyKey) {
    const object = schemaAt(root, location.path.slice(0, -1));
    const own = objectAround(parseTree(text), at);
    const present = new Set((own?.children ?? []).map((p) => p.children![0].value as string));
    const from = inNode && node.type === "string" ? node.offset : begun;
    const hasValue = /^"?[^"\n]*"?\s*:/.test(text.slice(at));
    return Object.entries(object?.properties ?? {}).filter(([key]) => !present.has(key) || (inNode && node.value === key)).map(([key, raw]) => {
      const schema = resolved(raw, root)!;
      return {
        label: key, insert: hasValue ? JSON.stringify(key) : `${JSON.stringify(key)}: ${beginOf(schema)}`,
        detail: (object?.required?.includes(key) ? "required " : "") + detailOf(schema), info: schema.description ?? "", from, isKey: true,
      };
    });
  }
  const schema = schemaAt(root, location.path);
  const values = schema?.enum ?? (schema?.const !== undefined ? [schema.const] : schema?.type === "boolean" ? [true, false] : []);
  const from = inNode && node.type !== "object" && node.type !== "array" ? node.offset : begun;
  return values.map((value) => ({
    label: String(value), insert: JSON.stringify(value), detail: detailOf(schema!), info: schema!.description ?? "", from, isKey: false,
  }));
}

/** The innermost object around a place. */
function objectAround(node: Node | undefined, at: number): Node | null {
  if (!node || at < node.offset || at > node.offset + node.length) return null;
  for (const child of node.children ?? []) {
    const found = objectAround(child, at);
    if (found) return found;
  }
  return node.type === "object" ? node : null;
}
