#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What `import semsurf` costs, and a simulation in Python beside the program's.

    PYTHONPATH=$PWD/build/python python3 bench/python_calls.py [PAIRS]

Program and Python take turns, each with the start of its process, so that what else the machine does meets both. Told are the
median of the ratios of pairs with its 90 % interval (of order statistics), and the floor: the program beside itself.
"""
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).parents[1]
PROGRAM = os.environ.get("SEMSURF", str(ROOT / "build/bin/semsurf"))
SCENE = ROOT / "samples/mesa80.toml"
CALL = (f"import semsurf; semsurf.simulate({str(SCENE)!r}, size=(256, 256), electrons=30, output='ours.exr')")
COMMAND = [PROGRAM, "simulate", str(SCENE), "--size", "256x256", "--electrons", "30", "-o", "theirs.exr", "-q"]


def seconds(command, folder):
    start = time.perf_counter()
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    return time.perf_counter() - start


def interval(values):
    """The median and its 90 % interval."""
    ordered = sorted(values)
    low = max(0, round(len(ordered) / 2 - 0.82 * len(ordered) ** 0.5 - 0.5))
    return statistics.median(ordered), ordered[low], ordered[-1 - low]


def main():
    pairs = int(sys.argv[1]) if len(sys.argv) > 1 else 12
    python = [sys.executable, "-B", "-c"]
    ratios, floor, starts = [], [], []
    with tempfile.TemporaryDirectory() as folder:
        seconds(COMMAND, folder), seconds([*python, CALL], folder)        # caches are warm
        for k in range(pairs):
            first = seconds(COMMAND, folder)
            ours = seconds([*python, CALL], folder)
            second = seconds(COMMAND, folder)
            ratios.append(ours / (0.5 * (first + second)))
            floor.append(first / second)
            starts.append(seconds([*python, "import semsurf"], folder) - seconds([*python, "pass"], folder))
        same = (pathlib.Path(folder) / "ours.exr").stat().st_size == (pathlib.Path(folder) / "theirs.exr").stat().st_size
    for what, values in (("Python / program", ratios), ("program / program", floor)):
        print("{:18} {:.4f} ({:.4f} to {:.4f})".format(what, *interval(values)))
    print("import             {:.3f} s ({:.3f} to {:.3f})".format(*interval(starts)))
    print(f"one simulation     {second:.2f} s; files of {'one size' if same else 'DIFFERENT sizes'}")


if __name__ == "__main__":
    main()
