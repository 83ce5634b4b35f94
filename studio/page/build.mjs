// Builds the page into one file: a table of "NAME SIZE" lines, an empty line, and the files, each compressed by gzip.
//   node build.mjs [BUNDLE]    writes bundle/page.bundle and bundle/sources.sha256, or another bundle alone
import { build } from "esbuild";
import { createHash } from "node:crypto";
import { mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const here = dirname(fileURLToPath(import.meta.url));
process.chdir(here);

const made = await build({
  entryPoints: { app: "src/main.tsx", style: "src/style.css" },
  outdir: "/",
  bundle: true,
  minify: true,
  write: false,
  format: "esm",
  target: "es2022",
  jsx: "automatic",
  jsxImportSource: "preact",
  legalComments: "eof",
  define: { "process.env.NODE_ENV": '"production"' },
});
const files = [["index.html", readFileSync("src/index.html")]];
for (const file of made.outputFiles) files.push([file.path.replace(/^\/+/, ""), Buffer.from(file.contents)]);
files.sort((a, b) => (a[0] < b[0] ? -1 : 1));

const packed = files.map(([name, bytes]) => [name, gzipSync(bytes, { level: 9 })]);
const table = packed.map(([name, bytes]) => `${name} ${bytes.length}\n`).join("") + "\n";
const target = process.argv[2] ?? "bundle/page.bundle";
mkdirSync(dirname(target), { recursive: true });
writeFileSync(target, Buffer.concat([Buffer.from(table), ...packed.map(([, bytes]) => bytes)]));

if (!process.argv[2]) {
  const sources = ["build.mjs", "package.json", "package-lock.json", "tsconfig.json"];
  for (const file of readdirSync("src", { recursive: true }).map(String).sort())
    if (/\.(tsx?|css|html)$/.test(file)) sources.push(join("src", file));
  const hash = (file) => createHash("sha256").update(readFileSync(file)).digest("hex");
  writeFileSync("bundle/sources.sha256", [...sources, "bundle/page.bundle"].map((f) => `${hash(f)}  ${f}\n`).join(""));
}
for (const [name, bytes] of files) console.log(`${name}: ${bytes.length} bytes`);
