# SPDX-License-Identifier: GPL-3.0-or-later
"""What `cmake --install` gives works from a moved folder, without root and without the build."""
import os
import pathlib
import shutil
import subprocess

from support import FOLDER, expect, run

SCRIPT = """
from paraview import simple
surface = simple.SampleSurface()
simple.LevelScan(Input=surface).UpdatePipeline()
print("loaded", simple.HeightFieldtoSurface(Input=surface).GetDataInformation().GetNumberOfPoints())
"""


def works_from_a_moved_folder():
    build = pathlib.Path(os.environ["PV_PLUGIN_PATH"]).parents[1]
    there = subprocess.run(["cmake", "--install", build / "paraview_plugin", "--prefix", FOLDER / "first"],
                           capture_output=True, text=True)
    expect(there.returncode == 0, there.stdout + there.stderr)
    shutil.move(FOLDER / "first", FOLDER / "moved")
    files = [p for p in (FOLDER / "moved").rglob("*") if p.is_file()]
    plugins = [p for p in files if p.name == "semsurf_paraview.so"]
    expect(len(plugins) == 1 and not [p for p in files if p.suffix == ".a"], f"what is installed: {files}")
    environment = {key: value for key, value in os.environ.items() if not key.startswith(("OMPI_", "PMIX_"))}
    environment["PV_PLUGIN_PATH"] = str(plugins[0].parent)
    script = FOLDER / "script.py"
    script.write_text(SCRIPT)
    done = subprocess.run(["pvpython", script], capture_output=True,
                          text=True, env=environment)
    expect("loaded" in done.stdout and done.returncode == 0, done.stdout + done.stderr)
    needed = subprocess.run(["ldd", plugins[0]], capture_output=True, text=True).stdout
    expect("not found" not in needed and str(build) not in needed, needed)


run(works_from_a_moved_folder)
