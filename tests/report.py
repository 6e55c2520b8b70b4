#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tells of ctest's last run which tests took longest and which were skipped, and why. Usage: report.py BUILD

report.py BUILD --keep writes what all tests took to costs.txt beside this script, by which ctest starts the longest
first in a fresh build folder.
"""
import pathlib
import re
import sys

SLOWEST = 10


def tests_of(log):
    """(name, seconds, output) of each test in ctest's log."""
    for part in re.split(r"^(?=\d+/\d+ Testing: )", log, flags=re.MULTILINE)[1:]:
        name = re.match(r"\d+/\d+ Testing: (.*)", part)[1]
        seconds = re.search(r"^Test time = +([\d.]+) sec", part, re.MULTILINE)
        yield name, float(seconds[1]) if seconds else 0.0, part


def skips_of(name, output):
    """What a test program says it left out: (case, reason)."""
    cases = re.findall(r"^\[  SKIPPED \] (\S+) \(", output, re.MULTILINE)
    reasons = re.findall(r"^\S+: Skipped\n(.*(?:\n(?!\[).+)*)", output, re.MULTILINE)
    for i, case in enumerate(cases):
        yield f"{name.split('.')[0]}: {case}", reasons[i].strip() if i < len(reasons) else ""
    if not cases and re.search(r"^Test Skipped|^skipped", output, re.MULTILINE | re.IGNORECASE):
        reason = re.search(r"^(?:skipped|skip)[:,]? *(.*)$", output, re.MULTILINE | re.IGNORECASE)
        yield name, reason[1] if reason else ""


def main():
    folder = pathlib.Path(sys.argv[1]) / "Testing/Temporary"
    if "--keep" in sys.argv:
        costs = (folder / "CTestCostData.txt").read_text().split("---")[0]
        lines = sorted(line.split() for line in costs.splitlines() if line.strip())
        kept = "".join(f"{name} 1 {float(cost):.1f}\n" for name, _, cost in lines if float(cost) >= 0.5)
        (pathlib.Path(__file__).parent / "costs.txt").write_text(kept + "---\n")
        return
    tests = list(tests_of((folder / "LastTest.log").read_text(errors="replace")))
    print("The slowest tests:")
    for name, seconds, _ in sorted(tests, key=lambda t: -t[1])[:SLOWEST]:
        print(f"  {seconds:7.1f} s  {name}")
    skips = [skip for name, _, output in tests for skip in skips_of(name, output)]
    print(f"{len(skips)} skipped" + (":" if skips else ""))
    for name, reason in skips:
        print(f"  {name}" + (f": {reason}" if reason else ""))


if __name__ == "__main__":
    main()
