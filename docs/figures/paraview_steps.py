#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of ParaView's window, step by step: paraview_steps.py SEMSURF PLUGINS FOLDER [STEP ...].

The steps are those of the test paraview.gui, tests/paraview/gui/pipeline.xml, on a finer scan. After each step ParaView stays
open for a picture. FOLDER is docs/tutorials/images, as paraview_1.png and so on. Needs ParaView, Xvfb, xdotool and ImageMagick.
Numbers after FOLDER choose steps.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/paraview/gui"))
import replay  # noqa: E402

SIZE = 1150, 760   # of the window, pixels


def steps():
    """The events of each step: groups between empty lines."""
    body = re.search(r"<pqevents>(.*)</pqevents>", (replay.HERE / "pipeline.xml").read_text(), re.DOTALL).group(1)
    body = re.sub(r"[^\n]*menu_File.*?OKButton[^\n]*", "", body, flags=re.DOTALL)   # pictures are taken from outside
    return [group for group in re.split(r"\n\s*\n", body) if "pqevent" in group]


def work_of(process):
    """Processor time that a process has used, in ticks."""
    return sum(int(field) for field in pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()[11:13])


def wait_until_idle(process, seconds=240):
    end, before, quiet = time.monotonic() + seconds, -100, 0
    time.sleep(4)
    while quiet < 4 and time.monotonic() < end:
        now = work_of(process)
        quiet = quiet + 1 if now - before <= 3 else 0
        before = now
        time.sleep(1)


def take(display, arguments, picture, environment, width=920, colours=64):
    """Starts ParaView, waits until it has nothing to do, and takes a picture of its window."""
    process = subprocess.Popen(["paraview", "--dr", *arguments], env={**environment, "DISPLAY": display},
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        wait_until_idle(process)
        # Warnings are told in a window of their own, which would cover the picture.
        subprocess.run(["xdotool", "search", "--name", "Output Messages", "windowunmap"], env={**environment, "DISPLAY": display},
                       stderr=subprocess.DEVNULL)
        time.sleep(1)
        subprocess.run(["import", "-display", display, "-window", "root", "-crop", "{}x{}+0+0".format(*SIZE), "+repage",
                        "-resize", f"{width}x", "-dither", "None", "-colors", str(colours), "-strip", str(picture)], check=True)
    finally:
        process.kill()
        process.wait()
    print(f"written {picture.name}", flush=True)


def environment_of(folder, plugins):
    """Of a user who has never started ParaView."""
    folder.chmod(0o700)
    return {**os.environ, "HOME": str(folder), "XDG_RUNTIME_DIR": str(folder), "LIBGL_ALWAYS_SOFTWARE": "1",
            "LC_ALL": "C.UTF-8", "PV_PLUGIN_PATH": str(plugins)}


def main():
    semsurf, plugins, output = (pathlib.Path(name).resolve() for name in sys.argv[1:4])
    only = sys.argv[4:]
    with tempfile.TemporaryDirectory(prefix="semsurf_steps_") as name:
        folder = pathlib.Path(name)
        environment = environment_of(folder, plugins)
        subprocess.run([semsurf, "sample", "nist0523-thin", "--size", "140x100", "--electrons", "1", "-o", folder / "thin", "-q"], check=True)
        names = {**replay.NAMES, "SCAN": str(folder / "thin/afm.gsf"), "OUT": name}
        with replay.Screen() as display:
            for count in range(1, len(steps()) + 1):
                if only and str(count) not in only:
                    continue
                script = "\n".join(["<?xml version=\"1.0\" ?>", "<pqevents>", *steps()[:count], "</pqevents>"])
                for key, value in names.items():
                    script = script.replace(f"@{key}@", value)
                path = folder / "steps.xml"
                path.write_text(script)
                take(display, [f"--test-directory={name}", f"--test-script={path}"], output / f"paraview_{count}.png", environment)


if __name__ == "__main__":
    main()
