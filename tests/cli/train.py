#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""train.py PROGRAM: a training that is interrupted or killed goes on to the bytes of an undisturbed one."""
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
JOB = [PROGRAM, "train", "--material", "Si", "--pixel-size", "3nm", "--surfaces", "3", "--surface-size", "24",
       "--electrons", "40", "--kind", "secant", "--threads", "1"]
os.environ["SEMSURF_CACHE"] = "off"


def train(folder, stop=None):
    process = subprocess.Popen([*JOB, "-o", "si.json"], cwd=folder, stdin=subprocess.DEVNULL, text=True,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    while stop and process.poll() is None and not (folder / "si.training" / "blocks.exr").exists():
        time.sleep(0.01)
    if stop:
        process.send_signal(stop)
    out, err = process.communicate(timeout=200)
    return process.returncode, out, err


def expect(truth, *what):
    if not truth:
        sys.exit(" ".join(map(str, what)))


with tempfile.TemporaryDirectory(prefix="semsurf-test-") as name:
    folders = [pathlib.Path(name) / case for case in ("undisturbed", "interrupted", "killed")]
    for folder in folders:
        folder.mkdir()
    expect(train(folders[0])[0] == 0, "the undisturbed training failed")
    wanted = (folders[0] / "si.json").read_bytes()
    for folder, stop, code in ((folders[1], signal.SIGINT, 130), (folders[2], signal.SIGKILL, -9)):
        ended, _, err = train(folder, stop)
        expect(ended == code, folder.name, "ended with", ended, err)
        expect(not (folder / "si.json").exists(), folder.name, "left a model")
        ended, out, err = train(folder)
        expect(ended == 0, folder.name, "could not be resumed:", err)
        expect("of 3 images are there already" in err, folder.name, "made everything anew:", err)
        expect((folder / "si.json").read_bytes() == wanted, folder.name, "gave another model")
        expect(not list(folder.rglob("*.checkpoint")), folder.name, "left a checkpoint")
