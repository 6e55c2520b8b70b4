# SPDX-License-Identifier: GPL-3.0-or-later
"""What docs/how-to/paraview_window.png shows, for a screenshot of ParaView's window: landmarks in a scan and in an SEM image of
the same place. FOLDER is as 'semsurf sample nist0523-thin --size 140x100 -o FOLDER' makes it.

    FOLDER=thin PV_PLUGIN_PATH=build/lib/semsurf_paraview paraview --script=docs/gallery/paraview_landmarks.py
"""
import json
import os
import pathlib

from paraview import simple

folder = pathlib.Path(os.environ["FOLDER"])
in_scan = [(1108, 1023), (680, 1275), (985, 650)]   # a crossing, an end, where two lines part
xx, xy, x0, yx, yy, y0 = json.loads((folder / "truth.json").read_text())["sem_to_afm"]
scale = xx * yy - xy * yx
in_sem = [((yy * (x - x0) - xy * (y - y0)) / scale, (xx * (y - y0) - yx * (x - x0)) / scale) for x, y in in_scan]


def show(image, places, name, view):
    simple.Show(image, view)
    view.InteractionMode = "2D"
    simple.ResetCamera(view)
    simple.SetActiveView(view)
    line = simple.PolyLineSource(registrationName=name, Points=[c for x, y in places for c in (x, y, 0)])
    shown = simple.Show(line, view)
    shown.LineWidth = 2
    shown.AmbientColor = shown.DiffuseColor = [1, 0.3, 0.2]
    return line


left = simple.GetActiveViewOrCreate("RenderView")
layout = simple.GetLayout(left)
scan = simple.AFMScanReader(registrationName="afm.gsf", FileName=str(folder / "afm.gsf"))
show(simple.LevelScan(Input=scan), in_scan, "places in the scan", left)
right = simple.CreateView("RenderView")
layout.SplitHorizontal(0, 0.5)
simple.AssignViewToLayout(right, layout, 2)
sem = simple.SEMImageReader(registrationName="sem.tif", FileName=str(folder / "sem.tif"))
simple.SetActiveSource(show(sem, in_sem, "places in the SEM image", right))
simple.RenderAllViews()
