# SPDX-License-Identifier: GPL-3.0-or-later
"""A pvserver of one, two and three ranks gives the bytes of one process, reads and writes its own files, says on the
client what is wrong, and ends when its client does."""
import os
import pathlib
import shutil
import signal
import socket
import subprocess
import sys
import time
import uuid

from support import DATA, FOLDER, array, expect, fetch, messages, run, same, servermanager, simple

MARK = "SEMSURF_SERVER_TEST"   # in the environment of all processes of one server
CLIENTS = {}                   # what a client does, by the function's name


def client(function):
    CLIENTS[function.__name__] = function
    return function


class Server:
    """A pvserver in a folder of its own, with the plugin; nothing of it is left at the end, whatever happens."""

    def __init__(self, ranks):
        self.folder = FOLDER / uuid.uuid4().hex
        self.folder.mkdir()
        self.mark = uuid.uuid4().hex
        with socket.socket() as free:
            free.bind(("localhost", 0))
            self.port = free.getsockname()[1]
        # This process is a run of MPI of its own, which one inside of it would take for its own.
        environment = {key: value for key, value in os.environ.items() if not key.startswith(("OMPI_", "PMIX_", "PRTE_"))}
        self.log = open(self.folder / "server.log", "w+", encoding="utf-8")
        self.process = subprocess.Popen(
            ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", str(ranks), "pvserver", f"--server-port={self.port}"],
            cwd=self.folder, env={**environment, MARK: self.mark}, stdin=subprocess.DEVNULL, stdout=self.log,
            stderr=subprocess.STDOUT)

    def said(self):
        return (self.folder / "server.log").read_text(encoding="utf-8", errors="replace")

    def left(self):
        """Its processes that still run; those that only wait to be collected do not count."""
        found = []
        for entry in pathlib.Path("/proc").iterdir():
            try:
                if entry.name.isdigit() and f"{MARK}={self.mark}".encode() in (entry / "environ").read_bytes():
                    found.append(int(entry.name))
            except OSError:
                pass   # it has ended, or is another user's
        return found

    def __enter__(self):
        try:
            self.wait(lambda: "Accepting connection" in self.said(), 60, "does not listen")
        except BaseException:
            self.__exit__()
            raise
        return self

    def wait(self, condition, seconds, what):
        end = time.monotonic() + seconds
        while not condition():
            expect(time.monotonic() < end, f"the server {what} after {seconds} s:\n{self.said()}")
            time.sleep(0.05)

    def ends(self):
        self.wait(lambda: self.process.poll() is not None and not self.left(), 30, "has not ended")

    def __exit__(self, *_):
        for number in (signal.SIGTERM, signal.SIGKILL):
            for process in self.left():
                try:
                    os.kill(process, number)
                except ProcessLookupError:
                    pass
            end = time.monotonic() + 5
            while (self.process.poll() is None or self.left()) and time.monotonic() < end:
                time.sleep(0.05)
        self.log.close()

    def serve(self, name, *args, code=0):
        """Runs a client to its end; returns what it printed."""
        done = subprocess.run(["pvpython", __file__, name, str(self.port), *map(str, args)], cwd=FOLDER, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=120)
        expect(done.returncode == code, f"the client {name} ends with {done.returncode}\n{done.stdout}\nserver:\n{self.said()}")
        return done.stdout


@client
def pipelines(folder):
    from parallel import save
    save(folder)


@client
def files():
    """The name is one of the server's folder."""
    scan = simple.AFMScanReader(FileName="there.gsf")
    scan.UpdatePipeline()
    count = scan.GetDataInformation().GetNumberOfPoints()
    expect(3000 <= count < 3200, f"{count} points, of which pieces share some")
    servermanager.writers.HeightFieldWriter(Input=scan, FileName="back.gsf").UpdatePipeline()
    simple.SaveData("sheet.off", proxy=simple.HeightFieldtoSurface(Input=scan))
    with messages() as said:
        missing = simple.AFMScanReader(FileName="missing.gsf")
        try:
            missing.UpdatePipeline()
        except RuntimeError:
            pass
    expect("missing.gsf" in said[0], f"nothing is said of the missing file:\n{said[0]}")


