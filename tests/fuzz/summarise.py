# SPDX-License-Identifier: GPL-3.0-or-later
"""One line about a log of libFuzzer. Usage: summarise.py TARGET STATUS LOG"""

import re
import sys


def first(pattern, text, default="0"):
    found = re.search(pattern, text)
    return found.group(1) if found else default


def main():
    target, status, path = sys.argv[1:]
    with open(path, encoding="utf-8", errors="replace") as file:
        log = file.read()
    edges = [(int(run), int(count)) for run, count in re.findall(r"^#(\d+)\s+\w+\s+cov: (\d+)", log, re.MULTILINE)]
    executions = int(first(r"stat::number_of_executed_units: (\d+)", log))
    rate = first(r"stat::average_exec_per_sec: +(\d+)", log)
    read = re.search(r"stat::inputs_read: (\d+) of (\d+)", log)
    share = f"{100 * int(read.group(1)) / max(int(read.group(2)), 1):.0f} %" if read else "?"
    last = edges[-1][1] if edges else 0
    before = max((count for run, count in edges if run <= 0.9 * executions), default=last)
    print(f"{target:<14} {status:>5} {executions:>11,} {rate:>9} {share:>6} {last:>7} {last - before:>8}", flush=True)


if __name__ == "__main__":
    main()
