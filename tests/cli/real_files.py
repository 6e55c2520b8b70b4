#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""real_files.py PROGRAM: every mesh of the test data, good or broken, through info, mesh --repair and
simulate. Each either works or is refused with exit status 3 and a message that names the file and a
remedy; what was repaired and closed is simulated. Exit status 77 without the data."""
import os
import pathlib
import subprocess
import sys
import tempfile

SUFFIXES = {".stl", ".obj", ".ply", ".off", ".glb", ".gltf", ".vtp"}


def run(program, *words):
    result = subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=240)
    return result.returncode, result.stdout, result.stderr


def check(faults, name, command, result, allowed):
    status, _, errors = result
    if status not in allowed:
        faults.append(f"{name}: {command} ended with {status}: {errors[-400:]}")
    elif status == 3 and (name not in errors or errors.count(". ") < 1):
        faults.append(f"{name}: {command} says neither which file nor what to do: {errors}")
    return status == 0


def main():
    program = sys.argv[1]
    data = os.environ.get("SEMSURF_TEST_DATA")
    if not data or not (pathlib.Path(data) / "mesh").is_dir():
        print("SEMSURF_TEST_DATA is not set: skipped")
        return 77
    faults, simulated, refused, seen = [], [], [], 0
    files = sorted(p for p in (pathlib.Path(data) / "mesh").rglob("*") if p.suffix.lower() in SUFFIXES)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        few = ["--material", "Si", "--size", "12x12", "--electrons", "2", "-q"]
        for path in files:
            seen += 1
            name, good = path.name, path.parent.name == "mesh"
            # A good file must be read; not every good file is closed.
            check(faults, name, "info", run(program, "info", path), {0} if good else {0, 3})
            image = folder / (name + ".exr")
            unit = ["--unit", "nm", "--override-unit"] if path.suffix in {".glb", ".gltf"} else []
            ok = check(faults, name, "simulate",
                       run(program, "simulate", path, *unit, *few, "-o", image), {0, 3})
            mended = folder / (name + ".ply")
            repaired = check(faults, name, "mesh --repair",
                             run(program, "mesh", path, *unit, "--repair", "-o", mended),
                             {0} if good else {0, 3})
            if repaired and not ok:
                ok = check(faults, mended.name, "simulate", run(program, "simulate", mended, *few,
                                                                "-o", image), {0, 3})
            (simulated if ok else refused).append(name)
            if ok and not image.exists():
                faults.append(f"{name}: no image")
    print(f"{seen} files; simulated as they are or repaired: {', '.join(simulated)}")
    print(f"refused: {', '.join(refused)}")
    for fault in faults:
        print("FAULT", fault)
    return 1 if faults or seen < 30 else 0


sys.exit(main())
