#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""resume.py PROGRAM: stops a simulation in every way there is and starts the same command again.

Whatever happens, killed at any time, interrupted, with other threads, with a checkpoint that is cut
off or damaged, the files in the end have the bytes of an undisturbed run, and no checkpoint is left.
Checkpoints of other jobs and files of other kinds are never touched."""
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

DATA = pathlib.Path(__file__).parent / "data"
PROGRAM = pathlib.Path(sys.argv[1]).resolve()
TIMEOUT_SECONDS = 240
JOB = ["simulate", "cube.off", "--material", "Si", "--substrate", "Si", "--size", "40x40",
       "--electrons", "50", "--method", "direct", "--spectra", "--checkpoint-every", "0.1s"]
OUTPUTS = ["image.exr", "image.spectra.csv"]

faults = []
chance = random.Random(1)


def expect(truth, fault):
    if not truth:
        faults.append(fault)
        print("FAULT:", fault)


class Run:
    """One command in a folder; its exit code and what it said."""

    def __init__(self, folder, *words, job=JOB, output="image.exr", **how):
        command = [PROGRAM, *job, *map(str, words), "-o", output]
        self.process = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL, text=True,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, **how)

    def stop(self, signal_number, seconds):
        try:
            self.process.wait(seconds)
        except subprocess.TimeoutExpired:
            self.process.send_signal(signal_number)
        return self.end()

    def stop_with_checkpoint(self, signal_number, folder):
        while self.process.poll() is None and not any(c.stat().st_size > 20_000
                                                      for c in checkpoints(folder)):
            time.sleep(0.01)
        self.process.send_signal(signal_number)
        return self.end()

    def end(self):
        self.out, self.err = self.process.communicate(timeout=TIMEOUT_SECONDS)
        self.code = self.process.returncode
        return self

    def share(self):
        found = re.search(r"resuming: (\d+) % is done", self.err)
        return int(found[1]) if found else 0


def checkpoints(folder):
    return sorted(folder.glob("*.checkpoint"))


def expect_same(folder, reference, case):
    for name in OUTPUTS:
        same = (folder / name).read_bytes() == reference[name]
        expect(same, f"{case}: {name} differs from that of an undisturbed run")
    expect(not checkpoints(folder), f"{case}: a checkpoint is left")


def killed(folder, *words):
    """The checkpoint of a run that was killed soon after it had begun one."""
    Run(folder, *words).stop_with_checkpoint(signal.SIGKILL, folder)
    return checkpoints(folder)[0]


def killed_at_any_time(folder, reference, seconds):
    shares = []
    for attempt in range(6):
        run = Run(folder, "--threads", 1 + attempt % 3)
        run.stop(signal.SIGKILL, seconds * chance.uniform(0.05, 0.3))
        shares.append(run.share())
        if run.code == 0:
            break
    if run.code != 0:
        killed(folder)   # on a busy machine none of them may have lived until its first checkpoint
        run = Run(folder).end()
        shares.append(run.share())
    print(f"killed at any time; done on starting: {shares} %")
    shares = [share for share in shares if share > 0]   # those that lived long enough to say it
    expect(run.code == 0, f"killed: exit {run.code}: {run.err}")
    expect(shares == sorted(shares) and shares, f"killed: work was lost: {shares}")
    expect_same(folder, reference, "killed")


def interrupted(folder, reference, _):
    run = Run(folder).stop_with_checkpoint(signal.SIGINT, folder)
    expect(run.code == 130, f"interrupted: exit {run.code}")
    expect("the same command goes on from there" in run.err, f"interrupted: says {run.err}")
    expect(len(checkpoints(folder)) == 1, "interrupted: no checkpoint")
    expect((folder / "image.exr").exists(), "interrupted: no partial image")
    run = Run(folder, "--threads", 3).end()
    expect(run.share() > 0 and "done before" in run.out, "interrupted: does not go on")
    expect_same(folder, reference, "interrupted")


def damaged(folder, reference, _):
    def cut(data):
        return data[:-7]

    def flip(data):
        at = len(data) * 2 // 3
        return data[:at] + bytes([data[at] ^ 64]) + data[at + 1:]

    def flip_first(data):
        return data[:200] + bytes([data[200] ^ 1]) + data[201:]

    for change, words in ((cut, "damaged or cut off"), (flip, "damaged or cut off"),
                          (flip_first, "begins anew"), (lambda data: data[:3], "begins anew"),
                          (lambda data: b"", "")):
        file = killed(folder)
        file.write_bytes(change(file.read_bytes()))
        run = Run(folder).end()
        expect(run.code == 0, f"damaged: exit {run.code}: {run.err}")
        expect(words in run.err, f"damaged: does not say '{words}': {run.err}")
        expect_same(folder, reference, "damaged")


def changed(folder, reference, _):
    file = killed(folder)
    before = file.read_bytes()
    few = ["--seed", "2", "--region", "0,0,1,1"]
    job = [word for word in JOB if word not in ("--size", "40x40")] + ["--size", "2x2"]
    run = Run(folder, *few, job=job).end()
    expect(run.code == 0 and run.share() == 0, "changed: the job does not run on its own")
    expect("is left as it is" in run.err and "there and" in run.err, f"changed: says {run.err}")
    expect(file.read_bytes() == before, "changed: the other job's checkpoint was touched")

    file = file.rename(folder / "mine.checkpoint")
    run = Run(folder, *few, "--checkpoint", file, job=job).end()
    expect(run.code == 3 and "another job" in run.err and "--restart" in run.err,
           f"changed: exit {run.code}, {run.err}")
    expect(file.read_bytes() == before, "changed: a named checkpoint was touched")
    run = Run(folder, "--checkpoint", file).end()
    expect(run.share() > 0, "changed: the named checkpoint is not used")
    expect_same(folder, reference, "changed")

    killed(folder, "--checkpoint", file)
    run = Run(folder, "--checkpoint", file, "--restart", *few, job=job).end()
    expect(run.code == 0 and "begins anew" in run.err and not file.exists(),
           f"changed: --restart ends with {run.code}: {run.err}")

    notes = folder / "notes.txt"
    notes.write_text("not a checkpoint\n")
    run = Run(folder, "--checkpoint", notes, "--restart").end()
    expect(run.code == 3 and "not a checkpoint" in run.err, f"a foreign file: {run.code}: {run.err}")
    expect(notes.read_text() == "not a checkpoint\n", "a foreign file was touched")
    notes.unlink()


def two_at_once(folder, reference, _):
    killed(folder)
    first = Run(folder)
    while "resuming" not in first.process.stderr.readline():
        pass
    second = Run(folder).end()
    expect(second.code == 3 and "another semsurf" in second.err,
           f"two at once: the second ends with {second.code}: {second.err}")
    expect(first.end().code == 0, f"two at once: the first ends with {first.code}")
    expect_same(folder, reference, "two at once")


def full_disk(folder, reference, _):
    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (45_000, 45_000))

    run = Run(folder, preexec_fn=limit).end()
    expect(run.code == 0 and run.err.count("The job goes on") == 1,
           f"full disk: exit {run.code}: {run.err}")
    expect_same(folder, reference, "full disk")


def off(folder, reference, seconds):
    for share in (0.3, 0.1, 0.03):   # it may be faster than the first was
        run = Run(folder, "--checkpoint", "off").stop(signal.SIGINT, seconds * share)
        if run.code != 0:
            break
    expect(run.code == 130 and not checkpoints(folder), "off: a checkpoint was written")
    run = Run(folder, "--deposit", "4").stop(signal.SIGINT, seconds * 0.3)
    expect(run.code in (3, 130) and not checkpoints(folder), "deposit: a checkpoint was written")
    if run.code == 130:
        expect("begins anew" in run.err, f"deposit: says {run.err}")


def accuracy(folder, _, __):
    """Pixels that get as many electrons as they need, of stored cascades."""
    job = ["simulate", "cube.off", "--material", "Si", "--substrate", "Si", "--size", "96x96",
           "--energy", "500", "--physics", "secondaries=off", "--accuracy", "6%",
           "--cache", "cache", "--checkpoint-every", "0.1s"]
    run = Run(folder, job=job).end()
    expect(run.code in (0, 4), f"accuracy: exit {run.code}: {run.err}")
    reference, code = (folder / "image.exr").read_bytes(), run.code
    run = Run(folder, "--threads", 1, job=job).stop_with_checkpoint(signal.SIGKILL, folder)
    expect(checkpoints(folder), "accuracy: no checkpoint")
    run = Run(folder, "--threads", 3, job=job).end()
    expect(0 < run.share() < 100 and "done before" in run.out, f"accuracy: does not go on: {run.err}")
    expect(run.code == code, f"accuracy: exit {run.code} instead of {code}")
    expect((folder / "image.exr").read_bytes() == reference, "accuracy: other bytes")
    expect(not checkpoints(folder), "accuracy: a checkpoint is left")


def tolerance(folder, _, __):
    """Work done within one tolerance of the geometry is not taken for another's."""
    job = ["simulate", "rough.toml", "--size", "40x40", "--electrons", "40", "--method", "direct",
           "--spectra", "--checkpoint-every", "0.1s"]
    file = folder / "mine.checkpoint"
    run = Run(folder, job=job).end()
    reference = (folder / "image.exr").read_bytes()
    run = Run(folder, "--checkpoint", file, job=job).stop_with_checkpoint(signal.SIGKILL, folder)
    for other in ("0.3nm", "0"):
        run = Run(folder, "--checkpoint", file, "--mesh-tolerance", other, job=job).end()
        expect(run.code == 3 and "mesh_tolerance_nm 0.2 there" in run.err,
               f"tolerance {other}: exit {run.code}, {run.err}")
    run = Run(folder, "--checkpoint", file, job=job).end()
    expect(run.code == 0 and run.share() > 0, f"tolerance: does not go on: {run.err}")
    expect((folder / "image.exr").read_bytes() == reference, "tolerance: other bytes")


def main():
    os.environ["SEMSURF_CACHE"] = "off"
    with tempfile.TemporaryDirectory(prefix="semsurf-test-") as name:
        def fresh(case):
            return pathlib.Path(shutil.copytree(DATA, pathlib.Path(name) / case))

        folder = fresh("undisturbed")
        start = time.monotonic()
        run = Run(folder).end()
        seconds = time.monotonic() - start
        print(f"undisturbed: {seconds:.1f} s\n{run.out}{run.err}")
        reference = {file: (folder / file).read_bytes() for file in OUTPUTS}
        expect_same(folder, reference, "undisturbed")
        for case in (killed_at_any_time, interrupted, damaged, changed, two_at_once, full_disk, off,
                     accuracy, tolerance):
            case(fresh(case.__name__), reference, seconds)
    sys.exit(1 if faults else 0)


main()
