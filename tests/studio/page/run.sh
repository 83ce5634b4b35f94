#!/usr/bin/env bash
# run.sh TEST.mjs PROGRAM SOURCE PACKAGES SESSIONS PICTURES: runs a browser test.
set -eu
[ -e "$4/node_modules/.from-lock.json" ] || { echo "skipped: the packages are not there"; exit 77; }
[ -x /usr/bin/chromium ] || { echo "skipped: chromium is not installed"; exit 77; }
exec node "$(dirname "$0")/$1" "${@:2}"
