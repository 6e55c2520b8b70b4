#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# ccache.sh CCACHE COMPILER ARGUMENTS...: compiles through ccache. Each precompiled header (85 MB) gets a file of its checksum,
# which ccache reads in its place: to read the header itself for each file that includes it takes as long as to compile
# such a file. Without pch_defines and time_macros ccache keeps nothing that is compiled with precompiled headers.
set -e
export CCACHE_SLOPPINESS=pch_defines,time_macros CCACHE_DEPEND=1 CCACHE_PCH_EXTSUM=1
header=
previous=
for argument; do
  [ "$previous" != -o ] || case $argument in *.gch) header=$argument ;; esac
  previous=$argument
done
[ -n "$header" ] || exec "$@"
rm -f "$header.sum"
"$@"
sha1sum <"$header" >"$header.sum"
