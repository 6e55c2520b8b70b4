#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What `import semsurf` costs, and a simulation in Python beside the program's.

    PYTHONPATH=$PWD/build/python python3 bench/python_calls.py [PAIRS]

Program and Python take turns, each with the start of its process, so that what else the machine does meets both. Printed are the
medians of the ratios of pairs with their 90 % intervals (of order statistics), in processor time, which other work disturbs less,
and in wall time; and the floor, the program beside itself. A detector that is a function stands beside the same detector as text.
"""
import os
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).parents[1]
PROGRAM = os.environ.get("SEMSURF", str(ROOT / "build/bin/semsurf"))
SCENE = ROOT / "samples/mesa80.toml"
CALL = (f"import semsurf; semsurf.simulate({str(SCENE)!r}, size=(256, 256), electrons=30, output='ours.exr')")
DETECTOR = CALL.replace("output=", "detector='own:energy=..50eV', output=")
FUNCTION = CALL.replace("output=", "acceptance={'own': lambda energy, direction: energy < 50}, output=")
COMMAND = [PROGRAM, "simulate", str(SCENE), "--size", "256x256", "--electrons", "30", "-o", "theirs.exr", "-q"]


def seconds(command, folder):
    """Processor time and wall time."""
    def used():
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        return usage.ru_utime + usage.ru_stime
    start, before = time.perf_counter(), used()
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    return used() - before, time.perf_counter() - start


def interval(values):
    """The median and its 90 % interval."""
    ordered = sorted(values)
    low = max(0, round(len(ordered) / 2 - 0.82 * len(ordered) ** 0.5 - 0.5))
    return statistics.median(ordered), ordered[low], ordered[-1 - low]


def main():
    pairs = int(sys.argv[1]) if len(sys.argv) > 1 else 12
    python = [sys.executable, "-B", "-c"]
    ratios, floor, functions, starts = ([], []), ([], []), [], []
    with tempfile.TemporaryDirectory() as folder:
        seconds(COMMAND, folder), seconds([*python, CALL], folder)        # caches are warm
        for k in range(pairs):
            first = seconds(COMMAND, folder)
            ours = seconds([*python, CALL], folder)
            second = seconds(COMMAND, folder)
            for of in range(2):
                ratios[of].append(ours[of] / (0.5 * (first[of] + second[of])))
                floor[of].append(first[of] / second[of])
            functions.append(seconds([*python, FUNCTION], folder)[0] / seconds([*python, DETECTOR], folder)[0])
            starts.append(seconds([*python, "import semsurf"], folder)[1] - seconds([*python, "pass"], folder)[1])
        same = (pathlib.Path(folder) / "ours.exr").stat().st_size == (pathlib.Path(folder) / "theirs.exr").stat().st_size
    for what, values in (("Python / program, processor time", ratios[0]), ("program / program, processor time", floor[0]),
                         ("Python / program, wall time", ratios[1]), ("program / program, wall time", floor[1]),
                         ("detector: function / text", functions)):
        print("{:34} {:.4f} ({:.4f} to {:.4f})".format(what, *interval(values)))
    print("import                             {:.3f} s ({:.3f} to {:.3f})".format(*interval(starts)))
    print(f"one simulation                     {second[1]:.2f} s; files of {'one size' if same else 'DIFFERENT sizes'}")


if __name__ == "__main__":
    main()
