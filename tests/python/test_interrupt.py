# SPDX-License-Identifier: GPL-3.0-or-later
"""Ctrl-C."""
import signal
import subprocess
import sys
import time

import pytest

CODE = """
import sys, time, semsurf
stopped = None
def started(done, total, things):
    if things == "primaries" and done > 0:
        print("started", flush=True)
try:
    semsurf.simulate(sys.argv[1], size=(512, 512), electrons=100000, method="direct", progress=started)
except semsurf.Interrupted as error:
    print("stopped", time.time(), isinstance(error, KeyboardInterrupt))
    partial = error.partial
    print(partial.found.complete, partial.record["partial"], partial["electrons" if 0 else "SE"].shape)
print("alive", semsurf.materials(material="Si").name)
"""


def test_ctrl_c_stops_within_a_fifth_of_a_second(samples):
    process = subprocess.Popen([sys.executable, "-B", "-c", CODE, samples / "rough.toml"], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "started\n"
    delays = time.time()
    process.send_signal(signal.SIGINT)
    lines = [line for line in process.stdout if line != "started\n"]
    assert process.wait(timeout=60) == 0
    word, when, is_keyboard_interrupt = lines[0].split()
    assert word == "stopped" and is_keyboard_interrupt == "True"
    assert lines[1].split()[:2] == ["False", "true"] and lines[2] == "alive Si\n"
    assert float(when) - delays < 0.2 * slowness(), float(when) - delays


def slowness():
    """How many times as long as on an idle processor a fixed piece of work takes; at least 1."""
    def seconds(clock):
        start = clock()
        sum(range(2_000_000))
        return clock() - start
    wall = time.perf_counter()
    cpu = seconds(time.process_time)
    return max(1.0, (time.perf_counter() - wall) / max(cpu, 1e-9)) * 2


@pytest.mark.parametrize("late", [0.0])
def test_ctrl_c_before_the_work(samples, late):
    code = CODE.replace('print("started", flush=True)', "pass").replace("try:", "print('ready', flush=True)\ntry:")
    process = subprocess.Popen([sys.executable, "-B", "-c", code, samples / "rough.toml"], stdout=subprocess.PIPE, text=True,
                               stderr=subprocess.DEVNULL)
    assert process.stdout.readline() == "ready\n"
    time.sleep(late)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=60)
    assert process.returncode is not None
