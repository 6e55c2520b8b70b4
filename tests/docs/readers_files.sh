# SPDX-License-Identifier: GPL-3.0-or-later
# The files that pages of the manual and examples of help texts take for the reader's own, small, in the current folder:
# bash readers_files.sh [images]. It needs `samples` there and `semsurf` on the path. With `images` there are also simulated
# images of lines, trenches and holes, and of quadrants: a minute.
set -eu
quiet() { "$@" >log.txt 2>&1 || { code=$?; [ $code -eq 4 ] || { echo "$*"; cat log.txt; exit $code; }; }; }
copies() { file=$1; shift; for copy in "$@"; do cp "$file" "$copy"; done; }
mkdir -p scans one two

# A scan, an SEM image of the same place, the surface, the tip, and what microscopists point at in both images.
quiet semsurf sample pads --size 96x72 --electrons 20 -o pads
copies pads/afm.gsf scan.gsf mica.gwy monday.gwy before.gsf large.gsf
copies pads/truth.gsf surface.gsf fine.gsf other.gsf eroded.gsf known.gsf a.gsf b.gsf
cp pads/truth_tip.gsf tip.gsf
quiet semsurf clean scan.gsf --median 3 -o after.gsf
cp after.gsf tuesday.gwy
quiet semsurf level scan.gsf -o flat.gsf
python3 - <<'IN'
import json
import re

# Channels as microscopes name them.
raw = open("scan.gsf", "rb").read()
end = raw.index(b"\0")
values = raw[end + 4 - end % 4:]
for name, files in (("ZSensor", ["scan.gwy"]), ("Height", ["scan.spm", "scans/monday.spm", "scans/tuesday.spm"])):
    head = re.sub(rb"Title = .*\n", f"Title = {name}\n".encode(), raw[:end])
    for file in files:
        open(file, "wb").write(head + b"\0" * (4 - len(head) % 4) + values)

m = json.load(open("pads/truth.json"))["sem_to_afm"]
print("sem_x_nm,sem_y_nm,afm_x_nm,afm_y_nm", file=open("places.csv", "w"))
for x, y in ((-300, -250), (300, -200), (250, 280), (-350, 200)):
    print(x, y, m[0] * x + m[1] * y + m[2], m[3] * x + m[4] * y + m[5], sep=",", file=open("places.csv", "a"))
json.dump({"semsurf": "transform", "version": 1, "sem_to_afm": m, "verified": True}, open("transform.json", "w"))
IN
for folder in one two; do
  quiet semsurf level surface.gsf --level-method none -o $folder/surface.vti
done
cp one/surface.vti surface.vti
quiet semsurf level surface.gsf --level-method none -o surface.tif
cp surface.tif afm.tif

# Images.
copies pads/sem.tif sem.tif image.tif later.tif
quiet semsurf predict surface.gsf --model samples/si-1keV-10nm.json --resample -o simulated.exr -o sem.png
copies sem.png image.png
copies simulated.exr sem.exr a.exr b.exr
quiet semsurf certainty scan.gsf --tip tip.gsf -o map.tif
cp map.tif certainty.tif
quiet oiiotool --create 73x91 1 --fill:color=1 12x9+30+40 -d uint8 -o particles.png
quiet oiiotool --create 73x91 1 --fill:color=1 73x20+0+0 -d uint8 -o substrate.tif
quiet semsurf simulate samples/mesa80.toml --electrons 4 --size 16x16 --trajectories 20 -o out.exr
mv out.tracks.vtp tracks.vtp
quiet semsurf simulate samples/mesa80.toml --electrons 4 --size 16x16 -o mesa.vti
quiet semsurf simulate samples/rough.toml --electrons 32 --size 32x32 --channels counts,electrons,z_nm,normal,material -o few.exr
mkdir -p out
mv out.exr out/cube.exr

# Models and materials.
copies samples/si-1keV-10nm.json si.json si-1keV-10nm.json
cp samples/si-1keV-3nm.json .
quiet semsurf train fine.gsf other.gsf --images simulated.exr --images simulated.exr --pixel-size 10nm --kind filter-bank -o bank.json
cat >mine.toml <<'IN'
[[material]]
name = "nitride"
formula = "Si3N4"
density_g_cm3 = 3.17
band_gap_ev = 5.3
IN

# Meshes.
copies samples/pyramid.stl cube.stl
quiet semsurf mesh cube.stl --out-unit um --plain -o grain.ply
quiet semsurf mesh cube.stl --out-unit um --plain -o part.obj
quiet semsurf mesh cube.stl -o broken.obj
sed -i '$d' broken.obj
quiet semsurf mesh surface.gsf --out-unit um --plain -o part.stl
quiet semsurf mesh surface.gsf -o specimen.ply
quiet semsurf mesh surface.gsf -o scan.ply
rm log.txt out.run.json out.tracks.png
[ "${1:-}" = images ] || exit 0

# relief NAME SHAPE LINES...: a scene of a height field.
relief() {
  name=$1 shape=$2
  shift 2
  printf '%s\n' '[beam]' 'energy = "1keV"' 'spot = "2nm"' '[scan]' 'size = "96x64"' 'pixel_size = "4nm"' '[height_field]' \
    'material = "Si"' "shape = \"$shape\"" 'width = "800nm"' 'pitch = "1nm"' 'edge = "mirror"' "$@" >"$name.toml"
}
relief lines grating 'period = "150nm"' 'height = "100nm"' 'top_width = "61nm"' 'wall_run = "9nm"'
relief trench trench 'trench_depth = "120nm"' 'bottom_width = "60nm"' 'wall_run = "5nm"'
relief via via 'via_depth = "100nm"' 'bottom_width = "60nm"' 'wall_run = "5nm"'
quiet semsurf simulate lines.toml --electrons 100 -o up.tif
cp up.tif lines.tif
quiet semsurf simulate lines.toml --electrons 100 --seed 2 --tilt 3deg -o tilted.tif
quiet semsurf simulate trench.toml --electrons 100 --energy 800eV -o trench.tif
quiet semsurf simulate via.toml --electrons 100 --pixel-size 2nm -o via.png
quiet semsurf simulate surface.gsf --material Si --pixel-size 10nm --detector quadrants --electrons 50 -o q.exr
python3 - <<'IN'
import struct
width, height = 121, 61   # a line 50 nm wide and 60 nm high; 2 nm between samples
line = [60.0 if abs(x - 60) <= 12 else 0.0 for x in range(width)] * height
head = "Gwyddion Simple Field 1.0\nXRes = 121\nYRes = 61\nXReal = 2.42e-07\nYReal = 1.22e-07\nXYUnits = m\nZUnits = m\n".encode()
open("line.gsf", "wb").write(head + b"\0" * (4 - len(head) % 4) + struct.pack(f"<{len(line)}f", *(1e-9 * z for z in line)))
IN
quiet semsurf mesh line.gsf -o line.stl
for side in left:0deg right:180deg; do
  quiet semsurf simulate line.gsf --material Si --size 40x16 --pixel-size 4nm --electrons 200 --tilt 15deg --azimuth "${side#*:}" \
    -o "from_${side%:*}.exr"
  cp "from_${side%:*}.exr" "${side%:*}.exr"
done
rm log.txt
