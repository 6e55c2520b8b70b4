#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Usage: ccache.sh LAUNCHER CCACHE COMPILER FOLDER. What is compiled with a precompiled header comes from the cache while the header
# is the same, and is compiled anew when it is another.
set -eu
launcher=$1 ccache=$2 compiler=$3 work=$4
rm -rf "$work"
mkdir -p "$work"
trap 'rm -rf "$work"' EXIT
cd "$work"
export CCACHE_DIR="$work/cache" CCACHE_NOHASHDIR=1
printf '#include <cstdio>\nint main() { std::printf("%%d\\n", value()); }\n' >main.cpp
printf '#include "values.h"\n' >head.hxx
compile() { "$launcher" "$ccache" "$compiler" -Winvalid-pch -include ./head.hxx -MD -MF main.d -o main.o -c main.cpp; }
hits() { "$ccache" --print-stats | sed -n 's/^direct_cache_hit\t//p'; }
expect() { [ "$1" = "$2" ] || { echo "$3: $1, not $2" >&2; exit 1; }; }
for value in 1 2; do
  # As an older header: ccache does not trust what was changed a moment ago.
  printf 'inline int value() { return %d; }\n' $value >values.h
  touch -d '1 hour ago' head.hxx values.h main.cpp
  "$launcher" "$ccache" "$compiler" -x c++-header -o head.hxx.gch -c head.hxx
  compile
  "$compiler" main.o -o main
  expect "$(./main)" $value "the header's value"
  before=$(hits)
  compile
  expect "$(hits)" $((before + 1)) "hits"
done
