#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds libsurf, mc_sim and their tests for AArch64 and runs them under qemu-user.
# Usage: aarch64.sh gcc|clang [some|vectors]
#   some      of the tests build and run those of vector code
#   vectors   compile the sources of vector code alone, and run nothing
# Exit code 77: this machine lacks what it takes. docs/development/testing.md says what is run.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

skip() { printf 'skipped: %s\n' "$*"; exit 77; }
case ${1:-} in
  gcc) preset=aarch64 compiler=aarch64-linux-gnu-g++ ;;
  clang) preset=aarch64-clang compiler=clang++ ;;
  *) printf 'usage: %s gcc|clang\n' "$0" >&2; exit 2 ;;
esac
[[ $(uname -m) != aarch64 ]] || skip "this machine is AArch64: the other tests are these"
# clang links with the GNU linker for AArch64.
for program in qemu-aarch64 aarch64-linux-gnu-ld "$compiler"; do
  command -v "$program" >/dev/null ||
    skip "there is no $program: apt-get install g++-aarch64-linux-gnu qemu-user clang"
done

began=$SECONDS
step() {
  printf '%s: %d:%02d\n' "$1" $(((SECONDS - began) / 60)) $(((SECONDS - began) % 60))
  began=$SECONDS
}
cmake/aarch64/sysroot.sh build-aarch64/sysroot
step "arm64 packages"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
tests_alone=OFF
[[ $1 == clang || ${2:-} == some ]] && tests_alone=ON
cmake --preset "$preset" -DSEMSURF_VECTOR_TESTS_ALONE=$tests_alone >"$log" 2>&1 || { cat "$log"; exit 1; }
if [[ ${2:-} == vectors ]]; then
  # Sources with loops for each instruction set, and those that hold such loops for others.
  mapfile -t sources < <(grep -lE 'each_target\.h|_loops-inl\.h' -r libsurf/src mc_sim/src --include='*.cpp')
  folder=$(sed -n 's/^-- Build files have been written to: //p' "$log")
  mapfile -t objects < <(printf '/%s.o\n' "${sources[@]#*/}" |
                         grep -F -f - <(ninja -C "$folder" -t targets all | sed -n 's/^\(.*\.o\): .*/\1/p'))
  ((${#objects[@]} >= ${#sources[@]})) || { echo "of ${#sources[@]} sources ${#objects[@]} are built"; exit 1; }
  ninja -C "$folder" "${objects[@]}" >"$log" 2>&1 || { grep -v '^\[' "$log"; exit 1; }
  step "${#objects[@]} sources of vector code"
  exit
fi
cmake --build --preset "$preset" >"$log" 2>&1 || { grep -v '^\[' "$log"; exit 1; }
step "build"
ctest --preset "$preset" --parallel "$(nproc)"
step "tests"
