#!/usr/bin/env bash
# another_build.sh VERIFIER SESSION: a session that was led by the mouse replays to the bit in another build.
set -eu
[ -e "$2" ] || { echo "skipped: no browser led a session"; exit 77; }
"$1" verify "$2"
