#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that C++ files are formatted as .clang-format says. Usage: format.py ROOT | format.py --self-test

Complains, a line per file, and says how to mend it. Exits with 77 where clang-format 14 is not
installed: other versions break lines differently.
"""
import concurrent.futures
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

FOLDERS = ["libsurf", "mc_sim", "io", "workflow", "cli", "samples", "paraview_plugin", "python", "tests", "bench"]
SKIPPED = 77


def formatter():
    for name in ("clang-format-14", "clang-format"):
        program = shutil.which(name)
        if program and " 14." in subprocess.run([program, "--version"], capture_output=True, text=True).stdout:
            return program
    return None


def faults(program, root):
    files = [path for folder in FOLDERS for path in sorted((root / folder).rglob("*"))
             if path.suffix in {".cpp", ".h"} and path.is_file()]
    batches = [files[i:i + 40] for i in range(0, len(files), 40)]

    def run(batch):
        command = [program, "--style=file", "--dry-run", "--Werror", "--ferror-limit=1", *map(str, batch)]
        return subprocess.run(command, capture_output=True, text=True).stderr
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        text = "".join(pool.map(run, batches))
    return [line for line in text.splitlines() if ": error:" in line]


def self_test(program, root):
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder)
        shutil.copy(root / ".clang-format", copy)
        (copy / "io").mkdir()
        (copy / "io" / "good.cpp").write_text("int good() { return 1; }\n")
        if faults(program, copy):
            return "a well formatted file is refused"
        (copy / "io" / "long.h").write_text("// " + "word " * 25 + "\n")
        (copy / "io" / "odd.cpp").write_text("int  odd( ) {return 1;}\n")
        found = faults(program, copy)
        if len(found) != 2:
            return f"of two faulty files {len(found)} were found: {found}"
    return None


def main():
    root = pathlib.Path(__file__).resolve().parents[2]
    program = formatter()
    if not program:
        print("skipped: clang-format 14 is not installed (Debian: clang-format-14)")
        return SKIPPED
    if sys.argv[1] == "--self-test":
        fault = self_test(program, root)
        print(fault or "format.py sees faults")
        return 1 if fault else 0
    found = faults(program, root)
    print("\n".join(found) or "all C++ files are formatted")
    if found:
        print(f"Mend them with: {pathlib.Path(program).name} -i FILE...")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
