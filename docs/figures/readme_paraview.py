# SPDX-License-Identifier: GPL-3.0-or-later
"""What the README's picture shows of ParaView: FOLDER=pads paraview --script=docs/figures/readme_paraview.py, with a folder as
`semsurf sample pads` makes it."""
import os

from paraview import simple

folder = os.environ["FOLDER"]
left = simple.GetActiveViewOrCreate("RenderView")
scan = simple.AFMScanReader(registrationName="afm.gsf", FileName=f"{folder}/afm.gsf")
level = simple.LevelScan(registrationName="Level Scan", Input=scan)
tip = simple.AFMTip(registrationName="AFM Tip", Radius=70, TipSize=21, Pitch=20)
eroded = simple.ErodebyTip(registrationName="Erode by Tip", Input=level, Tip=tip)
surface = simple.HeightFieldtoSurface(registrationName="Height Field to Surface", Input=eroded)
shown = simple.Show(surface, left)
simple.ColorBy(shown, ("POINTS", "height"))
shown.RescaleTransferFunctionToDataRange(False)
shown.SetScalarBarVisibility(left, True)
left.ResetActiveCameraToNegativeZ()
simple.ResetCamera(left)
camera = simple.GetActiveCamera()
camera.Elevation(-52)
camera.Azimuth(12)
camera.Zoom(1.25)
layout = simple.GetLayout(left)
right = simple.CreateView("RenderView")
layout.SplitHorizontal(0, 0.56)
simple.AssignViewToLayout(right, layout, 2)
sem = simple.SEMImageReader(registrationName="sem.tif", FileName=f"{folder}/sem.tif")
simple.Show(sem, right)
right.InteractionMode = "2D"
simple.ResetCamera(right)
for view in (left, right):
    view.OrientationAxesVisibility = 0
simple.SetActiveSource(surface)
simple.SetActiveView(left)
simple.RenderAllViews()
