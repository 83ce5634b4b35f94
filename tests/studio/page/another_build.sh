#!/usr/bin/env bash
# another_build.sh VERIFIER SESSION: the end of a session that was led by the mouse, in which it cuts, replays to the bit in another
# build. Without optimisation each tick takes several milliseconds; Page.a_session_by_mouse_verifies_across_compilers replays all of it.
set -eu
[ -e "$2" ] || { echo "skipped: no browser led a session"; exit 77; }
"$1" verify-end 3000 "$2"
