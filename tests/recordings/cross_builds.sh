#!/bin/sh
# A session recorded by one build must verify in every other build. Each build simulates the inputs of each SESSION and
# records them; then each build verifies all recordings, and each SESSION itself.
#   cross_builds.sh SOURCE_DIR WORK_DIR SESSION...
# CTPM_BUILDS: the builds, separated by blanks, each a compiler and its flags joined by colons.
# Exit code 77: a compiler is missing.
set -eu
source=$1 work=$2
shift 2
for session in "$@"; do
  [ -e "$session" ] || { echo "skipped: $session is not there"; exit 77; }
done
builds=${CTPM_BUILDS:-g++:-O3 clang++:-O0}

number=0
for build in $builds; do
  compiler=${build%%:*}
  flags=$(echo "${build#*:}" | tr ':' ' ')
  command -v "$compiler" >/dev/null || { echo "$compiler is not installed"; exit 77; }
  number=$((number + 1))
  folder=$work/build$number
  cmake -S "$source" -B "$folder" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Plain \
    -DCMAKE_CXX_FLAGS="$flags" -DCTPM_BUILD_TESTS=ON -DCTPM_BUILD_IMPORTERS=OFF -DCTPM_BUILD_SCENES=OFF \
    -DCTPM_BUILD_STUDIO=OFF >"$work.log" 2>&1 || { cat "$work.log"; exit 1; }
  ninja -C "$folder" ctpm_cross_build >"$work.log" 2>&1 || { tail -n 40 "$work.log"; exit 1; }
  rm -rf "$folder/sessions"
  mkdir -p "$folder/sessions"
  for session in "$@"; do
    "$folder/tests/ctpm_cross_build" record "$session" "$folder/sessions/$(basename "$session")"
  done
done

verdict=0
number=0
for build in $builds; do
  number=$((number + 1))
  echo "verified by $build:"
  "$work/build$number/tests/ctpm_cross_build" verify "$work"/build*/sessions/*.ctpm "$@" || verdict=1
done
exit $verdict
