#!/usr/bin/env bash
# finds_broken_rules.sh LAYERING: runs it on broken/ and compares what it prints with broken/expected.txt.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
# One file is too long to be stored.
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
cp -r "$here/broken/." "$tree"
for ((line = 0; line < 501; ++line)); do echo "// $line"; done >"$tree/tests/long.cpp"
code=0
printed=$("$1" --namespaces "$tree") || code=$?
diff <(sort "$here/broken/expected.txt") <(sort <<<"$printed") || { echo "error: other rules were found than broken/expected.txt lists"; exit 1; }
[ "$code" = 1 ] || { echo "error: exit code $code instead of 1"; exit 1; }
