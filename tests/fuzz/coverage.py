# SPDX-License-Identifier: GPL-3.0-or-later
"""Which edges of which files the corpora reach. Usage: coverage.py BUILD [FILE-PATTERN]

BUILD is a folder of the preset `fuzz`. Each target runs over its corpus and what was grown in BUILD/fuzz. Of each
function that target counts that reaches most of its edges. Most edges that are never reached free what a function
holds while an error is passed on: functions that are not entered tell more. With a pattern, the functions of the
files that match it are listed, the largest gaps first. Needs llvm-symbolizer-16 (package llvm-16)."""

import collections
import os
import pathlib
import re
import shutil
import subprocess
import sys

FOLDERS = ("io/src/", "workflow/src/", "libsurf/src/", "mc_sim/src/")
LINE = re.compile(r"^(?:UN)?COVERED_FUNC: hits: \d+ edges: (\d+)/(\d+) (.*) (/\S+?):(\d+)")


def functions(build, root, target):
    folders = [root / "tests/fuzz/corpus" / target.rstrip("+"), build / "fuzz" / target / "corpus"]
    symbolizer = shutil.which("llvm-symbolizer-16")
    if not symbolizer:
        sys.exit("llvm-symbolizer-16 is missing: install llvm-16")
    run = subprocess.run(
        [build / "bin/fuzz", target, "-runs=0", "-print_coverage=1", "-max_len=131072", "-artifact_prefix=/dev/null",
         *(folder for folder in folders if folder.is_dir())],
        env={**os.environ, "ASAN_OPTIONS": f"detect_leaks=0:external_symbolizer_path={symbolizer}"},
        capture_output=True, text=True, errors="replace", check=False)
    for line in run.stderr.splitlines():
        found = LINE.match(line)
        if not found:
            continue
        reached, total, name, path, number = found.groups()
        path = os.path.relpath(os.path.normpath(path), root)
        if path.startswith(FOLDERS):
            yield (path, int(number), name), int(reached), int(total)


def main():
    root = pathlib.Path(__file__).resolve().parents[2]
    build = pathlib.Path(sys.argv[1]).resolve()
    best = {}
    for folder in sorted((root / "tests/fuzz/corpus").iterdir()):
        grown = [name for name in (folder.name, folder.name + "+") if (build / "fuzz" / name / "corpus").is_dir()]
        for target in grown or [folder.name]:
            for function, reached, total in functions(build, root, target):
                best[function] = max(best.get(function, (0, total)), (reached, total))
    if len(sys.argv) > 2:
        gaps = sorted(((total - reached, path, line, name) for (path, line, name), (reached, total) in best.items()
                       if sys.argv[2] in path), reverse=True)
        for gap, path, line, name in gaps:
            if gap:
                print(f"{gap:5} edges not reached  {path}:{line} {name}")
        return
    files = collections.defaultdict(lambda: [0, 0, 0, 0])
    for (path, _, _), (reached, total) in best.items():
        for i, more in enumerate((reached, total, reached > 0, 1)):
            files[path][i] += more
    for path, (reached, total, entered, functions_) in sorted(files.items(), key=lambda item: item[0]):
        if path.startswith("io/src/") or reached:
            print(f"{100 * reached / total:5.0f} % of {total:5} edges, {entered:3} of {functions_:3} functions  {path}")


if __name__ == "__main__":
    main()
