#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""bench_large_specimen.py PROGRAM FOLDER [SIDE ...] [--ranks N,...] [--most-gb 22]

Makes closed meshes over SIDE x SIDE samples (7072: 10^8 triangles) as STL with the program, simulates a small
image of each, and tells the time and the largest resident memory of both, per triangle, too. With --ranks it
tells what each of several processes holds while they simulate, proportionally (Pss). A process that grows
beyond --most-gb is killed, and so is one that leaves the machine less than 1.5 GB."""
import argparse
import array
import math
import os
import pathlib
import re
import subprocess
import time


def write_field(path, side):
    """As Gwyddion's simple field: waves and grain of a few nm, row by row."""
    head = (f"Gwyddion Simple Field 1.0\nXRes = {side}\nYRes = {side}\nXReal = {side * 1e-9}\nYReal = {side * 1e-9}\n"
            "XYUnits = m\nZUnits = m\n").encode()
    along = [math.sin(x / 17) for x in range(side)]
    with open(path, "wb") as out:
        out.write(head + b"\0" * (4 - len(head) % 4))
        for y in range(side):
            across = 5e-9 * math.sin(y / 23)
            out.write(array.array("f", (across * a + (x * 7919 + y * 104729) % 97 * 5e-12 for x, a in enumerate(along))).tobytes())


def kilobytes(path, word):
    return int(re.search(rf"^{word}:\s+(\d+)", pathlib.Path(path).read_text(), re.M)[1])


def watch(words, most_gb):
    begin, peak = time.time(), 0
    process = subprocess.Popen(words)
    while process.poll() is None:
        try:
            peak = kilobytes(f"/proc/{process.pid}/status", "VmHWM") * 1024
            if kilobytes(f"/proc/{process.pid}/status", "VmRSS") > most_gb * 1e6 or kilobytes("/proc/meminfo", "MemAvailable") < 1.5e6:
                process.kill()
        except (OSError, TypeError):
            pass
        time.sleep(0.1)
    if process.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, words))} ended with {process.returncode} at {peak / 1e9:.2f} GB")
    return time.time() - begin, peak


def children_of(program, mark):
    for folder in pathlib.Path("/proc").iterdir():
        try:
            if folder.name.isdigit() and (folder / "exe").resolve() == program and mark in (folder / "environ").read_bytes():
                yield int(folder.name)
        except OSError:
            pass


def shares(program, mesh, ranks, folder):
    """Pss of each process, MB, while it simulates."""
    mark = f"SEMSURF_BENCH={os.getpid()}"
    name, _, value = mark.partition("=")
    checkpoint = folder / "ranks.checkpoint"
    checkpoint.unlink(missing_ok=True)
    process = subprocess.Popen(["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", str(ranks), program, "simulate", mesh,
                                "--material", "Si", "--method", "direct", "--size", "400x400", "--region=100,100,160,160",
                                "--electrons", "240", "--threads", "1", "-q", "--checkpoint", checkpoint,
                                "--checkpoint-every", "0.2s", "-o", folder / "ranks.exr"],
                               env={**os.environ, name: value}, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while process.poll() is None and not checkpoint.exists():
        time.sleep(0.1)
    found = sorted((kilobytes(f"/proc/{pid}/smaps_rollup", "Pss") / 1e3 for pid in children_of(program, mark.encode())), reverse=True)
    process.terminate()
    process.wait()
    checkpoint.unlink(missing_ok=True)
    return found


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("program", type=lambda text: pathlib.Path(text).resolve())
parser.add_argument("folder", type=pathlib.Path)
parser.add_argument("sides", nargs="*", type=int, default=[707, 2236])
parser.add_argument("--ranks", default="")
parser.add_argument("--most-gb", type=float, default=22)
o = parser.parse_args()
o.folder.mkdir(parents=True, exist_ok=True)
for side in o.sides:
    field, mesh = o.folder / "large.gsf", o.folder / "large.stl"
    write_field(field, side)
    made = watch([o.program, "mesh", field, "--solid", "--plain", "--true-size", "-q", "-o", mesh], o.most_gb)
    triangles = (mesh.stat().st_size - 84) / 50
    print(f"{triangles:.4g} triangles: made in {made[0]:.0f} s, {made[1] / 1e9:.2f} GB, {made[1] / triangles:.0f} bytes each", flush=True)
    done = watch([o.program, "simulate", mesh, "--material", "Si", "--method", "direct", "--electrons", "20", "--size", "16x16",
                  "--region=100,100,140,140", "-q", "-o", o.folder / "large.exr"], o.most_gb)
    print(f"  simulated in {done[0]:.0f} s, {done[1] / 1e9:.2f} GB, {done[1] / triangles:.0f} bytes each", flush=True)
    for ranks in [int(word) for word in o.ranks.split(",") if word]:
        found = shares(o.program, mesh, ranks, o.folder)
        print(f"  {ranks} ranks: {sum(found):.0f} MB together:", " ".join(f"{each:.0f}" for each in found), flush=True)
    field.unlink()
    mesh.unlink()
