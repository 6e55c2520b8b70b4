#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""reconstruct.py PROGRAM: a reconstruction that is interrupted or killed goes on to the bytes of an undisturbed one, and
the command in its report makes the same surface again."""
import json
import math
import os
import pathlib
import random
import shlex
import signal
import subprocess
import sys
import tempfile
import time

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
DATA = pathlib.Path(__file__).parent / "data"
PITCH, WIDTH, HEIGHT = 3, 120, 90
os.environ["SEMSURF_CACHE"] = "off"
COMMAND = [PROGRAM, "reconstruct", "--afm", "scan.txt", "--sem", "sem.exr", "--model", str(DATA / "secant.json"), "--transform",
           "1,0,0,0,1,0", "--tip", "cone:8nm,20deg", "--tip-size", "9", "--level-method", "none", "--afm-noise", "0.5,0.01", "--gains", "1,0",
           "--sem-noise", "0,1e-4", "--scales", "6,5,4,3,2,1", "--optimiser", "conjugate-gradients", "--iterations", "12",
           "--optimiser-tolerance", "1e-12", "--no-uncertainty", "--corrections", "1", "--correction-electrons", "8", "--no-picture", "--threads", "1"]


def expect(truth, *what):
    if not truth:
        sys.exit(" ".join(map(str, what)))


def make_inputs(folder):
    dice = random.Random(3)
    rows = [[6 * math.sin(x / 7) * math.cos(y / 9) + dice.gauss(0, 0.1) for x in range(WIDTH)] for y in range(HEIGHT)]
    text = f"# Channel: z\n# Width: {WIDTH * PITCH} nm\n# Height: {HEIGHT * PITCH} nm\n# Value units: nm\n"
    (folder / "scan.txt").write_text(text + "".join("\t".join(f"{z:.6f}" for z in row) + "\n" for row in rows))
    subprocess.run([PROGRAM, "predict", "scan.txt", "--model", DATA / "secant.json", "-o", "raw.exr", "-q"], cwd=folder, check=True)
    (folder / "raw.exr").rename(folder / "sem.exr")


def reconstruct(folder, stop=None, command=None):
    process = subprocess.Popen(command or [*COMMAND, "-o", "result"], cwd=folder, stdin=subprocess.DEVNULL, text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    checkpoint = folder / "result" / "checkpoint"
    while stop and process.poll() is None:
        if checkpoint.exists() and checkpoint.stat().st_size > WIDTH * HEIGHT * 8:   # one scale is done
            process.send_signal(stop)
            break
        time.sleep(0.002)
    out, err = process.communicate(timeout=300)
    return process.returncode, out, err


with tempfile.TemporaryDirectory(prefix="semsurf-test-") as name:
    folders = [pathlib.Path(name) / case for case in ("undisturbed", "interrupted", "killed")]
    for folder in folders:
        folder.mkdir()
        make_inputs(folder)
    ended, out, err = reconstruct(folders[0])
    expect(ended in (0, 4), "the undisturbed reconstruction failed:", out, err)
    result = folders[0] / "result"
    wanted = {f.name: f.read_bytes() for f in result.iterdir()}
    expect("checkpoint" not in wanted, "a checkpoint was left")
    for folder, stop, code in ((folders[1], signal.SIGINT, 130), (folders[2], signal.SIGKILL, -9)):
        stopped, _, err = reconstruct(folder, stop)
        expect(stopped == code, folder.name, "ended with", stopped, err)
        expect(not (folder / "result" / "report.json").exists(), folder.name, "left a report")
        again, out, err = reconstruct(folder)
        expect(again == ended, folder.name, "could not be resumed:", again, err)
        expect("done already: going on from there" in err, folder.name, "began anew:", err)
        there = {f.name: f.read_bytes() for f in (folder / "result").iterdir()}
        expect(there.keys() == wanted.keys(), folder.name, "has other files:", sorted(there))
        for file, content in wanted.items():
            expect(there[file] == content, folder.name, "has another", file)

    words = shlex.split(json.loads(wanted["report.json"])["repeat"])
    expect(words[:2] == ["semsurf", "reconstruct"], "the report repeats another command:", words)
    again, _, err = reconstruct(folders[0], command=[PROGRAM, *words[1:], "--no-picture"])
    expect(again == ended, "the repeated run ended with", again, err)
    for file in ("surface.vti", "surface.gsf", "surface.glb", "simulated_afm.vti", "simulated_sem.vti", "history.csv"):
        expect((folders[0] / "result-again" / file).read_bytes() == wanted[file], "the repeated run gave another", file)
