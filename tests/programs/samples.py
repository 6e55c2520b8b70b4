# SPDX-License-Identifier: GPL-3.0-or-later
"""What the checks with other programs share: sample files, skips and comparisons."""
import contextlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile


def need(program, package):
    """The path of a program; without it the test is skipped."""
    found = shutil.which(program)
    if found:
        return found
    print(f"skipped: {program} is not installed (Debian: {package}; ./check --all installs it)")
    sys.exit(77)


@contextlib.contextmanager
def samples():
    """A folder with the samples, and what is expected of the letter."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([sys.argv[1], name], check=True)
        yield folder, json.loads((folder / "expected.json").read_text())


def run(command, home=None):
    """The text that a program prints. Fails if it fails."""
    # Blender takes the first Python on the path for its own.
    path = f"{pathlib.Path(command[0]).parent}:{os.environ.get('PATH', '')}"
    environment = dict(os.environ, LC_ALL="C.UTF-8", PATH=path)
    if home:
        environment["HOME"] = str(home)
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, errors="replace", env=environment, timeout=280)
    if done.returncode != 0:
        fail(f"{command[0]} ended with {done.returncode}:\n{done.stdout}")
    return done.stdout


def fail(message):
    print(f"FAILED: {message}")
    sys.exit(1)


def expect(condition, message, output=""):
    if not condition:
        fail(f"{message}\n{output}")


def close(a, b, allowed=1e-3):
    """Whether two numbers, or all of two lists, agree to within `allowed`."""
    if isinstance(a, (int, float)):
        a, b = [a], [b]
    return len(a) == len(b) and all(abs(x - y) <= allowed for x, y in zip(a, b))


def results(output):
    """The JSON on the line that a script inside of another program printed behind 'RESULT '."""
    lines = [line for line in output.splitlines() if line.startswith("RESULT ")]
    expect(lines, "the script printed no result", output)
    return json.loads(lines[-1][len("RESULT "):])
