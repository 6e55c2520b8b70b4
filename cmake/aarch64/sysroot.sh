#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Unpacks Debian's arm64 packages that libsurf, mc_sim and their tests stand on. Usage: sysroot.sh FOLDER
# Nothing outside of FOLDER changes: apt works with lists, archives and a record of installed packages of its own, which
# is empty, so that it finds out itself what the packages named here need. Sources, keys and proxies are the machine's.
# Exit code 77: the packages cannot be had here. A folder that is whole is left as it is.
set -euo pipefail
packages=(
  libc6-dev libstdc++-12-dev                                      # what g++ and clang link
  libembree-dev librandom123-dev
  libcgal-dev libopenmesh-dev
  libeigen3-dev libceres-dev
  libsuitesparse-dev libopenblas-pthread-dev
  libfftw3-dev libnlopt-dev
  libhwy-dev libfmt-dev
  libtomlplusplus-dev nlohmann-json3-dev libssl-dev               # what io reads materials with
  libpugixml-dev zlib1g-dev libtinygltf-dev libxxhash-dev
  libgtest-dev libgmock-dev
)
libraries=usr/lib/aarch64-linux-gnu

skip() { printf 'skipped: %s\n' "$*"; exit 77; }

mkdir -p "$1"
root=$(cd "$1" && pwd)
exec {lock}>"$root/lock"
flock "$lock"                     # two builds may want it at once
whole="$root/packages.txt"
contents="$root: ${packages[*]}"  # links and CMake files in it name its place
[[ ! -f $whole || $(<"$whole") != "$contents" ]] || exit 0

for program in apt-get dpkg-deb; do
  command -v "$program" >/dev/null || skip "there is no $program: arm64 packages come from Debian's archive"
done
apt=$(mktemp -d)
trap 'rm -rf "$apt"' EXIT
mkdir -p "$apt/state/lists/partial" "$apt/cache/archives/partial"
touch "$apt/state/status"
cat >"$apt/apt.conf" <<END
APT::Architecture "arm64";
APT::Architectures { "arm64"; };
APT::Install-Recommends "false";
APT::Sandbox::User "root";
Acquire::Languages "none";
Acquire::Retries "3";
Dir::State "$apt/state";
Dir::State::status "$apt/state/status";
Dir::Cache "$apt/cache";
Dir::Cache::archives "archives";
END
export APT_CONFIG=$apt/apt.conf
# A source of the machine that has nothing for arm64 is no reason to stop: what counts is that the packages are there.
apt-get -qq update || true
apt-get -qq install --download-only -y "${packages[@]}" ||
  skip "apt cannot get the arm64 packages, see above (no network, or this is not Debian 12)"

find "$root" -mindepth 1 -maxdepth 1 ! -name lock -exec rm -rf {} +
find "$apt/cache/archives" -name '*.deb' -print0 | xargs -0 -n 1 -P "$(nproc)" sh -c 'dpkg-deb -x "$1" "$0"' "$root"

# What packages do when they are installed, as far as it matters here: OpenBLAS becomes the BLAS, and links that say
# /lib mean the one in here.
(cd "$root/$libraries" && ln -sf openblas-pthread/lib*.so* .)
while IFS= read -r -d '' link; do
  target="$root$(readlink "$link")"
  [[ ! -e $target ]] || ln -sfnr "$target" "$link"
done < <(find "$root/lib" "$root/usr/lib" -type l -lname '/*' -print0)
# CMake files of some packages name libraries by paths of the machine they are installed on. Those in which they find
# out whether they still lie where they were installed (_realOrig) have to stay.
grep -rlZ --include='*.cmake' "/$libraries/" "$root/usr" |
  xargs -0 sed -i "/_realOrig/!s#\([;\" ]\)/$libraries/#\1$root/$libraries/#g"
printf '%s\n' "$contents" >"$whole"
