#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""library.py PROGRAM: builds, lists, damages, rebuilds, interrupts and removes libraries of cascades.

Whatever is done to the cache, a library that is built again has the bytes it had."""
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
TIMEOUT_SECONDS = 240
FAST = ["--energy", "150eV"]

faults = []


def expect(truth, fault):
    if not truth:
        faults.append(fault)
        print("FAULT:", fault)


class Cache:
    def __init__(self, folder):
        self.folder = folder / "cache"
        self.environment = {**os.environ, "SEMSURF_CACHE": str(self.folder)}

    def start(self, *words):
        return subprocess.Popen([PROGRAM, "library", *map(str, words)], env=self.environment,
                                stdin=subprocess.DEVNULL, text=True, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE)

    def run(self, *words, code=0):
        process = self.start(*words)
        out, err = process.communicate(timeout=TIMEOUT_SECONDS)
        print(f"--- {' '.join(map(str, words))}: {process.returncode}\n{out}{err}", end="")
        expect(process.returncode == code, f"{words}: exit code {process.returncode}, not {code}")
        return out + err

    def files(self):
        return {path.name: path.read_bytes() for path in self.folder.glob("*.cache")}


def expect_text(pattern, text):
    expect(re.search(pattern, text), f"{pattern!r} is not in:\n{text}")


def builds_lists_and_removes(cache):
    expect_text("no libraries in .*\nMake one: semsurf library build", cache.run("list"))
    expect_text("Si at 150 eV .* 4096 cascades, .* kB each; 4096 are new",
                cache.run("build", "Si", *FAST, "--cascades", 3000))
    whole = cache.files()
    expect(len(whole) == 2, f"{len(whole)} pages, not 2")
    expect_text("4096 cascades, .*; all were there",
                cache.run("build", "Si", *FAST, "--cascades", 3000, "--threads", 1))
    cache.run("build", "Si", "--energy", "200eV,150eV", "--cascades", 1, "--physics",
              "elastic=browning", "--cutoff", "60eV", "--seed", 7)
    listed = cache.run("list", "--check")
    expect_text(r"Si +150 eV +default +1 +4096 .* just now +good", listed)
    expect_text(r"Si +200 eV +elastic=browning,cutoff=60eV +7 +2048 ", listed)
    expect_text("more than what is named", cache.run("remove", "Si", "--all", code=2))
    before = cache.files()
    expect_text("would free .* in 3 files", cache.run("remove", "--energy", "150eV", "--dry-run"))
    expect(cache.files() == before, "a dry run removed something")
    expect_text("Did you mean Si", cache.run("remove", "Sj", code=2))
    expect_text("Si at 200 eV, 2048 cascades.*\nfreed .* in 1 file\n",
                cache.run("remove", "Si", "--energy", "0.2keV"))
    expect_text("nothing to remove", cache.run("remove", "Si", "--energy", "0.2keV"))
    cache.run("remove", "Si")
    expect(not cache.files(), "something is left")
    cache.run("build", "Si", *FAST, "--cascades", 3000)
    expect(cache.files() == whole, "a library built again differs")


def rebuilds_what_is_damaged(cache):
    cache.run("build", "Si", *FAST, "--cascades", 4096)
    whole = cache.files()
    for name, damaged in zip(whole, (lambda b: b[:-9], lambda b: b[:5000] + b"!" + b[5001:])):
        (cache.folder / name).write_bytes(damaged(whole[name]))
    expect_text("2 damaged files in the cache are never used.*library remove --damaged",
                cache.run("list", "--check"))
    expect_text("warning: .*was damaged", cache.run("build", "Si", *FAST, "--cascades", 4096))
    expect(cache.files() == whole, "what was damaged is not as it was")
    (cache.folder / next(iter(whole))).write_bytes(b"")
    expect_text("freed 0 B in 1 file", cache.run("remove", "--damaged"))
    expect(len(cache.files()) == 1, "what was damaged is still there")


def keeps_pages_when_interrupted(cache):
    process = cache.start("build", "Au", "--energy", "1keV", "--cascades", 150_000)
    deadline = time.monotonic() + TIMEOUT_SECONDS
    while not cache.files() and time.monotonic() < deadline:
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=TIMEOUT_SECONDS)
    expect(process.returncode == 130, f"interrupted: exit code {process.returncode}\n{out}{err}")
    expect_text("interrupted", err)
    expect_text("all were there", cache.run("build", "Au", "--cascades", 2048))
    expect(not list(cache.folder.glob(".*")), "temporaries are left")


def refuses_without_traces(cache):
    for words, pattern in (((), "Choose list, build, plot or remove"),
                           (("build",), "no material"),
                           (("build", "Si", "--energy", "50eV"), "--energy|energy"),
                           (("build", "Si", "--accuracy", "0"), "--accuracy"),
                           (("build", "Si", "--accuracy", "1%", "--cascades", 1), "--cascades"),
                           (("build", "Si", "--physics", "loss=none"), "loss=joy-luo"),
                           (("build", "Si", "--cache", "off"), "no cache"),
                           (("plot", "Si"), "no output"),
                           (("plot", "Si", "-o", "x.pdf"), "svg or .png"),
                           (("plot", "Si", "-o", "x.svg", "--tilt", "90"), "--tilt"),
                           (("list", "--cache", "off"), "no cache"),
                           (("remove",), "--all"),
                           (("build", "Si", "--cascade", "1"), "Did you mean --cascades"),
                           (("biuld",), "unknown command. Did you mean build")):
        text = cache.run(*words, code=2)
        expect_text(pattern, text)
        expect(text.count("semsurf: error: ") == 1, f"{words}: not one error")
    cache.folder.parent.joinpath("file").write_text("in the way")
    expect_text("cannot be kept", cache.run("build", "Si", *FAST, "--cascades", 1, "--cache",
                                            cache.folder.parent / "file", code=3))
    expect(not cache.folder.exists(), "a cache was begun")


def draws(cache):
    for name, words in (("tilt.svg", FAST), ("energy.png", ("--energy", "150eV,300eV"))):
        chart = cache.folder.parent / name
        table = cache.folder.parent / "measured.csv"
        table.write_text("element,energy_keV,delta\nSi,0.2,0.7\nAu,0.2,1\n")
        text = cache.run("plot", "Si", *words, "--cascades", 2048, "--measured", table, "-o", chart)
        expect(chart.exists() and chart.stat().st_size > 5000, f"{name} was not drawn")
    table.write_text("element,energy_keV,delta\nSi,0.2,0.7\nAu,0.2,x\n")
    expect_text("line 3: 'x' is no delta",
                cache.run("plot", "Si", *FAST, "--measured", table, "-o", chart, code=3))


def main():
    for check in (builds_lists_and_removes, rebuilds_what_is_damaged, keeps_pages_when_interrupted,
                  refuses_without_traces, draws):
        print("====", check.__name__)
        with tempfile.TemporaryDirectory(prefix="semsurf-test-") as name:
            check(Cache(pathlib.Path(name)))
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
