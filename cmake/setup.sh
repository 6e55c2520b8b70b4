# SPDX-License-Identifier: GPL-3.0-or-later
# Set-up shared by ./run and ./check; source it after setting -euo pipefail. Functions:
#   setup_packages        installs what is missing of the list below
#   setup_programs        installs the programs that only ./check --all uses, as far as they can be had
#   setup_node FOLDER...  fetches the packages of Node.js that a folder's lock names
#   setup_configure       configures the preset `release` into build/, once
# All leave everything alone when there is nothing to do.

packages=(
  cmake g++ ninja-build ccache mold                               # build
  libembree-dev librandom123-dev                                  # ray tracing, random numbers
  libcgal-dev libopenmesh-dev                                     # mesh repair and simplification
  libeigen3-dev libceres-dev                                      # least squares, learning networks
  libsuitesparse-dev libopenblas-pthread-dev                      # factoring sparse matrices
  libfftw3-dev libnlopt-dev                                       # registering images
  libhwy-dev                                                      # loops for each instruction set
  libopenimageio-dev openimageio-tools libhdf5-dev                # images
  libtomlplusplus-dev nlohmann-json3-dev libssl-dev               # scene files, records, hashes
  libcli11-dev libfmt-dev                                         # command line, text
  libpugixml-dev zlib1g-dev                                       # VTK's files, 3MF
  libtinygltf-dev                                                 # glTF
  libxxhash-dev                                                   # checksums of cached files
  pkg-config libcairo2-dev fonts-dejavu-core                      # pictures of electron tracks
  paraview-dev python3-paraview mpi-default-dev python3-dev       # VTK: ParaView's own
  python3-matplotlib                                              # charts
  pybind11-dev python3-numpy python3-pytest                       # the Python package and its tests
  python3-nbconvert python3-ipykernel                             # the notebooks, which the tests run
  libgtest-dev libgmock-dev                                       # tests
)
# The pages of semsurf view. Debian's npm conflicts with other packages of Node.js: any that is there will do.
command -v node >/dev/null && command -v npm >/dev/null || packages+=(nodejs npm)

# For ./check --all: programs that open what semsurf writes, for the tests labelled `programs` (about 1.5 GB), and what
# builds and runs the libraries for another processor.
programs=(
  admesh assimp-utils f3d freecad-python3 blender python3-numpy   # what opens surfaces
  paraview                                                        # the plugin with the mouse
  xvfb xauth                                                      # a screen for those that need one
  chromium                                                        # what shows web pages and glTF
  lib3mf-dev                                                      # the 3MF Consortium's own reader
  gwyddion                                                        # AFM formats that only it knows
  python3-hyperspy                                                # what reads .hspy
  g++-aarch64-linux-gnu clang qemu-user                           # AArch64
  dpkg-dev mmdebstrap lintian                                     # packages, and a clean system to try them in
  mkdocs mkdocs-material doxygen                                  # the web site of the manual
)

say() { printf '==> %s\n' "$*"; }
fail() { printf 'error: %s\n' "$*" >&2; exit 1; }

# The packages of the list that are not installed, one a line.
missing_packages() {
  local installed
  installed=$(dpkg-query -W -f='${Package} ${db:Status-Status}\n' "${packages[@]}" 2>/dev/null |
              sed -n 's/ installed$//p') || true
  printf '%s\n' "${packages[@]}" | grep -vxF -f <(printf '%s\n' "$installed" | sed '/^$/d') || true
}

setup_packages() {
  if ! command -v dpkg-query >/dev/null; then
    say "This is not Debian: going on with what is installed. Debian's names of what is needed:"
    printf '      %s\n' "${packages[*]}"
    return
  fi
  local missing
  mapfile -t missing < <(missing_packages)
  if ((${#missing[@]} == 0)); then
    return
  fi
  if (($(id -u) != 0)); then
    say "Packages are missing. Install them with this command, then start again:"
    printf '\n  sudo apt-get update && sudo apt-get install --no-install-recommends %s\n\n' \
           "${missing[*]}"
    exit 1
  fi
  say "Installing with apt: ${missing[*]}"
  export DEBIAN_FRONTEND=noninteractive
  apt-get -qq update ||
    fail "apt-get update failed, see above. Check the network and the package sources in /etc/apt."
  # --no-remove: nothing that is already on this machine is taken away.
  apt-get -qq install -y --no-install-recommends --no-remove "${missing[@]}" ||
    fail "apt-get install failed, see above. If it says that packages need to be removed: python3-vtk9
       and ParaView's Python cannot live together; remove python3-vtk9 yourself and start again."
}

# One that cannot be had is no failure: its test is skipped, and counted.
setup_programs() {
  command -v dpkg-query >/dev/null && (($(id -u) == 0)) || return 0
  local needed=("${packages[@]}") missing program
  packages=("${programs[@]}")
  mapfile -t missing < <(missing_packages)
  packages=("${needed[@]}")
  ((${#missing[@]} > 0)) || return 0
  say "Installing with apt: ${missing[*]}"
  export DEBIAN_FRONTEND=noninteractive
  apt-get -qq update || true
  apt-get -qq install -y --no-install-recommends --no-remove "${missing[@]}" && return
  for program in "${missing[@]}"; do
    apt-get -qq install -y --no-install-recommends --no-remove "$program" || say "$program cannot be installed"
  done
}

# What the folders named need of Node.js. Without it semsurf view writes no pages, and everything else works.
setup_node() {
  command -v node >/dev/null && command -v npm >/dev/null || return 0
  cmake/node_packages.sh "$@" || say "npm failed, see above: going on without"
}

setup_configure() {
  local home fresh=()
  home=$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' build/CMakeCache.txt 2>/dev/null) || true
  if [[ -n $home && ! $home -ef . ]]; then
    fresh=(--fresh)   # this folder was copied or moved: its build would change the other one
  elif [[ -f build/build.ninja && ! CMakePresets.json -nt build/build.ninja ]]; then
    return   # Ninja configures again by itself where a CMake file changed
  fi
  say "Configuring into build/"
  local log
  log=$(mktemp)
  if ! cmake --preset release "${fresh[@]}" >"$log" 2>&1; then
    cat "$log" >&2
    rm -f "$log"
    fail "configuring failed, see above."
  fi
  rm -f "$log"
}
