#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What `import semsurf` costs, and a simulation in Python beside the program's.

    PYTHONPATH=$PWD/build/python python3 bench/python_calls.py [PAIRS]

Program and Python take turns, each with the start of its process, so that what else the machine does meets both. Printed are the
medians of the ratios of pairs with their 90 % intervals (of order statistics), in processor time, which other work disturbs less,
and in wall time; and the floor, the program beside itself. A detector that is a function stands beside the same detector as text.
Ratios of the least times of all pairs stand below: other work only adds to a time.

Electrons are followed by the same object code in both, so that what Python costs more is a fixed amount: its start and numpy's, and
the arrays of the result. It is measured where it is not buried, on images of 8 x 8 pixels, and printed as a share of the large image's time.

A table has other calls: the program with its start, its reading and its writing, and the same call in a Python that runs already and
holds its data, as in a notebook; medians of wall times.
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
SCAN, MODEL, MESH = (str(ROOT / "samples" / name) for name in ("spikes.gsf", "si-1keV-3nm.json", "pyramid.stl"))
CALL = (f"import semsurf; semsurf.simulate({str(SCENE)!r}, size=(256, 256), electrons=30, output='ours.exr')")
WITH_OWN = CALL.replace("ours.exr", "own.exr")
DETECTOR = WITH_OWN.replace("output=", "detector='own:energy=..50eV', output=")
FUNCTION = WITH_OWN.replace("output=", "acceptance={'own': lambda energy, direction: energy < 50}, output=")
COMMAND = [PROGRAM, "simulate", str(SCENE), "--size", "256x256", "--electrons", "30", "-o", "theirs.exr", "-q"]


# What the program is told, what Python holds already, and the call.
FLAT, TIP = "flat = semsurf.level(scan, rows='median')", "tip = semsurf.tip(flat, tip_size=31, height_noise='0.15nm,0.49')"
CALLS = [
    ("level SCAN --rows median -o flat.gsf", "", FLAT),
    ("clean flat.gsf --spikes 3:4nm -o clean.gsf", FLAT, "semsurf.clean(flat, spikes='3:4nm')"),
    ("tip flat.gsf --tip-size 31 --height-noise 0.15nm,0.49 -o tip.gsf", FLAT, TIP),
    ("erode flat.gsf --tip tip.gsf -o eroded.gsf", f"{FLAT}; {TIP}", "semsurf.erode(flat, tip)"),
    ("certainty flat.gsf --tip tip.gsf --height-noise 0.15nm -o map.vti", f"{FLAT}; {TIP}",
     "semsurf.certainty(flat, tip, height_noise='0.15nm')"),
    ("predict flat.gsf --model MODEL --resample -o predicted.vti", FLAT, f"semsurf.predict(flat, model={MODEL!r}, resample=True)"),
    ("simulate flat.gsf --material Si --energy 300eV --pixel-size 4nm --electrons 2 -o image.vti", FLAT,
     "semsurf.simulate(flat, material='Si', energy='300eV', pixel_size='4nm', electrons=2)"),
    ("mesh MESH --repair -o mesh.ply", "mesh = semsurf.read_mesh(MESH)", "semsurf.repair_mesh(mesh)"),
]
TIMED = """
import time, semsurf
scan = semsurf.read_heights({scan!r}); MESH = {mesh!r}
{before}
times = []
for k in range({times}):
    start = time.perf_counter(); {call}; times.append(time.perf_counter() - start)
print(sorted(times)[{times} // 2])
"""


def small(words):
    return [word.replace("256x256", "8x8").replace("(256, 256)", "(8, 8)").replace("rs.exr", "rs_small.exr") for word in words]


def table(folder, times=7):
    """Seconds of each call: the program's, and Python's in a process that runs."""
    for told, before, call in CALLS:
        words = [{"SCAN": SCAN, "MODEL": MODEL, "MESH": MESH}.get(word, word) for word in told.split()]
        program = sorted(seconds([PROGRAM, *words, "-q"], folder)[1] for _ in range(times))[times // 2]
        code = TIMED.format(scan=SCAN, mesh=MESH, before=before or "pass", call=call, times=times)
        done = subprocess.run([sys.executable, "-B", "-c", code], cwd=folder, check=True, capture_output=True, text=True)
        yield told.split(" ")[0], program, float(done.stdout.split()[-1])


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
    least = {"program": [], "Python": []}
    with tempfile.TemporaryDirectory() as folder:
        seconds(COMMAND, folder), seconds([*python, CALL], folder)        # caches are warm
        fixed = [seconds(small([*python, CALL]), folder)[0] - seconds(small(COMMAND), folder)[0] for _ in range(4 * pairs)]
        for k in range(pairs):
            first = seconds(COMMAND, folder)
            ours = seconds([*python, CALL], folder)
            second = seconds(COMMAND, folder)
            for of in range(2):
                ratios[of].append(ours[of] / (0.5 * (first[of] + second[of])))
                floor[of].append(first[of] / second[of])
            least["program"] += [first[0], second[0]]
            least["Python"].append(ours[0])
            functions.append(seconds([*python, FUNCTION], folder)[0] / seconds([*python, DETECTOR], folder)[0])
            starts.append(seconds([*python, "import semsurf"], folder)[1] - seconds([*python, "pass"], folder)[1])
        calls = list(table(folder))
        ours, theirs = ((pathlib.Path(folder) / name).read_bytes() for name in ("ours.exr", "theirs.exr"))
    for what, values in (("Python / program, processor time", ratios[0]), ("program / program, processor time", floor[0]),
                         ("Python / program, wall time", ratios[1]), ("program / program, wall time", floor[1]),
                         ("detector: function / text", functions)):
        print("{:34} {:.4f} ({:.4f} to {:.4f})".format(what, *interval(values)))
    whole = statistics.median(least["program"])
    print("{:34} {:.3f} s ({:.3f} to {:.3f})".format("Python - program, 8 x 8 pixels", *interval(fixed)))
    print("{:34} {:.4f} ({:.4f} to {:.4f})".format("the same of a large image's time", *(1 + f / whole for f in interval(fixed))))
    halves = [min(least["program"][k::2]) for k in (0, 1)]
    print(f"{'least processor times: ratio, floor':34} {min(least['Python']) / min(halves):.4f}, {halves[0] / halves[1]:.4f}")
    print("import                             {:.3f} s ({:.3f} to {:.3f})".format(*interval(starts)))
    print(f"one simulation                     {second[1]:.2f} s; files are {'the same' if ours == theirs else 'DIFFERENT'}")

    print("call        program, s  in Python, s")
    for name, program, ours in calls:
        print(f"{name:10} {program:11.3f} {ours:13.4f}")


if __name__ == "__main__":
    main()
