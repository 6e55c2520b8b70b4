# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the examples of all help texts, as docs/reference/commands.md lists them, and of pages that are made of such (PAGES): each
ends well, or with 4 (the result is written, but not to be trusted), on files of a reader that readers_files.sh makes, small.
Usage: run_examples.py ROOT SEMSURF [--small | --as-written] [PATTERN]
Those that take more than some seconds (SLOW) are left out, or alone are run: with --small on few pixels, electrons and surfaces,
with --as-written as they are. PATTERN: those alone in which it is found."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

PAGES = ("docs/reference/commands.md", "docs/how-to/chart.md", "docs/how-to/many_machines.md")
BLOCK = re.compile(r"^```sh\n(.*?)^```", re.MULTILINE | re.DOTALL)
# Simulations of whole images, trainings, fits and charts.
SLOW = re.compile(r"^(mpirun|semsurf (simulate|train|sweep|chart|profile|refine|reconstruct|register|library (build|plot)"
                     r"|noise counts|sample (nist0523-thick|terrain))\b)|compare surface.vti|sample pads -o pads && |materials Si --plot")
# No commands that can be run; and one that refines a whole reconstruction, which is an hour's work, by the options of another.
SHELL = re.compile(r"semsurf (completion|\S+( \S+)? \[)|^source| (SHELL|FOLDER|NAME|\.\.\.)$|wafer\.toml|refine result/")
# What --small sets, always and in place of what is there. Commands that are not here (profiles, refinements, a change that is seen in an
# SEM image) have no smaller form that ends well.
SMALL = {
    "simulate": ({"--size": "24x18"}, {"--accuracy": "30%", "--time": "5s", "--electrons": "32"}),
    "sweep": ({"--size": "6x4"}, {"--accuracy": "50%"}),
    "sweep join": ({}, {}),
    "train": ({}, {"--surfaces": "3", "--hold-out": "1"}),   # and what small_training() says
    "noise counts": ({"--electrons": "1,4"}, {}),
    "sample": ({"--size": "96x72"}, {}),
    "library build": ({}, {"--accuracy": "20%"}),
    "library plot": ({"--cascades": "2048"}, {}),
    "materials": ({}, {}),
    "chart": ({"--accuracy": "10%", "--surfaces": "3", "--surface-size": "24"}, {}),
    "register": ({}, {}),
    "reconstruct": ({"--corrections": "0"}, {}),
}
LARGE = re.compile(r"chart (samples/mesa80|cube|scan)|chart pads")   # minutes in any case, and other tests draw them
# What a command takes for done: by its beginning.
SIMULATED = "semsurf simulate surface.gsf --material Si --pixel-size 10nm --electrons 50 -q"
BEFORE = {
    "semsurf sweep join ": "rm -rf mesa seeds; for part in 1/2 2/2; do semsurf sweep samples/mesa80.toml --vary seed=1:4:1 "
                           "--size 4x4 --electrons 2 -o mesa --part $part || exit; done; cp -r mesa seeds",
    "semsurf reconstruct --afm scan.gwy --sem up.tif": f"{SIMULATED} -o up.tif && {SIMULATED} --tilt 3deg -o tilted.tif",
}
LIMIT_S = 900


def examples(text):
    """The commands of each section, without what is said about them."""
    for block in BLOCK.finditer(text):
        commands, goes_on = [], False
        for line in block[1].splitlines():
            if goes_on:
                commands[-1] += " " + line.strip().rstrip("\\")
            elif not line.startswith("    "):
                commands.append(re.split(r" {3,}| {2,}#", line.rstrip("\\"))[0].strip())
            goes_on = line.endswith("\\")
        commands = [c for c in commands if c.startswith(("semsurf", "mpirun")) and not SHELL.search(c)]
        if commands:
            yield commands


def with_option(words, option, value):
    """The words of a command with this option, in place of the same one."""
    if option in words:
        place = words.index(option)
        return [*words[:place + 1], value, *words[place + 2:]]
    return [*words, option, value]


def small_training(words):
    """Options of a training that learns little from what it is given, or from three surfaces."""
    if "--images" in words or "--signal" in words:
        return {}
    kind = words[words.index("--kind") + 1] if "--kind" in words else "facet-network"
    of_kind = {"facet-network": {"--iterations": "20"}, "slope-table": {"--table-electrons": "100"}}.get(kind, {})
    own = {} if any(w.endswith(".gsf") for w in words) else {"--surfaces": "3", "--surface-size": "24"}
    return {**of_kind, **own, **({} if kind == "slope-table" else {"--electrons": "10"})}


def small(command):
    """The same command for a small job; None where there is none."""
    if LARGE.search(command):
        return None
    command = re.sub(r"mpirun -n \d", "mpirun -n 2", command)
    if " register " in command or " reconstruct " in command:
        command = command.replace("--material Si --energy 1keV", "--model si.json")   # which is trained on the way
    parts = []
    for part in command.split(" && "):
        words = part.split()
        called = words.index("semsurf")
        name = next((n for n in (" ".join(words[called + 1:called + 3]), words[called + 1]) if n in SMALL), None)
        if not name:
            return None
        always, in_place = SMALL[name]
        if name == "train":
            always = small_training(words)
        for option, value in [*always.items(), *((o, v) for o, v in in_place.items() if o in words)]:
            words = with_option(words, option, value)
        if name == "chart" and "--quick" not in words:
            words.append("--quick")
        parts.append(" ".join(words))
    return " && ".join(parts)


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
    pattern = next((a for a in rest if not a.startswith("--")), "")
    slow, smaller = {"--small", "--as-written"} & set(rest), "--small" in rest
    sections = [commands for page in PAGES for commands in examples((root / page).read_text())]
    count, faults, done = 0, [], set()
    with tempfile.TemporaryDirectory(prefix="semsurf-examples-") as name:
        top = pathlib.Path(name)
        environment = {**os.environ, "PATH": f"{program.parent}:{os.environ['PATH']}", "SEMSURF_CACHE": str(top / "cache"),
                       "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                       "OMPI_MCA_rmaps_base_oversubscribe": "1"}
        reader = top / "reader"
        reader.mkdir()
        (reader / "samples").symlink_to(root / "samples")
        (reader / "data").symlink_to(root / "data")
        subprocess.run(["bash", root / "tests/docs/readers_files.sh", *(["images"] if "--as-written" in rest else [])], cwd=reader,
                       env=environment, check=True)
        for number, commands in enumerate(sections):
            chosen = [c.replace("/data/cache", "cache") for c in commands if re.search(pattern, c) and bool(SLOW.search(c)) == bool(slow)]
            if smaller:
                chosen = [c for c in map(small, chosen) if c]
            chosen = [c for c in chosen if c not in done]
            if not chosen:
                continue
            done.update(chosen)
            folder = top / str(number)
            shutil.copytree(reader, folder, symlinks=True)
            for command in chosen:
                began = time.monotonic()
                before = next((b for start, b in BEFORE.items() if command.startswith(start)), "true")
                fault = run(before, folder, environment) or run(command, folder, environment)
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
