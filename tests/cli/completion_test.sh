#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# completion_test.sh PROGRAM: asks bash's completion of semsurf as the shell would.
set -eu
source <("$1" completion bash)
status=0

# expect "what is offered" word... : the last word is the one being completed.
expect() {
  local wanted=$1
  shift
  COMP_WORDS=(semsurf "$@")
  COMP_CWORD=$#
  _semsurf || true   # nothing to offer
  if [[ "${COMPREPLY[*]-}" != "$wanted" ]]; then
    printf '%s -> "%s", not "%s"\n' "$*" "${COMPREPLY[*]-}" "$wanted"
    status=1
  fi
}

expect "simulate" sim
expect "--energy" simulate --ener
expect "--substrate --substrate-z --spot --size --seed --spectra" simulate cube.stl --s
expect "SE1 SE2" simulate --detector SE
expect "mirror" simulate --edge m
expect "bash zsh fish" completion ""
expect "/etc/hostname" simulate -o /etc/hostnam
expect "Si SiO2" materials Si
expect "graphite" materials gr
expect "--materials" materials --ma
expect "" simulate --energy ""
expect "library" lib
expect "list build plot remove" library ""
expect "--physics" library build Si --ph
expect "Si SiO2" library build Si
expect "--damaged --dry-run" library remove --d

# Names of files and folders.
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
mkdir "$folder/kept"
touch "$folder/known.json"
expect "$folder/known.json" predict heights.gsf --model "$folder/kn"
expect "$folder/known.json" register a.gwy b.tif --landmarks "$folder/kn"
expect "$folder/known.json" reconstruct --calibration "$folder/kn"
expect "$folder/known.json" reconstruct --transform "$folder/kn"
expect "$folder/known.json" mesh cube.stl --tracks "$folder/kn"
expect "$folder/kept" sample pads -o "$folder/k"
expect "$folder/kept" simulate --cache "$folder/k"
expect "off" simulate --cache of
expect "SE SE.stderr" simulate --channel SE
expect "" simulate --channel ..
expect "tiles" simulate --layout t
exit $status
