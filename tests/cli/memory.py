#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""memory.py PROGRAM: what a specimen of a million triangles takes is near what is said of it before it is read."""
import array
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
SIDE = 700   # samples: 10^6 triangles with walls and base
LOWEST, HIGHEST = 0.8, 1.5


def expect(truth, *what):
    if not truth:
        sys.exit(" ".join(map(str, what)))


def write_field(path):
    heights = array.array("f", (1e-9 * (5 * math.sin(i % SIDE / 17) * math.sin(i // SIDE / 23) + i * 7919 % 97 / 200)
                                for i in range(SIDE * SIDE)))
    head = (f"Gwyddion Simple Field 1.0\nXRes = {SIDE}\nYRes = {SIDE}\nXReal = {SIDE * 1e-9}\nYReal = {SIDE * 1e-9}\n"
            "XYUnits = m\nZUnits = m\n").encode()
    path.write_bytes(head + b"\0" * (4 - len(head) % 4) + heights.tobytes())


def simulate(mesh, memory):
    process = subprocess.Popen([PROGRAM, "simulate", mesh, "--material", "Si", "--method", "direct", "--electrons", "2",
                                "--size", "8x8", "--threads", "2", "-q", "-o", mesh.with_suffix(".exr")],
                               env={**os.environ, "SEMSURF_MEMORY": memory}, stderr=subprocess.PIPE, text=True)
    err = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    return os.waitstatus_to_exitcode(status), err, usage.ru_maxrss * 1024


with tempfile.TemporaryDirectory() as folder:
    field = pathlib.Path(folder) / "field.gsf"
    write_field(field)
    for ending in (".stl", ".ply", ".obj"):
        mesh = field.with_suffix(ending)
        subprocess.run([PROGRAM, "mesh", field, "--solid", "--plain", "-q", "-o", mesh], check=True)
        code, err, _ = simulate(mesh, "10MB")
        said = re.search(r"([\d.]+) million triangles need about ([\d.]+) GB", err)
        expect(code == 3 and said and "by SEMSURF_MEMORY" in err and "SEMSURF_MEMORY=off" in err, ending, code, err)
        expect(0.7 < float(said[1]) < 1.5, ending, "counts of triangles:", said[1])
        code, err, peak = simulate(mesh, "off")
        expect(code == 0, ending, code, err)
        share = float(said[2]) * 1e9 / peak
        print(f"{ending}: {said[1]} million triangles, {said[2]} GB said, {peak / 1e9:.3f} GB at the peak: {share:.2f}")
        expect(LOWEST <= share <= HIGHEST, ending, "said over measured:", share)
    code, err, _ = simulate(field.with_suffix(".stl"), "much")
    expect(code == 2 and "no amount of memory" in err, code, err)
