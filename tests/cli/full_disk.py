#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""full_disk.py PROGRAM [MPIRUN]: simulates onto a filesystem that runs full, makes room, and starts the same command again.

The filesystem is one of a megabyte in memory, of a mount namespace of its own: where that cannot be had the test is
skipped. Nothing is lost: the message names the file and what is kept, and the bytes in the end are those of an
undisturbed run, of one process and of two."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

DATA = pathlib.Path(__file__).parent / "data"
PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
MPIRUN = sys.argv[2] if len(sys.argv) > 2 and os.path.exists(sys.argv[2]) else ""
INSIDE = "SEMSURF_FULL_DISK"
SKIPPED = 77
JOB = ["simulate", str(DATA / "cube.off"), "--material", "Si", "--substrate", "Si", "--size", "120x120", "--electrons", "10",
       "--method", "direct", "--cache", "off", "--threads", "1"]

faults = []


def expect(truth, fault):
    if not truth:
        faults.append(fault)
        print("FAULT:", fault)


def simulate(folder, *words, ranks=1, job=JOB):
    start = [MPIRUN, "-n", str(ranks), "--oversubscribe", "--allow-run-as-root"] if ranks > 1 else []
    return subprocess.run([*start, PROGRAM, *job, *words], cwd=folder, text=True, capture_output=True, timeout=240,
                          stdin=subprocess.DEVNULL)


def fill(disk, leave):
    """A file that leaves so many bytes."""
    ballast = disk / "ballast"
    with open(ballast, "wb") as out:
        free = os.statvfs(disk)
        size = free.f_bavail * free.f_frsize - leave
        if size > 0:
            out.write(b"x" * size)
    return ballast


def leftovers(disk):
    return sorted(p.name for p in disk.iterdir() if p.name != "ballast" and not p.name.endswith(".checkpoint"))


def outputs_do_not_fit(disk, reference, ranks):
    """The image is larger than what is left; its checkpoint is not."""
    case = f"outputs on {ranks} rank(s)"
    ballast = fill(disk, 200_000)
    run = simulate(disk, "-o", "image.tif", ranks=ranks)
    expect(run.returncode == 3, f"{case}: exit {run.returncode}: {run.stderr}")
    expect("image.tif" in run.stderr and "Check the free space" in run.stderr, f"{case}: no clear error: {run.stderr}")
    expect(re.search(r"are free there, and this may take", run.stderr), f"{case}: no warning at the start: {run.stderr}")
    kept = re.search(r"what is done is kept in (\S+); the same command goes on from there", run.stderr)
    expect(kept and (disk / kept[1]).exists(), f"{case}: nothing is kept: {run.stderr}")
    expect(leftovers(disk) == [], f"{case}: half-written {leftovers(disk)}")
    ballast.unlink()
    run = simulate(disk, "-o", "image.tif", ranks=ranks)
    expect(run.returncode == 0, f"{case}: then exit {run.returncode}: {run.stderr}")
    expect("resuming: 100 % is done" in run.stderr, f"{case}: began anew: {run.stderr}")
    expect((disk / "image.tif").read_bytes() == reference, f"{case}: other bytes")
    expect(not list(disk.glob("*.checkpoint")), f"{case}: a checkpoint is left")
    (disk / "image.tif").unlink()
    (disk / "image.run.json").unlink()


def checkpoints_do_not_fit(disk, reference, ranks):
    """Where not even the checkpoint fits, the job goes on, says so, and its files are elsewhere."""
    case = f"checkpoint on {ranks} rank(s)"
    ballast = fill(disk, 4096)
    with tempfile.TemporaryDirectory() as other:
        run = simulate(disk, "--checkpoint", "kept.checkpoint", "--checkpoint-every", "0.1s", "-o", f"{other}/image.tif",
                       ranks=ranks)
        expect(run.returncode == 0, f"{case}: exit {run.returncode}: {run.stderr}")
        expect(run.stderr.count("The job goes on") == 1, f"{case}: no warning, or many: {run.stderr}")
        expect(pathlib.Path(other, "image.tif").read_bytes() == reference, f"{case}: other bytes")
    expect(not (disk / "kept.checkpoint").exists(), f"{case}: a checkpoint is left")
    ballast.unlink()


def scratch_does_not_fit(disk, ranks):
    """Results of very many pixels go to a scratch file, whose room is taken at the start."""
    run = simulate(disk, "-o", "image.png", ranks=ranks, job=[w if w != "120x120" else "8192x8192" for w in JOB])
    expect(run.returncode == 3, f"scratch: exit {run.returncode}: {run.stderr}")
    expect("intermediate results cannot be had" in run.stderr, f"scratch: no clear error: {run.stderr}")
    expect(leftovers(disk) == [], f"scratch: {leftovers(disk)} is left")


def all_cases():
    with tempfile.TemporaryDirectory() as folder:
        disk = pathlib.Path(folder, "disk")
        disk.mkdir()
        mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "none", disk], capture_output=True, text=True)
        if mounted.returncode != 0:
            print("skipped: a filesystem cannot be made here:", mounted.stderr.strip())
            return SKIPPED
        try:
            with tempfile.TemporaryDirectory() as elsewhere:
                done = simulate(elsewhere, "-o", "image.tif")
                expect(done.returncode == 0, f"undisturbed: {done.stderr}")
                reference = pathlib.Path(elsewhere, "image.tif").read_bytes()
            for ranks in [1, 2] if MPIRUN else [1]:
                scratch_does_not_fit(disk, ranks)
                outputs_do_not_fit(disk, reference, ranks)
                checkpoints_do_not_fit(disk, reference, ranks)
        finally:
            subprocess.run(["umount", disk], check=False)
    print(f"{len(faults)} faults")
    return 1 if faults else 0


def main():
    if os.environ.get(INSIDE):
        return all_cases()
    probe = subprocess.run(["unshare", "-rm", "true"], capture_output=True, check=False)
    if probe.returncode != 0:
        print("skipped: no mount namespace can be had here")
        return SKIPPED
    return subprocess.run(["unshare", "-rm", sys.executable, *sys.argv], env={**os.environ, INSIDE: "1"}, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
