#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes Debian's packages of the build folder, has lintian read them, and, asked to, tries them in a clean Debian 12.
# Usage: packages.sh BUILD SOURCE FOLDER [clean]. Exit code 77: this machine lacks what it takes. docs/how-to/packages.md says what for.
set -euo pipefail
build=$1 source=$2 work=$3 clean=${4:-}

skip() { printf 'skipped: %s\n' "$*"; exit 77; }
fail() { printf 'error: %s\n' "$*" >&2; exit 1; }
[[ -z $clean ]] || (($(id -u) == 0)) || skip "only root makes a clean system"
for program in cpack dpkg-shlibdeps lintian ${clean:+mmdebstrap}; do
  command -v "$program" >/dev/null || skip "there is no $program: apt-get install dpkg-dev mmdebstrap lintian"
done
began=$SECONDS
step() {
  printf '%s: %d:%02d\n' "$1" $(((SECONDS - began) / 60)) $(((SECONDS - began) % 60))
  began=$SECONDS
}

rm -rf "$work"
mkdir -p "$work"
trap 'rm -rf "$work"' EXIT
cpack -G DEB -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip --config "$build/CPackConfig.cmake" -B "$work/debs" >"$work/cpack.log" 2>&1 || { cat "$work/cpack.log"; exit 1; }
rm -rf "$work/debs/_CPack_Packages"
ls -sh "$work/debs"
step "made"

expected=(semsurf libsemsurf-dev)
for part in raster:semsurf-io-image vtk:semsurf-io-vtk mpi:semsurf-mpi; do
  [[ ! -e $build/lib/semsurf/${part%%:*}.so ]] || expected+=("${part#*:}")
done
[[ ! -e $build/lib/semsurf_paraview ]] || expected+=(paraview-semsurf)
[[ ! -e $build/python/semsurf/_place.py ]] || expected+=(python3-semsurf)
for package in "${expected[@]}"; do
  compgen -G "$work/debs/${package}_*.deb" >/dev/null || fail "there is no package $package"
done
lintian --fail-on error --allow-root --tag-display-limit 0 "$work"/debs/*.deb || fail "lintian found errors"
step "read by lintian"
[[ -n $clean ]] || exit 0

# Only what the program alone needs: images come with their package.
cat >"$work/program.sh" <<'IN'
set -eu
cd /tmp
semsurf --version
[ "$(command -v semsurf)" = /usr/bin/semsurf ]
semsurf info /usr/share/semsurf/samples/pyramid.stl
if semsurf simulate /usr/share/semsurf/samples/flat.toml --size 8x8 --electrons 10 -o flat.exr 2>error.txt; then
  echo "an image was written without its package"; exit 1
fi
grep -q semsurf-io-image error.txt || { cat error.txt; exit 1; }
gzip -t /usr/share/man/man1/semsurf.1.gz
IN
cat >"$work/all.sh" <<'IN'
set -eu
cd /tmp
samples=/usr/share/semsurf/samples
semsurf simulate $samples/mesa80.toml --size 16x16 --electrons 20 --seed 7 -o program.exr -o program.vti -o program.png
for module in /usr/lib/semsurf/*.so; do
  if ldd "$module" | grep "not found"; then echo "$module lacks a library"; exit 1; fi
done
[ ! -e /usr/lib/semsurf/mpi.so ] ||
  mpirun --allow-run-as-root --oversubscribe -n 2 semsurf simulate $samples/mesa80.toml --size 16x16 --electrons 20 \
    --seed 7 -o team.exr
if [ -e /usr/lib/python3/dist-packages/semsurf/_place.py ]; then
  python3 - <<'PY'
import os, semsurf
image = semsurf.simulate("/usr/share/semsurf/samples/mesa80.toml", size="16x16", electrons=20, seed=7)
semsurf.write_image("python.exr", image)
program = semsurf.read_image("program.exr")
assert (program["SE"] == image["SE"]).all()
if os.path.exists("team.exr"):
    assert (semsurf.read_image("team.exr")["SE"] == image["SE"]).all()
print("python:", semsurf.__version__, os.path.dirname(semsurf.__file__))
PY
fi
if command -v paraview-semsurf >/dev/null; then
  sh -n "$(command -v paraview-semsurf)"
  PV_PLUGIN_PATH=/usr/lib/semsurf_paraview pvpython -c '
from paraview import simple
assert hasattr(simple, "SimulateSEM"), "no plugin"
print("ParaView: the plugin is there")'
fi
IN
sources=$(find /etc/apt/sources.list.d -name '*.sources' -o -name '*.list')
[[ ! -s /etc/apt/sources.list ]] || sources+=" /etc/apt/sources.list"
# pvpython asks ParaView without a window.
also=openmpi-bin
[[ ! -e $build/lib/semsurf_paraview ]] || also+=" python3-paraview"
install="apt-get install -qq -y --no-install-recommends"
export DEBIAN_FRONTEND=noninteractive
# shellcheck disable=SC2086
mmdebstrap --variant=apt --mode=root --aptopt='Acquire::Languages "none"' --dpkgopt='force-unsafe-io' \
  --customize-hook="mkdir \"\$1/packages\" && cp $work/debs/*.deb $work/*.sh \"\$1/packages\"" \
  --customize-hook="chroot \"\$1\" sh -c '$install /packages/semsurf_*.deb'" \
  --customize-hook="chroot \"\$1\" sh /packages/program.sh" \
  --customize-hook="chroot \"\$1\" sh -c '$install /packages/*.deb $also'" \
  --customize-hook="chroot \"\$1\" sh /packages/all.sh" \
  bookworm /dev/null $sources >"$work/root.log" 2>&1 || { tail -60 "$work/root.log"; fail "they do not work in a clean system"; }
grep -E "^(semsurf [0-9]|python:|ParaView:)" "$work/root.log" || true
step "installed and tried"
