#!/bin/sh
# Puts the shipped sessions into FOLDER for the tests: those that the project holds, or else fresh ones.
#   shipped_sessions.sh PROGRAM SOURCE_DIR FOLDER
set -eu
program=$1 shipped=$2/recordings/shipped folder=$3
rm -rf "$folder"
mkdir -p "$folder"
if ls "$shipped"/*.ctpm >/dev/null 2>&1; then
  cp "$shipped"/*.ctpm "$folder"
else
  "$shipped/record.sh" "$program" "$folder"
fi
