#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""hostile.py PROGRAM SAMPLES: files made to break readers, each through the commands that would read it.

Each run ends with status 0, 2, 3 or 4 within 10 s of processor time and 2 GB of memory, and says what is wrong
where it is not 0. The files are those of $SEMSURF_TEST_DATA/hostile and some that are made here. Exit status 77
without the data."""
import concurrent.futures
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

MOST_BYTES = 2 << 30
MOST_ADDRESSES = 8 << 30    # of which libraries take a part: memory is measured besides
MOST_SECONDS = 10           # of the processor
MOST_WAITING_SECONDS = 120  # on a busy machine
PROGRAM, SAMPLES = sys.argv[1], pathlib.Path(sys.argv[2])
FEW = ["--material", "Si", "--size", "4x4", "--electrons", "1", "-q", "-o", "image.exr"]

MESHES = [["info", "FILE"], ["mesh", "FILE", "-o", "out.ply"], ["simulate", "FILE", *FEW],
          ["view", "FILE", "-o", "page.html"]]
HEIGHTS = [["info", "FILE"], ["level", "FILE", "-o", "out.gsf"], ["noise", "scan", "FILE"],
           ["tip", "FILE", "-o", "tip.gsf"],
           ["simulate", "FILE", *FEW],
           ["predict", "FILE", "--model", str(SAMPLES / "si-1keV-10nm.json"), "-o", "predicted.tif"]]
PICTURES = [["noise", "sem", "FILE"],
            ["calibrate", "FILE", "--images", "FILE", "-o", "calibration.json"]]
SCENES = [["info", "FILE"], ["simulate", "FILE", "--size", "4x4", "--electrons", "1", "-q", "-o", "image.exr"],
          ["materials", "--materials", "FILE"]]
MODELS = [["info", "FILE"], ["predict", str(SAMPLES.parent / "tests/cli/data/block.gsf"), "--model", "FILE", "-o", "p.tif"]]
COMMANDS = {".toml": SCENES, ".gsf": HEIGHTS, ".gwy": HEIGHTS, ".vti": HEIGHTS, ".csv": HEIGHTS, ".json": MODELS,
            ".tif": HEIGHTS + PICTURES, ".png": HEIGHTS + PICTURES, ".exr": HEIGHTS + PICTURES, ".bin": [["info", "FILE"]]}


def commands_for(path):
    return COMMANDS.get(path.suffix.lower(), MESHES)


def made_files(folder):
    """Files that would be too large for a repository, or cannot be in one."""
    deep = "a" + ".a" * 100_000
    made = []
    for name, text in (("keys.toml", deep + "=1"), ("heads.toml", f"[{deep}]"), ("inline.toml", "a={" + deep + "=1}")):
        made.append(folder / name)
        made[-1].write_text(text)
    for ending in (".stl", ".gsf", ".tif", ".exr", ".json", ".csv", ".toml", ".gltf", ".vti"):
        made.append(folder / ("zero" + ending))
        made[-1].symlink_to("/dev/zero")
        made.append(folder / ("pipe" + ending))
        os.mkfifo(made[-1])
    return made


def limit():
    resource.setrlimit(resource.RLIMIT_AS, (MOST_ADDRESSES, MOST_ADDRESSES))
    resource.setrlimit(resource.RLIMIT_CPU, (MOST_SECONDS, MOST_SECONDS + 1))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def run(words):
    """The fault of one run, if any."""
    with tempfile.TemporaryDirectory() as folder:
        errors = pathlib.Path(folder) / "errors.txt"
        with errors.open("wb") as stream:
            process = subprocess.Popen([PROGRAM, *words], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                       stderr=stream, preexec_fn=limit, env={**os.environ, "SEMSURF_CACHE": "off"})
        end = time.monotonic() + MOST_WAITING_SECONDS
        while True:
            done, status, usage = os.wait4(process.pid, os.WNOHANG)
            if done:
                break
            if time.monotonic() > end:
                process.kill()
            time.sleep(0.005)
        process.returncode = code = os.waitstatus_to_exitcode(status)
        said = errors.read_text(errors="replace")
        if code not in (0, 2, 3, 4):
            return f"ended with {code}: {said[-300:]}"
        begin = "semsurf: warning: " if code == 4 else "semsurf: error: "
        if code != 0 and not any(line.startswith(begin) and (code == 4 or ". " in line) for line in said.splitlines()):
            return f"ended with {code} and does not say why: {said[-300:]}"
        if usage.ru_maxrss * 1024 > MOST_BYTES:
            return f"took {usage.ru_maxrss / 2**20:.2f} GiB of memory"
    return None


def main():
    data = os.environ.get("SEMSURF_TEST_DATA")
    hostile = pathlib.Path(data or "", "hostile")
    if not data or not hostile.is_dir():
        print("SEMSURF_TEST_DATA names no folder with hostile files: skipped")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        files = sorted(p for p in hostile.iterdir() if p.is_file()) + made_files(pathlib.Path(folder))
        runs = [[str(path) if word == "FILE" else word for word in words] for path in files for words in commands_for(path)]
        with concurrent.futures.ThreadPoolExecutor(2) as two:
            found = list(two.map(run, runs))
    faults = [f"semsurf {' '.join(words)}: {fault}" for words, fault in zip(runs, found) if fault]
    print(f"{len(files)} files, {len(runs)} runs")
    for fault in faults:
        print("FAULT", fault)
    return 1 if faults or len(files) < 60 else 0


sys.exit(main())
