#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the program needs before it starts, and what it does where modules are missing. Usage: start.py PROGRAM

The number of shared libraries bounds the time of every command; none may be opened later by commands that only look.
A copy of the program without its modules still does what needs none, and says of the rest what to install.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

MOST_LIBRARIES = 40
DATA = pathlib.Path(__file__).parent / "data"
faults = []


def run(program, *arguments, folder, **environment):
    return subprocess.run([program, *arguments], cwd=folder, capture_output=True, text=True, timeout=120,
                          env={**os.environ, "SEMSURF_CACHE": "off", **environment})


def libraries(program, *arguments, folder):
    """The shared libraries that a command has mapped, as the dynamic linker tells."""
    log = pathlib.Path(folder) / "linker"
    done = run(program, *arguments, folder=folder, LD_DEBUG="files", LD_DEBUG_OUTPUT=str(log))
    text = "".join(path.read_text(errors="replace") for path in pathlib.Path(folder).glob("linker.*"))
    for path in pathlib.Path(folder).glob("linker.*"):
        path.unlink()
    if done.returncode != 0:
        faults.append(f"{arguments}: exit {done.returncode}: {done.stderr}")
    return {line.split("file=")[1].split()[0] for line in text.splitlines() if "generating link map" in line}


def expect(what, done, code, *texts):
    said = done.stdout + done.stderr
    print(f"--- {what}: exit {done.returncode}\n{said}")
    if done.returncode != code:
        faults.append(f"{what}: exit {done.returncode}, not {code}: {said}")
    for text in texts:
        if text not in said:
            faults.append(f"{what}: {text!r} is not said: {said}")


def check_start(program, folder):
    for arguments in (["--version"], ["--help"], ["simulate", "--help"], ["info", "cube.stl"], ["completion", "bash"],
                      ["materials"]):
        found = libraries(program, *arguments, folder=folder)
        print(f"{' '.join(arguments)}: {len(found)} shared libraries")
        if not 5 < len(found) <= MOST_LIBRARIES:
            faults.append(f"{arguments}: {len(found)} shared libraries, more than {MOST_LIBRARIES}: {sorted(found)}")


def check_without_modules(program, folder):
    alone = folder / "bin" / "semsurf"
    alone.parent.mkdir()
    shutil.copy2(program, alone)
    few = ["--electrons", "2", "--size", "4x4"]
    expect("version", run(alone, "--version", folder=folder), 0, "OpenImageIO")
    expect("info", run(alone, "info", "cube.stl", folder=folder), 0, "12 triangles")
    expect("mesh", run(alone, "mesh", "cube.stl", "-o", "cube.ply", folder=folder), 0)
    expect("erode", run(alone, "erode", "steps.txt", "--tip", "tip.txt", "--height-pitch", "3nm", "-o", "surface.gsf",
                        folder=folder), 0)
    before = set(folder.iterdir())
    for name, package in (("image.exr", "OpenImageIO"), ("image.vti", "VTK")):
        expect(name, run(alone, "simulate", "cube.off", *few, "-o", name, folder=folder), 3, f"semsurf: error: {name}",
               package, "Install")
    expect("tracks", run(alone, "simulate", "cube.off", *few, "--trajectories", "2", "-o", "image.exr", folder=folder), 3)
    # Several programs that know nothing of each other would write the same file.
    for variables in ({"OMPI_COMM_WORLD_SIZE": "2"}, {"PMI_SIZE": "2"}, {"PMIX_RANK": "0", "SLURM_NTASKS": "2"}):
        expect(f"ranks by {variables}", run(alone, "simulate", "cube.off", *few, "-o", "image.exr", folder=folder, **variables),
               3, "semsurf: error: mpirun", "MPI")
    if set(folder.iterdir()) != before:
        faults.append(f"left behind: {set(folder.iterdir()) - before}")


def check_short_address_space(program, folder):
    """Whatever little there is, the program ends by itself and says why."""
    for megabytes in (150, 300, 450, 600, 750, 900):
        limited = ["bash", "-c", f'ulimit -v {1000 * megabytes}; exec "$@"', "bash", program]
        done = run(limited[0], *limited[1:], "simulate", "cube.off", "--size", "4x4", "--electrons", "2", "-o", "little.exr",
                   folder=folder)
        print(f"{megabytes} MB: exit {done.returncode}: {done.stderr}")
        if done.returncode not in (0, 3) or (done.returncode == 3 and "semsurf: error: " not in done.stderr):
            faults.append(f"{megabytes} MB of address space: exit {done.returncode}: {done.stderr}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory(prefix="semsurf-test-") as name:
        folder = pathlib.Path(name)
        shutil.copytree(DATA, folder, dirs_exist_ok=True)
        made = run(program, "mesh", "cube.off", "-o", "cube.stl", "-q", folder=folder)
        if made.returncode != 0:
            faults.append(made.stderr)
        check_start(program, folder)
        check_without_modules(program, folder)
        check_short_address_space(program, folder)
    for fault in faults:
        print("FAULT:", fault)
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