@client
def wrong():
    """The client hears what is wrong, and goes on when it is put right."""
    surface = simple.SampleSurface()
    for make, name, bad, good, word in [
            (lambda **p: simple.CleanScan(Input=surface, **p), "MedianWidth", 4, 5, "Median Width"),
            (lambda **p: simple.ErodebyTip(Input=surface, Tip=simple.AFMTip(Pitch=2), **p), "Distance", -1, 1, "Distance"),
            (lambda **p: simple.SimulateSEM(Input=surface, Pixels=8, Electrons=1, **p), "Energy", 50, 1000, "Energy")]:
        with messages() as said:
            source = make(**{name: bad})
            source.UpdatePipeline()
        expect(word in said[0], f"'{word}' is not said on the client:\n{said[0]}")
        count = source.GetDataInformation().GetNumberOfPoints()
        expect(count == 0, f"{word}: {count} points in spite of the error")
        with messages() as said:
            setattr(source, name, good)
            source.UpdatePipeline()
        expect("ERR" not in said[0], f"put right, it complains:\n{said[0]}")
        expect(source.GetDataInformation().GetNumberOfPoints() > 0, f"{word}: no result after it was put right")


@client
def dies():
    simple.LevelScan(Input=simple.SampleSurface()).UpdatePipeline()
    os.kill(os.getpid(), signal.SIGKILL)


def alone():
    """What one process saves without a server."""
    from parallel import save
    folder = FOLDER / "alone"
    if not folder.exists():
        folder.mkdir()
        save(folder)
    return folder


def gives_the_bytes_of_one_process():
    from parallel import compare
    one = alone()
    for ranks in (1, 2, 3):
        with Server(ranks) as server:
            (server.folder / "out").mkdir()
            server.serve("pipelines", server.folder / "out")
            server.ends()
            errors = [line for line in server.said().splitlines() if "ERR|" in line and "Could not receive tag" not in line
                      and "socket processing" not in line]   # ParaView's own, of a client that has gone
            expect(not errors, f"the server complains: {errors}")
            compare(server.folder / "out", one, ranks)


def reads_and_writes_its_own_files():
    for ranks in (1, 2):
        with Server(ranks) as server:
            shutil.copy(DATA / "block.gsf", server.folder / "there.gsf")
            expect(not (FOLDER / "there.gsf").exists(), "the client has no such file")
            server.serve("files")
            server.ends()
            want, got = (fetch(simple.AFMScanReader(FileName=str(path)))
                         for path in (DATA / "block.gsf", server.folder / "back.gsf"))
            same(array(got, got.GetPointData().GetScalars().GetName()), array(want, "Height"), f"written, {ranks} ranks")
            expect((server.folder / "sheet.off").stat().st_size > 0, "the surface is written on the server")


def tells_its_client_what_is_wrong():
    for ranks in (1, 2, 3):
        with Server(ranks) as server:
            server.serve("wrong")
            server.ends()


def ends_with_its_client():
    with Server(2) as server:
        server.serve("dies", code=-signal.SIGKILL)
        server.ends()


def nothing_is_left_of_a_server_without_a_client():
    with Server(2) as server:
        expect(len(server.left()) >= 3, f"mpirun and two ranks: {server.left()}")
    expect(not server.left(), f"still there: {server.left()}")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        simple.Connect("localhost", int(sys.argv[2]))
        CLIENTS[sys.argv[1]](*sys.argv[3:])
        simple.Disconnect()
        sys.stdout.flush()
        os._exit(0)
    from parallel import need
    need("mpirun", "pvserver")
    run(gives_the_bytes_of_one_process, reads_and_writes_its_own_files, tells_its_client_what_is_wrong, ends_with_its_client,
        nothing_is_left_of_a_server_without_a_client)
