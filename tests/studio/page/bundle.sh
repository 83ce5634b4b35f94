#!/usr/bin/env bash
# bundle.sh PAGE: the committed bundle was built from the committed sources, and from nothing else.
set -eu
cd "$1"
sha256sum --quiet -c bundle/sources.sha256 || { echo "error: build the page again: npm run build, in studio/page"; exit 1; }
listed=$(sed 's/^[0-9a-f]*  //' bundle/sources.sha256 | sort)
there=$({ printf '%s\n' build.mjs package.json package-lock.json tsconfig.json bundle/page.bundle; find src -type f; } | sort)
diff <(echo "$listed") <(echo "$there") || { echo "error: a source is not in bundle/sources.sha256: npm run build, in studio/page"; exit 1; }
long=$(find src -type f -exec awk 'END { if (NR > 500) print FILENAME ": error: has " NR " lines, at most 500 are allowed" }' {} \;)
[ -z "$long" ] || { echo "$long"; exit 1; }
