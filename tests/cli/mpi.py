#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""mpi.py PROGRAM SAMPLES MPIRUN: several processes give the bytes of one, and go on from what a dead one has left."""
import array
import csv
import json
import math
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import tempfile
import time

PROGRAM, SAMPLES = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
MPIRUN = [sys.argv[3], "--allow-run-as-root", "--oversubscribe", "--mca", "btl_base_warn_component_unused", "0"]
MARK = f"SEMSURF_MPI_TEST={os.getpid()}"
os.environ["SEMSURF_CACHE"] = "off"
# This may itself run below mpirun, which its variables would give away.
for name in [name for name in os.environ if name.startswith(("OMPI_", "PMIX_", "PRTE_", "PMI_"))]:
    del os.environ[name]
name, _, value = MARK.partition("=")
os.environ[name] = value


def start(folder, ranks, words):
    together = [*MPIRUN, "-n", str(ranks)] if ranks else []
    return subprocess.Popen([*together, PROGRAM, *words], cwd=folder, stdin=subprocess.DEVNULL, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def run(folder, ranks, words):
    process = start(folder, ranks, words)
    out, err = process.communicate(timeout=280)
    return process.returncode, out, err


def expect(truth, *what):
    if not truth:
        sys.exit(" ".join(map(str, what)))


def pids():
    """Of the program's processes that this test has started, by rank."""
    found = {}
    for folder in pathlib.Path("/proc").iterdir():
        try:
            if folder.name.isdigit() and (folder / "exe").resolve() == PROGRAM:
                environment = (folder / "environ").read_bytes().decode(errors="replace").split("\0")
                rank = [text for text in environment if text.startswith("OMPI_COMM_WORLD_RANK=")]
                if MARK in environment and rank:
                    found[int(rank[0].partition("=")[2])] = int(folder.name)
        except OSError:
            pass
    return found


def sameness(folder):
    jobs = {"direct": ["--method", "direct", "--electrons", "12"], "replay": ["--method", "replay", "--electrons", "40"],
            "accuracy": ["--method", "replay", "--accuracy", "20%", "--channels", "electrons,model"],
            "direct_accuracy": ["--method", "direct", "--accuracy", "50%"]}
    for job, options in jobs.items():
        words = ["simulate", SAMPLES / "cube.toml", "--size", "40x40", "--threads", "1", *options]
        code, _, err = run(folder, 0, [*words, "-o", f"{job}.exr"])
        expect(code == 0, job, "failed alone:", err)
        for ranks in (1, 2, 3, 4) if job == "replay" else (3,):
            code, out, err = run(folder, ranks, [*words, "-o", f"{job}_{ranks}.exr"])
            expect(code == 0, job, "failed with", ranks, "ranks:", err)
            expect(out.count("written") == 1, job, "was not told once:", out)
            expect((folder / f"{job}_{ranks}.exr").read_bytes() == (folder / f"{job}.exr").read_bytes(),
                   job, "gave other bytes with", ranks, "ranks")
            record = json.loads((folder / f"{job}_{ranks}.run.json").read_text())
            if ranks == 1:
                expect("ranks" not in record, "one process made a team")
                continue
            expect([r["rank"] for r in record["ranks"]] == list(range(ranks)), record["ranks"])
            expect(sum(r["primaries"] for r in record["ranks"]) == record["primaries"], record["ranks"])
            expect(all(r["threads"] == 1 and r["host"] for r in record["ranks"][1:]), record["ranks"])
            expect(sum(r["units"] for r in record["ranks"][1:]) > 0, "nobody helped", record["ranks"])
            # A tally for each unit, sent before the record is.
            expect(all(r["messages"] > r["units"] for r in record["ranks"][1:]), record["ranks"])
            expect(all(r["messages"] > 0 and 0 < r["messaging_seconds"] < 60 for r in record["ranks"]), record["ranks"])


def errors(folder):
    for words, code, text in ((["simulate", SAMPLES / "cube.toml", "--electrons", "0", "-o", "x.exr"], 2, "--electrons"),
                              (["simulate", "none.toml", "-o", "x.exr"], 3, "none.toml"),
                              (["simulate", SAMPLES / "cube.toml", "-o", "x.gif"], 2, "x.gif"),
                              (["simulate", SAMPLES / "cube.toml", "--deposit", "8", "-o", "x.exr"], 2, "--deposit")):
        ended, _, err = run(folder, 2, words)
        expect(ended == code, words, "ended with", ended, err)
        expect(err.count("semsurf: error") == 1 and text in err, words, "said", err)
    expect(not list(folder.glob("x.*")), "something was written")
    # What several cannot share one does.
    code, out, err = run(folder, 2, ["info", SAMPLES / "cube.toml"])
    expect(code == 0 and out.count("100 nm cube") == 1 and "one process" in err, out, err)


def faults(folder):
    words = ["simulate", SAMPLES / "mesa80.toml", "--method", "direct", "--electrons", "240", "--size", "48x48",
             "--threads", "1", "--checkpoint-every", "0.2s"]
    code, _, err = run(folder, 0, [*words, "-o", "whole.exr"])
    expect(code == 0, err)
    chance = random.Random(11)
    for number, (ranks, victim, sign) in enumerate(((2, 1, signal.SIGKILL), (3, 2, signal.SIGKILL), (2, 0, signal.SIGKILL),
                                                    (2, None, signal.SIGTERM))):
        output = f"fault_{number}.exr"
        process = start(folder, ranks, [*words, "-o", output])
        # The checkpoint begins after a tenth of its time at the earliest: something is there to go on from.
        limit = time.monotonic() + 120
        while process.poll() is None and time.monotonic() < limit and not list(folder.glob(f"fault_{number}.*.checkpoint")):
            time.sleep(0.02)
        expect(process.poll() is None, "it was over before anybody died")
        time.sleep(chance.uniform(0, 0.3))
        if victim is None:
            process.send_signal(sign)
        else:
            there = pids()
            expect(victim in there, "rank", victim, "is not among", there)
            os.kill(there[victim], sign)
        _, err = process.communicate(timeout=120)
        expect(process.returncode != 0, "nobody noticed that rank", victim, "died")
        expect(not (folder / output).exists() or json.loads((folder / f"fault_{number}.run.json").read_text())["complete"] is False,
               "an image was left as if it were whole")
        expect(list(folder.glob(f"fault_{number}.*.checkpoint")), "no checkpoint was left:", err)
        code, out, err = run(folder, 4 - ranks, [*words, "-o", output])
        expect(code == 0, "it could not be resumed:", err)
        expect(re.search("done before", out), "it began anew:", out, err)
        expect((folder / output).read_bytes() == (folder / "whole.exr").read_bytes(), "fault", number, "changed the bytes")
    limit = time.monotonic() + 20
    while pids() and time.monotonic() < limit:
        time.sleep(0.1)
    expect(not pids(), "processes are left")


def sweeps(folder):
    words = ["sweep", SAMPLES / "flat.toml", "--vary", "energy=500eV,1keV", "--vary", "tilt=0deg:60deg:30deg", "--size", "8x8",
             "--electrons", "20", "--threads", "1"]
    code, out, err = run(folder, 0, [*words, "-o", "alone"])
    expect(code == 0 and out.count("/6 ") == 6, out, err)
    table = (folder / "alone" / "sweep.csv").read_text()
    for ranks in (2, 3):
        code, out, err = run(folder, ranks, [*words, "-o", f"together{ranks}"])
        expect(code == 0 and out.count("/6 ") == 6, ranks, "ranks told something else:", out, err)
        same_files(folder / f"together{ranks}", folder / "alone")
        tallies = json.loads((folder / f"together{ranks}" / "sweep.run.json").read_text())["ranks"]
        expect(sum(r["whole_runs"] for r in tallies) == 6 and all(r["whole_runs"] > 0 for r in tallies), tallies)
        expect(sum(r["primaries"] for r in tallies) == 6 * 64 * 20, tallies)
    for part in (1, 3):
        code, _, err = run(folder, 0, [*words, "--part", f"{part}/3", "-o", "parts"])
        expect(code == 0, err)
    code, _, err = run(folder, 0, ["sweep", "join", "parts"])
    expect(code == 3 and "2 of 6 runs are missing: 2, 5" in err, err)
    code, _, err = run(folder, 0, [*words, "--part", "2/3", "-o", "elsewhere"])
    expect(code == 0, err)
    code, _, err = run(folder, 0, ["sweep", "join", "parts", "elsewhere"])
    expect(code == 0 and (folder / "parts" / "sweep.csv").read_text() == table, "the parts are not the whole", err)
    code, out, err = run(folder, 0, [*words, "-o", "alone"])
    expect(code == 0 and "6 runs were there before" in out, out, err)
    code, out, err = run(folder, 0, [*words, "--seed", "2", "-o", "alone"])
    expect(code == 0 and "there before" not in out, out, err)
    code, _, err = run(folder, 0, ["sweep", "join", "alone", "parts"])
    expect(code == 0, "two runs of one sweep were refused", err)
    for bad, text in ((["--vary", "tilt=0deg:60:5deg"], "mixes units"), (["--vary", "tlt=1"], "Did you mean tilt"),
                      (["--vary", "energy"], "names no values"), (["--vary", "tilt=0,95"], "--tilt"),
                      (["--vary", "seed=1,2", "--part", "3/2"], "--part"), (["--vary", "tilt=5:0:1"], "does not lead")):
        code, _, err = run(folder, 0, ["sweep", SAMPLES / "flat.toml", *bad, "-o", "bad"])
        expect(code == 2 and text in err, bad, "said", err)
    expect(not (folder / "bad").exists(), "something was written")


def same_files(folder, alone, but=()):
    """Of all that is written but what tells of the run."""
    def results(place):
        return {str(file.relative_to(place)): file.read_bytes() for file in place.rglob("*")
                if file.is_file() and not file.name.endswith(".run.json") and file.name not in but}
    wanted, found = results(alone), results(folder)
    expect(sorted(found) == sorted(wanted), "there are other files in", folder, sorted(found), sorted(wanted))
    for name, data in wanted.items():
        expect(found[name] == data, name, "has other bytes in", folder)


TRAINING = ["train", "--material", "Si", "--energy", "500eV", "--pixel-size", "3nm", "--kind", "secant", "--threads", "1"]


def trainings(folder):
    words = [*TRAINING, "--surfaces", "4", "--surface-size", "16", "--electrons", "4"]
    for place in ("alone", "2", "3"):
        (folder / place).mkdir()
    code, _, err = run(folder / "alone", 0, [*words, "-o", "m.json"])
    expect(code == 0, err)
    expect(not (folder / "alone" / "m.run.json").exists(), "one process made a team")
    for ranks in (2, 3):
        code, out, err = run(folder / str(ranks), ranks, [*words, "-o", "m.json"])
        expect(code == 0 and out.count("written") == 1 and "4 simulated" in out, out, err)
        same_files(folder / str(ranks), folder / "alone")
        tallies = json.loads((folder / str(ranks) / "m.run.json").read_text())["ranks"]
        expect(sum(r["primaries"] for r in tallies) == 4 * 256 * 4, tallies)
        expect(all(r["whole_runs"] > 0 for r in tallies), "somebody had nothing to do:", tallies)
    code, out, err = run(folder / "3", 2, [*words, "-o", "m.json"])
    expect(code == 0 and "0 simulated, 4 there before" in out, out, err)
    for bad, code, text in ((["--surfaces", "2", "--hold-out", "2"], 2, "--hold-out"), (["--kind", "none"], 2, "--kind"),
                            (["none.gsf"], 3, "none.gsf")):
        ended, _, err = run(folder, 2, [*TRAINING, *bad, "-o", "bad.json"])
        expect(ended == code and err.count("semsurf: error") == 1 and text in err, bad, "ended with", ended, err)
    expect(not list(folder.glob("bad*")), "something was written")


def training_faults(folder):
    words = [*TRAINING, "--surfaces", "6", "--surface-size", "24", "--electrons", "60"]
    for place in ("alone", "team"):
        (folder / place).mkdir()
    code, _, err = run(folder / "alone", 0, [*words, "-o", "m.json"])
    expect(code == 0, err)
    for ranks, victim in ((3, 2), (2, 0)):
        before = len(list((folder / "team").rglob("*.exr")))
        process = start(folder / "team", ranks, [*words, "-o", "m.json"])
        limit = time.monotonic() + 120
        while process.poll() is None and time.monotonic() < limit and len(list((folder / "team").rglob("*.exr"))) <= before:
            time.sleep(0.02)
        there = pids()
        expect(process.poll() is None and victim in there, "it was over before anybody died", there)
        os.kill(there[victim], signal.SIGKILL)
        _, err = process.communicate(timeout=120)
        expect(process.returncode != 0, "nobody noticed that rank", victim, "died")
        expect(not (folder / "team" / "m.json").exists(), "a model was made of what was there")
    code, out, err = run(folder / "team", 2, [*words, "-o", "m.json"])
    expect(code == 0 and re.search("[1-6] there before", out), "it began anew:", out, err)
    for name in ["m.json", *(f"m.training/{file.name}" for file in (folder / "alone" / "m.training").glob("*.exr"))]:
        expect((folder / "team" / name).read_bytes() == (folder / "alone" / name).read_bytes(), name, "has other bytes")


def charts(folder):
    words = ["chart", SAMPLES / "flat.toml", "--size", "16x16", "--energy", "500eV", "--physics", "secondaries=off", "--quick",
             "--reference", "1.5%", "--methods", "default,secant", "--threads", "1"]
    code, _, err = run(folder, 0, [*words, "-o", "alone"])
    expect(code == 0, err)

    def figures(place):
        rows = list(csv.reader((folder / place / "chart.csv").read_text().splitlines()))
        return [row[:4] + row[7:] for row in rows]   # without times and memory
    code, out, err = run(folder, 3, [*words, "-o", "together"])
    expect(code == 0 and out.count("chart.csv") == 1, out, err)
    expect(figures("together") == figures("alone"), "three ranks gave other figures")
    expect(len(figures("alone")) == 5, figures("alone"))
    for part in ("reference", "models/images"):
        same_files(folder / "together" / part, folder / "alone" / part, but=["seconds.json"])
    record = json.loads((folder / "together" / "chart.run.json").read_text())
    expect(len(record["ranks"]) == 3 and sum(r["whole_runs"] for r in record["ranks"]) == 4, record)
    (folder / "empty").mkdir()
    code, _, err = run(folder, 2, ["chart", "empty", "-o", "other"])
    expect(code != 0 and "one process" in err and err.count("semsurf: error") == 1, code, err)


def write_field(path, side):
    heights = array.array("f", (1e-9 * (5 * math.sin(i % side / 17) * math.sin(i // side / 23) + i * 7919 % 97 / 200)
                                for i in range(side * side)))
    head = (f"Gwyddion Simple Field 1.0\nXRes = {side}\nYRes = {side}\nXReal = {side * 1e-9}\nYReal = {side * 1e-9}\n"
            "XYUnits = m\nZUnits = m\n").encode()
    path.write_bytes(head + b"\0" * (4 - len(head) % 4) + heights.tobytes())


def shares(folder, words, ranks):
    """Of memory (proportional: what n hold counts for each as 1/n), bytes by rank, while it simulates."""
    process = start(folder, ranks if ranks > 1 else 0, [*words, "--size", "400x400", "--electrons", "240", "--checkpoint-every", "0.2s", "-o", f"long_{ranks}.exr"])
    limit = time.monotonic() + 200
    while process.poll() is None and time.monotonic() < limit and not list(folder.glob(f"long_{ranks}.*.checkpoint")):
        time.sleep(0.05)
    expect(process.poll() is None, "it was over before it was looked at:", *(process.communicate() if process.poll() else ()))
    there = pids() if ranks > 1 else {0: process.pid}
    found = {rank: 1024 * int(re.search(r"^Pss: +(\d+)", pathlib.Path(f"/proc/{pid}/smaps_rollup").read_text(), re.M)[1])
             for rank, pid in there.items()}
    process.terminate()
    process.communicate(timeout=120)
    expect(len(found) == ranks, found)
    return found


def memory(folder):
    for name, side in (("small", 60), ("solid", 500)):
        write_field(folder / "field.gsf", side)
        code, _, err = run(folder, 0, ["mesh", "field.gsf", "--solid", "--plain", "-q", "-o", f"{name}.ply"])
        expect(code == 0, err)
    words = ["simulate", "solid.ply", "--material", "Si", "--method", "direct", "--region=100,100,160,160",
             "--threads", "1"]
    for name, tolerance in (("solid", "0"), ("small", "0.2nm")):
        of_job = ["simulate", f"{name}.ply", "--material", "Si", "--method", "direct", "--threads", "1", "--size", "24x24",
                  "--electrons", "8", "--mesh-tolerance", tolerance]
        for ranks in (0, 3):
            code, _, err = run(folder, ranks, [*of_job, "-o", f"{ranks}.exr"])
            expect(code == 0, ranks, "ranks:", err)
        expect((folder / "0.exr").read_bytes() == (folder / "3.exr").read_bytes(), "sharing changed the bytes")
    alone = sum(shares(folder, words, 1).values())
    three = shares(folder, words, 3)
    more = (sum(three.values()) - alone) / 2
    print(f"alone {alone / 1e6:.0f} MB, three {sum(three.values()) / 1e6:.0f} MB: {more / 1e6:.0f} MB for each more")
    expect(more < 0.75 * alone, "each process more takes", more, "bytes, one alone", alone, three)
    # Someone's specimen is damaged: all say so once.
    (folder / "bad.ply").write_bytes((folder / "solid.ply").read_bytes()[:-7])
    code, _, err = run(folder, 3, ["simulate", "bad.ply", "-o", "x.exr"])
    expect(code == 3 and err.count("semsurf: error") == 1 and "bad.ply" in err, code, err)


with tempfile.TemporaryDirectory(prefix="semsurf-test-") as place:
    for case in sys.argv[4:] or ("sameness", "errors", "memory", "sweeps", "faults", "trainings", "training_faults", "charts"):
        folder = pathlib.Path(place) / case
        folder.mkdir()
        globals()[case](folder)
