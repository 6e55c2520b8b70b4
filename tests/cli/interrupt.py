#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""interrupt.py PROGRAM: Ctrl-C ends work on a large scan at once, with 130 and nothing written."""
import array
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
SIZE = 2500


def write_scan(path):
    head = (f"Gwyddion Simple Field 1.0\nXRes = {SIZE}\nYRes = {SIZE}\nXReal = 1e-6\nYReal = 1e-6\n"
            "XYUnits = m\nZUnits = m\n").encode()
    head += b"\0" * (4 - len(head) % 4)
    row = [((x * 7919) % 104729) * 1e-12 for x in range(SIZE)]
    with open(path, "wb") as file:
        file.write(head)
        for y in range(SIZE):
            k = (y * 31) % SIZE
            array.array("f", row[k:] + row[:k]).tofile(file)


with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    write_scan(folder / "large.gsf")
    process = subprocess.Popen([PROGRAM, "clean", "large.gsf", "--median", "1001", "--threads", "1", "-o", "clean.gsf"],
                               cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               text=True)
    time.sleep(3)
    if process.poll() is not None:
        sys.exit(f"it was over before it could be stopped: {process.communicate()}")
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=120)
    left = sorted(file.name for file in folder.iterdir())
    if process.returncode != 130 or left != ["large.gsf"] or "nothing was written" not in err:
        sys.exit(f"code {process.returncode}, files {left}, it said {out!r} {err!r}")
