#!/usr/bin/env bash
# rebuild.sh FOLDER: the types are right, and a bundle that is built anew holds the same files as the committed one. The
# compressed bytes may differ, since versions of Node compress differently.
set -eu
cd "$1"
[ -e node_modules/.from-lock.json ] || { echo "skipped: the packages are not there"; exit 77; }
npx --no-install tsc --noEmit
node build.mjs rebuilt.bundle
node --input-type=module -e '
import { readFileSync } from "node:fs";
import { gunzipSync } from "node:zlib";
function files(name) {
  const bytes = readFileSync(name), end = bytes.indexOf("\n\n");
  let at = end + 2;
  return bytes.subarray(0, end).toString().split("\n").map((line) => {
    const [file, size] = line.split(" ");
    return [file, gunzipSync(bytes.subarray(at, (at += Number(size)))).toString("base64")];
  });
}
const same = JSON.stringify(files("rebuilt.bundle")) === JSON.stringify(files("bundle/page.bundle"));
console.log(same ? "the same files" : "error: the committed bundle is not what its sources give");
process.exit(same ? 0 : 1);'
