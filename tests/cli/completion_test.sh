#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# completion_test.sh PROGRAM: asks bash's completion of semsurf as the shell would.
set -eu
source <("$1" completion bash)
status=0

# expect "what is offered" word... : the last word is the one being completed, pieces of words as bash makes them.
program=$(realpath "$1")
expect() {
  local wanted=$1
  shift
  COMP_WORDS=(semsurf "$@")
  COMP_CWORD=$#
  COMP_LINE="semsurf $*"
  COMP_LINE=${COMP_LINE// = /=}
  COMP_LINE=${COMP_LINE// =/=}
  COMP_POINT=${#COMP_LINE}
  _semsurf "$program"
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
expect "" simulate --png-channel S
expect "tiles" simulate --layout t
cd "$folder"
expect "known.json" info kn
expect "known.json" simulate --energy 1keV kn
expect "join" sweep jo
expect "kept" sweep join ke

# What begins with the words of others: former names and hidden commands are understood, and not offered.
expect "" joi
expect "--height-channel --height-unit --height-pitch" level --height
expect "" level --z-u
expect "graphite" simulate --material gr
expect "Si SiO2" simulate x.stl --substrate Si

# Lists, and words in pieces.
expect "electrons" simulate --channels el
expect "z_nm,electrons" simulate --channels z_nm,el
expect "normal,z_nm normal,material normal,electrons normal,model normal,variance_left" simulate --channels normal,
expect "elastic=" simulate --physics el
expect "mott mott-phonon browning" simulate --physics elastic =
expect "browning" simulate --physics elastic = br
expect "browning,loss=" library build Si --physics elastic = browning,lo
expect "none" simulate --physics elastic = browning,loss = n
expect "energy=" sweep --vary en
expect "direct,replay" sweep --vary method = direct,r
expect "periodic" simulate --edge = p
expect "quadrants" sweep --detector q
expect "side" simulate --detector = si
expect "facet-network" train --model facet
exit $status
