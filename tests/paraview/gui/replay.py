#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""From a scan to its SEM image with the mouse, in the real ParaView on a screen that nobody sees. Usage: replay.py
[--keep FOLDER] [--write]; SEMSURF and PV_PLUGIN_PATH as in the other tests. --write makes the pictures to compare with."""
import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
MAIN = "pqClientMainWindow"
PANEL = f"{MAIN}/propertiesDock/propertiesPanel"
NAMES = {"MAIN": MAIN, "APPLY": f"{PANEL}/Accept", "BROWSER": f"{MAIN}/pipelineBrowserDock/pipelineBrowser",
         "PANEL": f"{PANEL}/scrollArea/qt_scrollarea_viewport/scrollAreaWidgetContents/PropertiesFrame/ProxyPanel",
         "PICTURE": f"{MAIN}/SaveScreenshotDialog/scrollArea/qt_scrollarea_viewport/Container/ProxyWidget"}

# Pictures are compared by the means of blocks of pixels, so that fonts, smoothed edges and another Mesa do not matter. The
# bounds are of the worst block and of the mean of all, in grey levels of 255. Where the scan is dilated instead of eroded
# they are 102 and 3.8 for the surface, 96 and 12 for its SEM image; where the surface was deleted again, 144 and 17.
BLOCK, WORST, MEAN = 12, 25, 2.5


def need(program, package):
    if shutil.which(program):
        return
    print(f"skipped: {program} is not installed (Debian: {package}; ./check --all installs it)")
    sys.exit(77)


def fail(message):
    print(f"FAILED: {message}")
    sys.exit(1)


class Screen:
    """An X server without a screen, on a display that is free."""

    def __enter__(self):
        reading, writing = os.pipe()
        # -noreset: it would end with ParaView's first window.
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(writing), "-noreset", "-nolisten", "tcp", "-screen", "0",
                                        "1400x1000x24"], pass_fds=[writing], stdout=subprocess.DEVNULL,
                                       stderr=subprocess.DEVNULL)
        os.close(writing)
        with os.fdopen(reading) as pipe:
            number = pipe.readline().strip()
        if not number:
            fail("Xvfb does not start")
        return f":{number}"

    def __exit__(self, *_):
        self.server.terminate()
        self.server.wait()


def replay(folder, seconds=420):
    scan = folder / "scan"
    subprocess.run([os.environ["SEMSURF"], "sample", "nist0523-thin", "--size", "80x60", "--electrons", "1", "-o", scan,
                    "-q"], check=True, env=dict(os.environ, SEMSURF_CACHE=str(folder / "cache")))
    script = (HERE / "pipeline.xml").read_text()
    for name, value in {**NAMES, "SCAN": str(scan / "afm.gsf"), "OUT": str(folder)}.items():
        script = script.replace(f"@{name}@", value)
    (folder / "pipeline.xml").write_text(script)
    home = folder / "home"
    home.mkdir(mode=0o700)
    with Screen() as display:
        environment = dict(os.environ, HOME=str(home), DISPLAY=display, SEMSURF_CACHE=str(folder / "cache"),
                           XDG_RUNTIME_DIR=str(home), LIBGL_ALWAYS_SOFTWARE="1", LC_ALL="C.UTF-8")
        for name in ["XDG_CONFIG_HOME", "XDG_CACHE_HOME", "QT_SCALE_FACTOR", "WAYLAND_DISPLAY"]:
            environment.pop(name, None)
        try:
            done = subprocess.run(["paraview", "--dr", f"--test-directory={folder}", f"--test-script={folder}/pipeline.xml",
                                   "--exit"], env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                  errors="replace", timeout=seconds)
        except subprocess.TimeoutExpired as late:
            fail(f"ParaView is not through after {seconds} s:\n{(late.output or b'').decode(errors='replace')[-4000:]}")
    if done.returncode != 0 or "ERR|" in done.stdout:
        fail(f"ParaView ended with {done.returncode}:\n{done.stdout[-6000:]}")


def differences(made, wanted):
    """The worst block and the mean of all."""
    import matplotlib.image
    import numpy

    def blocks(path):
        picture = matplotlib.image.imread(path)[..., :3] * 255
        height, width = (n // BLOCK * BLOCK for n in picture.shape[:2])
        return picture[:height, :width].reshape(height // BLOCK, BLOCK, width // BLOCK, BLOCK, 3).mean(axis=(1, 3))
    a, b = blocks(made), blocks(wanted)
    if a.shape != b.shape:
        fail(f"{made.name}: {a.shape} blocks, not {b.shape}")
    off = numpy.abs(a - b)
    return off.max(), off.mean()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the pictures made")
    parser.add_argument("--write", action="store_true", help="make the pictures to compare with")
    options = parser.parse_args()
    need("paraview", "paraview")
    need("Xvfb", "xvfb")
    with tempfile.TemporaryDirectory(prefix="semsurf_gui_") as name:
        folder = pathlib.Path(name)
        replay(folder)
        bad = []
        for picture in ["surface.png", "sem.png"]:
            made = folder / picture
            if not made.exists():
                fail(f"ParaView has not saved {picture}")
            if options.keep:
                options.keep.mkdir(parents=True, exist_ok=True)
                shutil.copy(made, options.keep)
            if options.write:
                shutil.copy(made, HERE / picture)
            worst, mean = differences(made, HERE / picture)
            print(f"{picture}: {worst:.1f} at the worst block, {mean:.2f} on average, of {WORST} and {MEAN} allowed")
            if not (worst <= WORST and mean <= MEAN):
                bad.append(picture)
    if bad:
        fail(f"{' and '.join(bad)} look otherwise than in {HERE}; --keep FOLDER keeps what was made")


if __name__ == "__main__":
    main()
