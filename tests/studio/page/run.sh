#!/usr/bin/env bash
# run.sh TEST.mjs PROGRAM SOURCE PACKAGES SESSIONS PICTURES: runs a browser test.
set -eu
[ -e "$4/node_modules/.from-lock.json" ] || { echo "skipped: the packages are not there"; exit 77; }
[ -x /usr/bin/chromium ] || { echo "skipped: chromium is not installed"; exit 77; }
set -- "$(dirname "$0")/$1" "${@:2}"
# Nothing here needs a network but this machine's own loopback: where a user may take it away, it is. A privileged user keeps
# the privileges by which ticks go before a browser.
up="PATH=\"\$PATH:/usr/sbin:/sbin\" ip link set lo up"
for away in "unshare -n" "unshare -rn"; do
  $away sh -c "$up" 2>/dev/null && exec env CTPM_HAS_NO_NETWORK=1 $away sh -c "$up && exec \"\$@\"" sh node "$@"
done
echo "the network stays: this machine does not let its user take it away (unshare -n or -rn, ip)"
exec node "$@"
