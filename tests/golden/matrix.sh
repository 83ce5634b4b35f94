#!/usr/bin/env bash
# Builds core and the golden sessions with several compilers and optimisations and for two processors, and compares the
# printed hashes, which must be equal.   matrix.sh SOURCE_FOLDER WORK_FOLDER [CONFIGURATION...]
# A configuration is compiler:option, for example clang++:-O0. Configurations without an installed compiler are reported
# and skipped.
set -eu -o pipefail
source=$1 work=$2
shift 2
configurations=("$@")
[ ${#configurations[@]} -gt 0 ] || configurations=(g++:-O3 g++:-O2 g++:-O0 clang++:-O3 clang++:-O2 clang++:-O0
  aarch64-linux-gnu-g++:-O2)
mkdir -p "$work"

build() {
  local compiler=$1 option=$2 out=$3 file name
  local common=(-std=c++20 "$option" -ffp-contract=off -fno-math-errno -fno-trapping-math -DEIGEN_DONT_VECTORIZE
    -DEIGEN_MPL2_ONLY -DXXH_INLINE_ALL -I"$source" -I/usr/include/eigen3 -I"$work/headers")
  local objects=()
  mkdir -p "$out"
  for file in "$source"/core/*/*.cpp "$source"/core/elements/kernels/*.cpp "$source"/recordings/state_hash.cpp \
      "$source"/tests/golden/print_hashes.cpp; do
    name=$(basename "$file" .cpp)
    local own=()
    case $compiler:$name in
      aarch64*:avx*) continue ;;
      aarch64*) ;;
      *:avx2) own=(-mavx2) ;;
      *:avx512) own=(-mavx512f -mavx512vl -mavx512dq) ;;
      *:kernels) own=(-DCTPM_HAS_AVX) ;;
    esac
    "$compiler" "${common[@]}" "${own[@]}" -c "$file" -o "$out/$name.o"
    objects+=("$out/$name.o")
  done
  local link=(-pthread)
  case $compiler in aarch64*) link+=(-static) ;; esac
  "$compiler" "${objects[@]}" "${link[@]}" -o "$out/print_hashes"
}

# Only the hash's header, so that a cross compiler sees no header of this machine's architecture.
mkdir -p "$work/headers"
cp /usr/include/xxhash.h "$work/headers/"
cp /usr/include/xxh3.h "$work/headers/" 2>/dev/null || true

reference= failed=0 compared=0
for configuration in "${configurations[@]}"; do
  compiler=${configuration%%:*} option=${configuration#*:} run=()
  if ! command -v "$compiler" >/dev/null; then echo "left out: $compiler is not there"; continue; fi
  if [[ $compiler == aarch64* ]]; then
    if ! command -v qemu-aarch64 >/dev/null; then echo "left out: qemu-aarch64 is not there"; continue; fi
    run=(qemu-aarch64)
  fi
  out=$work/$compiler$option
  build "$compiler" "$option" "$out"
  if ! "${run[@]}" "$out/print_hashes" >"$out/hashes.txt"; then echo "$configuration: differs within itself"; failed=1; fi
  [ -n "$reference" ] || reference=$out/hashes.txt
  if diff "$reference" "$out/hashes.txt"; then echo "$configuration: same bits"; else echo "$configuration: DIFFERS"; failed=1; fi
  compared=$((compared + 1))
done
[ "$compared" -ge 2 ] || { echo "nothing to compare"; exit 1; }
exit $failed
