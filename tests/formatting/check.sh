#!/usr/bin/env bash
# check.sh FOLDER: an error for every line of its *.h, *.cpp and *.inl files that clang-format 14 would change; broken
# trees of tests below it are left out.
set -eu -o pipefail
cd "$1"
formatter=$(command -v clang-format-14 || command -v clang-format || true)
[ -n "$formatter" ] || { echo "error: clang-format is not installed"; exit 1; }
case $("$formatter" --version) in
  *"version 14."*) ;;
  *) echo "skipped: $("$formatter" --version); versions other than 14 format differently"; exit 77 ;;
esac
find . \( -name build -o -name out -o -name .git -o -path './tests/*/broken' \) -prune -o \
  -type f \( -name '*.h' -o -name '*.cpp' -o -name '*.inl' \) -print0 |
  xargs -0 -n 16 -P "$(nproc)" "$formatter" --dry-run -Werror --style=file 2>&1 |
  sed -n 's/error: code should be clang-formatted.*/error: not formatted by .clang-format/p' || exit 1
