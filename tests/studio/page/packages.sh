#!/usr/bin/env bash
# packages.sh PAGE FOLDER: a copy of the page in FOLDER with the packages that its lock file names.
set -eu
page=$1 folder=$2
command -v node >/dev/null && command -v npm >/dev/null || { echo "skipped: node or npm is missing"; exit 77; }
mkdir -p "$folder"
rm -rf "$folder/src" "$folder/bundle"
cp -r "$page/src" "$page/bundle" "$folder"
cp "$page"/*.json "$page"/*.mjs "$folder"
cd "$folder"
cmp -s package-lock.json node_modules/.from-lock.json && exit 0
npm ping >/dev/null 2>&1 || { echo "skipped: the npm registry is out of reach"; exit 77; }
npm ci --ignore-scripts --no-audit --no-fund
cp package-lock.json node_modules/.from-lock.json
