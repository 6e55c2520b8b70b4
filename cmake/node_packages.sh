#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# node_packages.sh FOLDER...: installs what FOLDER/package-lock.json names into .cache/node/FOLDER, again only where the
# lock has changed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
for name in "$@"; do
  folder=.cache/node/$name
  wanted=$(sha256sum "$name/package-lock.json" | cut -d' ' -f1)
  [[ $(cat "$folder/installed.txt" 2>/dev/null) != "$wanted" ]] || continue
  printf '==> Fetching the packages of %s\n' "$name/package-lock.json"
  mkdir -p "$folder"
  rm -f "$folder/installed.txt"
  cp "$name/package.json" "$name/package-lock.json" "$name/.npmrc" "$folder/"
  (cd "$folder" && npm ci --ignore-scripts --no-audit --no-fund --loglevel=error)
  printf '%s\n' "$wanted" >"$folder/installed.txt"
done
