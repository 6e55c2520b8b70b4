#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Fuzzes readers one after the other, on one core. Usage: tests/fuzz/run.sh BUILD SECONDS [FORMAT...]
# BUILD is a folder of the preset `fuzz`. Grown corpora, findings and logs go to BUILD/fuzz/FORMAT;
# a finding is a file crash-*, timeout-* or oom-* there. More seeds: FUZZ_SEEDS=FOLDER, of which
# FORMAT's files are taken by their extension.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "$1" && pwd)
seconds=$2
shift 2
formats=("$@")
if ((${#formats[@]} == 0)); then
  formats=(stl obj ply off gltf glb 3mf vtp vti toml exr tif png json gwy gsf spm ibw nid sxm stp jpk txt xyz)
fi

found=0
for format in "${formats[@]}"; do
  work=$build/fuzz/$format
  mkdir -p "$work/corpus" "$work/seeds"
  cp -f "$here/corpus/$format"/* "$work/seeds/"
  if [[ -n ${FUZZ_SEEDS:-} ]]; then
    find "$FUZZ_SEEDS" -type f -iname "*.$format" -size -200k -exec cp -f {} "$work/seeds/" \;
  fi
  status=0
  (cd "$work" && ASAN_OPTIONS=detect_leaks=0 "$build/bin/fuzz_$format" -max_total_time="$seconds" \
    -timeout=20 -rss_limit_mb=3000 -malloc_limit_mb=2500 -max_len=65536 -reload=0 \
    -dict="$here/words.dict" -print_final_stats=1 corpus seeds) >"$work/log" 2>&1 || status=$?
  printf '%-5s exit %d, %s executions, %s corpus files\n' "$format" "$status" \
    "$(sed -n 's/^stat::number_of_executed_units: *//p' "$work/log")" \
    "$(find "$work/corpus" -type f | wc -l)"
  ((status == 0)) || found=1
done
exit $found
