#!/usr/bin/env bash
# What the features that a spring-only scene does not use cost it: time of a tick of the whole core over that of a core
# in which they are compiled out. The two run in turn, which of them first in turn too; medians of the ratios of pairs.
#   tests/core/bench/springs_bench.sh build/release/bench [PAIRS]
set -eu -o pipefail
folder=${1:?usage: $0 BENCH_FOLDER [PAIRS]} pairs=${2:-15}
whole=$folder/ctpm_springs_bench_core bare=$folder/ctpm_springs_bench_core_only_springs
for scene in "explicit 9" "explicit 17" "implicit 9" "implicit 17"; do
  for ((i = 0; i < pairs; ++i)); do
    if ((i % 2)); then a=$($whole $scene) b=$($bare $scene); else b=$($bare $scene) a=$($whole $scene); fi
    echo "$a $b"
  done | awk -v scene="$scene" '{ print $1 / $2, $1, $2 }' | sort -n | awk -v scene="$scene" '
    { ratio[NR] = $1; whole[NR] = $2; bare[NR] = $3 }
    END {
      m = int((NR + 1) / 2)
      printf "%s: ratio %.4f, half of %d pairs within %.4f to %.4f; in the median pair %.1f us and %.1f us a tick\n",
        scene, ratio[m], NR, ratio[int((NR + 3) / 4)], ratio[int((3 * NR + 3) / 4)], whole[m] / 1e3, bare[m] / 1e3
    }'
done
