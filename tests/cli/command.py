#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs one command in a fresh folder with the test files and checks what it does.

command.py [--exit N] [--stdout REGEX]... [--stderr REGEX]... [--writes FILE]... [--interrupt WHEN]
           [--info FILE REGEX] PROGRAM -- ARGUMENTS...

A command that is refused (exit 2 or 3) must leave the folder as it was and say one line that begins
with "semsurf: error: ". --interrupt sends SIGINT once the program
handles it and a file is there that fits WHEN, "" for none. --info then runs
`PROGRAM info FILE` and looks for REGEX in its output.
"""
import argparse
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

DATA = pathlib.Path(__file__).parent / "data"
TIMEOUT_SECONDS = 120


def arguments():
    ours, _, theirs = (sys.argv[1:], None, [])
    if "--" in ours:
        at = ours.index("--")
        ours, theirs = ours[:at], ours[at + 1:]
    parser = argparse.ArgumentParser()
    parser.add_argument("--exit", type=int, default=0)
    parser.add_argument("--stdout", action="append", default=[])
    parser.add_argument("--stderr", action="append", default=[])
    parser.add_argument("--writes", action="append", default=[])
    parser.add_argument("--interrupt")
    parser.add_argument("--info", nargs=2)
    parser.add_argument("program")
    return parser.parse_args(ours), theirs


def handles_interrupts(pid):
    status = pathlib.Path(f"/proc/{pid}/status").read_text()
    caught = int(re.search(r"^SigCgt:\s*(\w+)", status, re.MULTILINE)[1], 16)
    return caught >> (signal.SIGINT - 1) & 1


def run(command, folder, interrupt):
    process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, text=True,
                               env={**os.environ, "SEMSURF_CACHE": "off"}, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    try:
        if interrupt is not None:
            while process.poll() is None and not handles_interrupts(process.pid):
                time.sleep(0.02)
            while interrupt and process.poll() is None and not list(pathlib.Path(folder).glob(interrupt)):
                time.sleep(0.02)
            time.sleep(0.5)
            process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=TIMEOUT_SECONDS)
    finally:
        process.kill()
    return process.returncode, out, err


def listing(folder):
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


def faults(options, folder, command):
    before = listing(folder)
    code, out, err = run(command, folder, options.interrupt)
    new = listing(folder) - before
    print(f"exit {code}, wrote {sorted(new)}\n--- stdout\n{out}--- stderr\n{err}---")
    if code != options.exit:
        yield f"exit code {code} instead of {options.exit}"
    for name, text, patterns in (("stdout", out, options.stdout), ("stderr", err, options.stderr)):
        for pattern in patterns:
            if not re.search(pattern, text):
                yield f"{name} does not match {pattern!r}"
    if options.exit in (2, 3):
        if new:
            yield f"left {sorted(new)} behind"
        if len(re.findall("^semsurf: error: ", err, re.MULTILINE)) != 1:
            yield "stderr has not one line 'semsurf: error: ...'"
    for name in options.writes:
        if name not in new:
            yield f"did not write {name}"
    if options.info:
        name, pattern = options.info
        _, text, _ = run([options.program, "info", name], folder, False)
        if not re.search(pattern, text):
            yield f"info {name} does not match {pattern!r}:\n{text}"


def main():
    options, theirs = arguments()
    with tempfile.TemporaryDirectory(prefix="semsurf-test-") as name:
        folder = pathlib.Path(name)
        shutil.copytree(DATA, folder, dirs_exist_ok=True)
        found = list(faults(options, folder, [options.program] + theirs))
    for fault in found:
        print("FAULT:", fault)
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
