#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Fuzzes readers. Usage: tests/fuzz/run.sh BUILD EXECUTIONS [TARGET...]
# BUILD is a folder of the preset `fuzz`. A target NAME+ takes what was read through the steps that follow. As many
# targets run at once as FUZZ_JOBS says (1). Grown corpora, findings and logs go to BUILD/fuzz/NAME; a finding is a file
# crash-*, timeout-* or oom-* there. More seeds: FUZZ_SEEDS=FOLDER, of which files are taken by their extension.
# FUZZ_TIMEOUT: seconds after which an input counts as a finding (20).
# Prints for each target: executions, how many a second, how many inputs were read, edges, and how many of these
# were found in the last tenth of the executions.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "$1" && pwd)
runs=$2
shift 2
targets=("$@")
if ((${#targets[@]} == 0)); then
  for folder in "$here"/corpus/*/; do targets+=("$(basename "$folder")"); done
fi

fuzz_one() {
  local target=$1 name=${1%+} work status=0 most=8192
  work=$build/fuzz/$target
  mkdir -p "$work/corpus" "$work/seeds"
  cp -f "$here/corpus/$name"/* "$work/seeds/"
  if [[ $target == *+ && -d $build/fuzz/$name/corpus ]]; then
    find "$build/fuzz/$name/corpus" -type f -exec cp -f -t "$work/seeds/" {} +
  fi
  if [[ -n ${FUZZ_SEEDS:-} ]]; then
    find "$FUZZ_SEEDS" -type f -iname "*.$name" -size -64k -exec cp -f -t "$work/seeds/" {} \;
  fi
  case $name in exr | tif | png | page) most=131072 ;; esac
  (cd "$work" && ASAN_OPTIONS=detect_leaks=0 "$build/bin/fuzz" "$target" -runs="$runs" -timeout="${FUZZ_TIMEOUT:-20}" -rss_limit_mb=3000 \
    -malloc_limit_mb=2500 -max_len="$most" -len_control=0 -reload=0 -dict="$here/words.dict" -print_final_stats=1 \
    corpus seeds) >"$work/log" 2>&1 || status=$?
  python3 "$here/summarise.py" "$target" "$status" "$work/log"
  return "$status"
}
export -f fuzz_one
export here build runs
printf '%-14s %5s %11s %9s %6s %7s %8s\n' target exit executions 'a second' read edges new
printf '%s\n' "${targets[@]}" | xargs -P "${FUZZ_JOBS:-1}" -I{} bash -c 'fuzz_one {}'
