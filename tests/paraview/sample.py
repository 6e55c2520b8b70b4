# SPDX-License-Identifier: GPL-3.0-or-later
"""The script of the samples runs, and its result is what it says."""
import os
import subprocess

from support import FOLDER, SOURCE, array, expect, fetch, numpy, run, simple


def the_documented_script_runs():
    clean = {key: value for key, value in os.environ.items() if not key.startswith(("OMPI_", "PMIX_"))}
    done = subprocess.run(["pvpython", SOURCE / "samples" / "paraview_pipeline.py"], cwd=FOLDER, capture_output=True,
                          text=True, env=clean)
    expect(done.returncode == 0 and "triangles, heights" in done.stdout and "ERR|" not in done.stderr,
           done.stdout + done.stderr)
    got = fetch(simple.AFMScanReader(FileName=str(FOLDER / "out" / "surface.gsf")))
    heights = array(got, got.GetPointData().GetScalars().GetName())
    expect(heights.shape == (101, 201) and 29 < numpy.ptp(heights) < 31, f"{heights.shape}, {numpy.ptp(heights)} nm")
    seen = fetch(simple.XMLImageDataReader(FileName=[str(FOLDER / "out" / "sem.vti")]))
    yields = array(seen, "SE")
    # Edges are brighter than what is flat.
    expect(yields.shape == (32, 64) and 0.3 < yields.mean() < 2 and yields.max() > 2 * numpy.median(yields),
           f"{yields.shape}, {yields.mean()} on average, {numpy.median(yields)} in the middle, {yields.max()}")
    expect(fetch(simple.SurfaceMeshReader(FileName=str(FOLDER / "out" / "surface.glb"))).GetNumberOfPoints() > 100, "glTF")


run(the_documented_script_runs)
