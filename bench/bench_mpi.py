#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What two processes cost beside two threads of one, and what they say to each other.

    bench/bench_mpi.py [--repeats 7] [--scale 1] [--out docs/development/scaling] [--only CASE ...] [--tables]

Each repeat runs one process with two threads, two ranks with a thread each, bound to a core each, and one process with
one thread, in an order that changes, from a warm cache of cascades. Compared is the time of the simulation proper
(NAME.run.json): scenes, libraries, writing and the start-up of mpirun are apart. Then two ranks at units of work so
small that the leader has no time left (`stress`): what it costs for each unit, for bench/scale_model.
Writes mpi.csv (every run) and mpi.json (what bench/scale_model takes from it); prints tables. --scale 0.2 for a trial,
--tables prints those of the figures that are there.
"""
import argparse
import csv
import json
import os
import pathlib
import platform
import random
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
MPIRUN = ["mpirun", "--allow-run-as-root", "--mca", "btl_base_warn_component_unused", "0"]
RANKS_BOUND = [*MPIRUN, "--map-by", "core", "--bind-to", "core", "-n", "2"]

# What is simulated: scene, options, and electrons or pixels that take about ten seconds on two cores.
CASES = {
    "direct_flat": ("flat.toml", ["--method", "direct", "--size", "128x128"], "--electrons", 60),
    "direct_mesh": ("mesa80.toml", ["--method", "direct", "--size", "128x128"], "--electrons", 40),
    "replay_flat": ("flat.toml", ["--method", "replay", "--size", "256x256"], "--electrons", 200),
    "replay_mesh": ("mesa80.toml", ["--method", "replay", "--size", "256x256"], "--electrons", 60),
    "accuracy_flat": ("flat.toml", ["--method", "replay", "--accuracy", "5%"], "--size", 512),
    "accuracy_mesh": ("mesa80.toml", ["--method", "replay", "--accuracy", "10%"], "--size", 224),
}
# The other rank has many threads on its processor, and so many units in hand: nothing but the leader holds it up.
MANY = 32
MODES = {"threads_2": ([], 2), "ranks_2": (RANKS_BOUND, 1), "alone": ([*MPIRUN, "--bind-to", "none", "-n", "1"], 1)}

# A row of pixels is a unit of work here, a primary a pixel. Beams that meet nothing take a tenth of a microsecond: units
# are as short as they can be, whatever their size.
EMPTY = """title = "beams that meet nothing"
[beam]
energy = "1keV"
[scan]
size = "1x1"
region = "-100,-100,100,100"
[[body]]
material = "Si"
shape = "box"
lower = "-1050,-50,0"
upper = "-1000,50,100"
"""
STRESS = [("empty", 1, 400000), ("empty", 4, 400000), ("empty", 16, 300000), ("empty", 64, 150000), ("empty", 256, 60000),
          ("empty", 1024, 20000), ("flat", 1, 100000), ("flat", 4, 100000), ("flat", 16, 60000), ("flat", 64, 15000)]


def run(folder, mode, words):
    """One run: the figures of a line of mpi.csv."""
    name = folder / "run.exr"
    job = [str(ROOT / "build/bin/semsurf"), "simulate", *map(str, words), "-o", str(name), "--threads"]
    if mode == "stress":
        command = [*RANKS_BOUND[:-2], "-n", "1", *job, "1", ":", "-n", "1", *job, str(MANY)]
    else:
        start, threads = MODES[mode]
        command = [*start, *job, str(threads)]
    begin = time.monotonic()
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    said = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    wall = time.monotonic() - begin
    if status:
        sys.exit(f"{' '.join(command)}\nended with {status}:\n{said}")
    record = json.loads(name.with_suffix(".run.json").read_text())
    ranks = record.get("ranks", [])
    leader, others = (ranks[0], ranks[1:]) if ranks else ({}, [])
    total = lambda key: sum(rank[key] for rank in others)
    return {"mode": mode, "seconds": record["seconds"], "wall_s": wall, "processor_s": usage.ru_utime + usage.ru_stime,
            "primaries": record["primaries"], "primaries_of_others": total("primaries"), "units_of_others": total("units"),
            "bytes": total("bytes_sent"), "messages": total("messages"), "messages_of_leader": leader.get("messages", 0),
            "waiting_s": total("waiting_seconds"), "messaging_s": total("messaging_seconds"),
            "messaging_of_leader_s": leader.get("messaging_seconds", 0)}


def quartiles(values):
    return statistics.quantiles(values, n=4, method="inclusive") if len(values) > 1 else [values[0]] * 3


def interval(values):
    """Of the median, 95 %, by drawing the repeats anew."""
    chance = random.Random(1)
    medians = sorted(statistics.median(chance.choices(values, k=len(values))) for _ in range(4000))
    return medians[100], medians[3899]


def paired(rows, figure):
    """Per repeat: two ranks relative to two threads, less 1."""
    by = {(row["repeat"], row["mode"]): float(row[figure]) for row in rows}
    return [by[r, "ranks_2"] / by[r, "threads_2"] - 1 for r in sorted({repeat for repeat, _ in by})]


def summary(runs):
    out = {}
    for case in dict.fromkeys(row["case"] for row in runs):
        rows = [row for row in runs if row["case"] == case]
        ranks = [row for row in rows if row["mode"] == "ranks_2"]
        per_unit = lambda figure: statistics.median(float(r[figure]) / max(1, int(r["units_of_others"])) for r in ranks)
        over = paired(rows, "seconds")
        out[case] = {
            "repeats": len(over),
            "seconds": {mode: quartiles([float(r["seconds"]) for r in rows if r["mode"] == mode]) for mode in MODES},
            "units": statistics.median(int(r["primaries"]) * int(r["units_of_others"]) / max(1, int(r["primaries_of_others"]))
                                       for r in ranks),
            "overhead": statistics.median(over), "overhead_95": interval(over),
            "processor_overhead": statistics.median(paired(rows, "processor_s")),
            "beside_simulation_s": {m: statistics.median(float(r["wall_s"]) - float(r["seconds"]) for r in rows if r["mode"] == m)
                                    for m in MODES},
            "bytes_per_unit": per_unit("bytes"), "messages_per_unit": per_unit("messages"), "waiting_ms_per_unit": 1e3 * per_unit("waiting_s"),
            "units_of_rank_1": statistics.median(int(r["units_of_others"]) for r in ranks),
            "leader_share": statistics.median(float(r["messaging_of_leader_s"]) / float(r["seconds"]) for r in ranks),
            "messaging_share": statistics.median((float(r["messaging_s"]) + float(r["messaging_of_leader_s"])) / (2 * float(r["seconds"]))
                                                 for r in ranks)}
    return out


def tables(out):
    figures = json.loads((out / "mpi.json").read_text())
    print("| | 2 threads, s | 2 ranks, s | overhead | 95 % | messaging, processor | bytes per unit | waiting per unit, ms | units of rank 1 |")
    print("|---|---|---|---|---|---|---|---|---|")
    for case, s in figures["cases"].items():
        low, high = s["overhead_95"]
        of = {mode: "{1:.2f} ({0:.2f}-{2:.2f})".format(*s["seconds"][mode]) for mode in MODES}
        print(f"| {case} | {of['threads_2']} | {of['ranks_2']} | {100 * s['overhead']:+.1f} % | {100 * low:+.1f} to {100 * high:+.1f} % | "
              f"{100 * s['messaging_share']:.2f} % | {s['bytes_per_unit']:.0f} | {s['waiting_ms_per_unit']:.2f} | {s['units_of_rank_1']:.0f} |")
    print("\n| stress | pixels per unit | alone, us per unit | two ranks, us per unit | leader's messaging, us per unit | bytes per unit |")
    print("|---|---|---|---|---|---|")
    for row in figures["stress"]:
        print(f"| {row['scene']} | {row['pixels_per_unit']} | {row['alone_us']:.1f} | {row['ranks_2_us']:.1f} | "
              f"{row['serving_us']:.1f} | {row['bytes_per_unit']:.0f} |")


def stress(folder, scale, repeats):
    (folder / "empty.toml").write_text(EMPTY)
    scenes = {"empty": folder / "empty.toml", "flat": ROOT / "samples/flat.toml"}
    rows = []
    for scene, pixels, height in STRESS:
        height = max(200, int(height * scale))
        words = [scenes[scene], "--method", "direct", "--electrons", 1, "--size", f"{pixels}x{height}",
                 "--region", "-100,-100,100,100"]
        alone, ranks = [], []
        for _ in range(repeats):
            alone.append(run(folder, "alone", words))
            ranks.append(run(folder, "stress", words))
        middle = lambda runs, figure: statistics.median(figure(r) for r in runs)
        # Wants of units and their answers are part of what a unit of somebody else costs.
        rows.append({"scene": scene, "pixels_per_unit": pixels, "units": height, "threads_of_rank_1": MANY,
                     "alone_us": 1e6 * middle(alone, lambda r: r["seconds"]) / height,
                     "ranks_2_us": 1e6 * middle(ranks, lambda r: r["seconds"]) / height,
                     "units_of_rank_1": middle(ranks, lambda r: r["units_of_others"]),
                     "serving_us": 1e6 * middle(ranks, lambda r: r["messaging_of_leader_s"] / max(1, r["units_of_others"])),
                     "sending_us": 1e6 * middle(ranks, lambda r: r["messaging_s"] / max(1, r["units_of_others"])),
                     "bytes_per_unit": middle(ranks, lambda r: r["bytes"] / max(1, r["units_of_others"])),
                     "messages_per_unit": middle(ranks, lambda r: r["messages"] / max(1, r["units_of_others"]))})
        print(f"stress {scene}, {pixels} pixels per unit:", *(f"{key}={value:.4g}" for key, value in rows[-1].items() if key != "scene"),
              flush=True)
    return rows


def write_rows(path, rows):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        for row in rows:
            writer.writerow({key: f"{value:.7g}" if isinstance(value, float) else value for key, value in row.items()})


def machine(load, asked):
    model = [line.partition(":")[2].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")]
    said = subprocess.run(["mpirun", "--version"], capture_output=True, text=True).stdout
    return {"processor": model[0] if model else platform.machine(), "processors": os.cpu_count(), "load_before": load,
            "scale": asked.scale, "repeats": asked.repeats, "mpirun": said.split("\n")[0]}


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--repeats", type=int, default=7)
    options.add_argument("--scale", type=float, default=1)
    options.add_argument("--out", type=pathlib.Path, default=ROOT / "docs/development/scaling")
    options.add_argument("--only", nargs="+", choices=[*CASES, "stress"], default=[*CASES, "stress"])
    options.add_argument("--tables", action="store_true")
    asked = options.parse_args()
    if asked.tables:
        return tables(asked.out)
    asked.out.mkdir(parents=True, exist_ok=True)
    load = os.getloadavg()[0]
    with tempfile.TemporaryDirectory(prefix="semsurf-bench-") as place:
        folder = pathlib.Path(place)
        os.environ["SEMSURF_CACHE"] = str(folder / "cache")
        runs = []
        for case in [case for case in CASES if case in asked.only]:
            scene, words, grown, size = CASES[case]
            amount = max(1, round(size * asked.scale)) if grown == "--electrons" else max(64, round(size * asked.scale ** 0.5))
            words = [ROOT / "samples" / scene, *words, grown, f"{amount}x{amount}" if grown == "--size" else amount]
            run(folder, "threads_2", words)   # makes the library, and warms up
            for repeat in range(asked.repeats):
                modes = list(MODES)
                modes = modes[repeat % 3:] + modes[:repeat % 3]
                for mode in modes:
                    runs.append({"case": case, "repeat": repeat, **run(folder, mode, words)})
                    print(*(f"{key}={value:.4g}" if isinstance(value, float) else f"{key}={value}" for key, value in runs[-1].items()),
                          flush=True)
        there = asked.out / "mpi.json"
        figures = json.loads(there.read_text()) if there.exists() else {"cases": {}, "stress": []}
        if runs:
            write_rows(asked.out / "mpi.csv", runs)
            figures["cases"] = summary(runs)
        if "stress" in asked.only:
            figures["stress"] = stress(folder, asked.scale, max(1, asked.repeats // 2))
        figures["machine"] = machine(load, asked)
        there.write_text(json.dumps(figures, indent=1) + "\n")
    tables(asked.out)


if __name__ == "__main__":
    main()
