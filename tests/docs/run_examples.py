# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the examples of all help texts, as docs/reference/commands.md lists them: each ends well, or with 4 (the result is
written, but not to be trusted), on files of a reader that readers_files.sh makes, small.
Usage: run_examples.py ROOT SEMSURF [--hand] [PATTERN]
Without --hand those are left out that take more than some seconds (BY_HAND). PATTERN: those alone in which it is found."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

BLOCK = re.compile(r"^```sh\n(.*?)^```", re.MULTILINE | re.DOTALL)
# Simulations of whole images, trainings, fits and charts.
BY_HAND = re.compile(r"^(mpirun|semsurf (simulate|train|sweep|chart|profile|refine|reconstruct|register|library build)\b)|compare surface.vti"
                     r"|sample pads -o pads && ")
SHELL = re.compile(r"semsurf (completion|\S+( \S+)? \[)|^source|^semsurf \S+ (SHELL|FOLDER|NAME)$")
LIMIT_S = 900


def examples(text):
    """The commands of each section, without what is said about them."""
    for block in BLOCK.finditer(text):
        commands, goes_on = [], False
        for line in block[1].splitlines():
            if goes_on:
                commands[-1] += " " + line.strip().rstrip("\\")
            elif not line.startswith("    "):
                commands.append(re.split(r" {3,}", line.rstrip("\\"))[0].strip())
            goes_on = line.endswith("\\")
        commands = [c for c in commands if c.startswith(("semsurf", "mpirun")) and not SHELL.search(c)]
        if commands:
            yield commands


def run(command, folder, environment):
    try:
        done = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=LIMIT_S)
    except subprocess.TimeoutExpired:
        return f"takes more than {LIMIT_S} s"
    return None if done.returncode in (0, 4) else f"exit code {done.returncode}\n{done.stdout}"


def main():
    root, program = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    rest = sys.argv[3:]
    pattern = next((a for a in rest if a != "--hand"), "")
    sections = list(examples((root / "docs/reference/commands.md").read_text()))
    count, faults = 0, []
    with tempfile.TemporaryDirectory(prefix="semsurf-examples-") as name:
        top = pathlib.Path(name)
        environment = {**os.environ, "PATH": f"{program.parent}:{os.environ['PATH']}", "SEMSURF_CACHE": str(top / "cache"),
                       "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                       "OMPI_MCA_rmaps_base_oversubscribe": "1"}
        reader = top / "reader"
        reader.mkdir()
        (reader / "samples").symlink_to(root / "samples")
        (reader / "data").symlink_to(root / "data")
        subprocess.run(["bash", root / "tests/docs/readers_files.sh", *(["images"] if "--hand" in rest else [])], cwd=reader, env=environment, check=True)
        for number, commands in enumerate(sections):
            chosen = [c for c in commands if re.search(pattern, c) and bool(BY_HAND.search(c)) == ("--hand" in rest)]
            if not chosen:
                continue
            folder = top / str(number)
            shutil.copytree(reader, folder, symlinks=True)
            for command in chosen:
                began = time.monotonic()
                fault = run(command, folder, environment)
                count += 1
                print(f"{time.monotonic() - began:6.1f} s  {command}", flush=True)
                if fault:
                    faults.append(f"{command}\n  {fault}")
    for fault in faults:
        print(fault)
    print(f"{count} examples, {len(faults)} faults")
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main())
