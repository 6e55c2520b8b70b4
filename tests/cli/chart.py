#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""chart.py PROGRAM SAMPLES: a chart that is interrupted or killed goes on to the figures of an undisturbed one."""
import csv
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

PROGRAM, SAMPLES = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
JOB = [PROGRAM, "chart", SAMPLES / "flat.toml", "--quick", "--size", "12x12", "--pixel-size", "2nm", "--threads", "1",
       "--methods", "default,direct,replay,accuracy", "--physics", "secondaries=off"]
os.environ["SEMSURF_CACHE"] = "off"


def chart(folder, stop=None, job=JOB):
    process = subprocess.Popen([*job, "-o", "chart"], cwd=folder, stdin=subprocess.DEVNULL, text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    while stop and process.poll() is None and not list(folder.glob("chart/points/*.json")):
        time.sleep(0.005)
    if stop:
        process.send_signal(stop)
    out, err = process.communicate(timeout=200)
    return process.returncode, out, err


def expect(truth, *what):
    if not truth:
        sys.exit(" ".join(map(str, what)))


def figures(folder):
    """Everything but times and memory."""
    rows = list(csv.DictReader(open(folder / "chart" / "chart.csv")))
    return [{k: v for k, v in row.items() if k not in ("run_s", "preparation_s", "peak_mb")} for row in rows]


with tempfile.TemporaryDirectory(prefix="semsurf-test-") as name:
    folders = [pathlib.Path(name) / case for case in ("undisturbed", "interrupted", "killed")]
    for folder in folders:
        folder.mkdir()
    ended, out, err = chart(folders[0])
    expect(ended == 0, "the undisturbed chart failed", err)
    for text in ("replay", "rms errors", "reference: ", "--accuracy 10 %", "written chart/chart.svg"):
        expect(text in out, text, "is not in", out)
    for file in ("chart.svg", "chart.png", "chart.csv", "chart.json", "reference/1.exr"):
        expect((folders[0] / "chart" / file).stat().st_size > 100, file, "is not there")
    report = json.loads((folders[0] / "chart" / "chart.json").read_text())
    expect(len(report["points"]) == len(figures(folders[0])) / 2, "chart.json and chart.csv disagree")
    for folder, stop, code in ((folders[1], signal.SIGINT, 130), (folders[2], signal.SIGKILL, -9)):
        ended, _, err = chart(folder, stop)
        expect(ended == code, folder.name, "ended with", ended, err)
        expect(stop != signal.SIGINT or "the same command goes on" in err, "said", err)
        expect(not (folder / "chart" / "chart.csv").exists(), folder.name, "left a table")
        ended, out, err = chart(folder)
        expect(ended == 0, folder.name, "could not be resumed:", err)
        expect("there before" in out, folder.name, "made everything anew:", out)
        expect(figures(folder) == figures(folders[0]), folder.name, "gave other figures")
    # All is there: nothing is run, and other settings are another job.
    ended, out, _ = chart(folders[0])
    expect(f"{len(report['points'])} points were there" in out, out)
    ended, out, _ = chart(folders[0], job=[*JOB, "--seed", "2"])
    expect(ended == 0 and "there before" not in out, out)
