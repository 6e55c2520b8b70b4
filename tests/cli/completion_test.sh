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
  _semsurf
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
exit $status
