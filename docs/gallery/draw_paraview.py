# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of docs/how-to/paraview.md: from a scan to a surface and what an SEM would show of it.

    semsurf sample nist0523-thin --size 140x100 --electrons 1 -o thin
    PV_PLUGIN_PATH=build/lib/semsurf_paraview xvfb-run -a pvpython docs/gallery/draw_paraview.py thin/afm.gsf docs/how-to/paraview.png

The picture there is reduced to 256 colours.
"""
import os
import sys

from paraview import simple

scan_file, output = sys.argv[1:]

level = simple.LevelScan(Input=simple.AFMScanReader(FileName=scan_file))
eroded = simple.ErodebyTip(Input=level, Tip=simple.EstimateTip(Input=level))
surface = simple.HeightFieldtoSurface(Input=eroded)
sem = simple.SimulateSEM(Input=surface, Pixels=180, Electrons=16)
# Faster electrons, for tracks long enough to be seen beside the lines.
fast = simple.SimulateSEM(Input=surface, Pixels=16, Electrons=1, Energy=5000, Trajectories=80)
surface.UpdatePipeline()
bounds = surface.GetDataInformation().GetBounds()
middle = [(bounds[0] + bounds[1]) / 2, (bounds[2] + bounds[3]) / 2, 0]
size = [480, 360]


def view(caption, towards, distance, focus=middle):
    made = simple.CreateView("RenderView")
    made.ViewSize = size
    made.OrientationAxesVisibility = 0
    made.UseColorPaletteForBackground = 0
    made.Background = [1, 1, 1]
    text = simple.Show(simple.Text(Text=caption), made)
    text.Color, text.FontSize, text.WindowLocation = [0, 0, 0], 13, "Upper Center"
    length = sum(x * x for x in towards) ** 0.5
    made.CameraFocalPoint = focus
    made.CameraPosition = [focus[i] + distance * towards[i] / length for i in range(3)]
    made.CameraViewUp = [0, 0, 1]
    return made


def show(source, into, array, limits=None, **look):
    shown = simple.Show(source, into)
    simple.ColorBy(shown, ("POINTS", array))
    colours = simple.GetColorTransferFunction(array)
    colours.NanOpacity = 0   # beyond the image
    if limits:
        colours.RescaleTransferFunction(*limits)
    else:
        shown.RescaleTransferFunctionToDataRange(False)
    shown.SetScalarBarVisibility(into, False)
    for name, value in look.items():
        setattr(shown, name, value)
    return shown


away, far = (-0.25, -1, 0.9), 1.9 * (bounds[1] - bounds[0])
views = [view("AFM scan, levelled", away, far), view("eroded by the tip estimated from it", away, far),
         view("simulated SEM image on the surface", away, far)]
show(simple.HeightFieldtoSurface(Input=level), views[0], "height", (0, 100))
show(surface, views[1], "height", (0, 100))
show(simple.DrapeImageonSurface(Input=surface, Image=sem), views[2], "SE", (0.4, 2.6), Ambient=0.6, Diffuse=0.5)
close = view("80 electrons of 5 keV in it", (-0.3, -1, 0.35), 1900, [middle[0], middle[1], -120])
show(surface, close, "height", (0, 100), Opacity=0.35)
show(simple.OutputPort(fast, 1), close, "energy_ev", LineWidth=1.5)
views.append(close)

layout = simple.CreateLayout("all")
layout.SplitHorizontal(0, 0.5)
layout.SplitVertical(1, 0.5)
layout.SplitVertical(2, 0.5)
for cell, made in zip([3, 5, 4, 6], views):
    layout.AssignView(cell, made)
layout.SetSize(2 * size[0], 2 * size[1])
simple.SaveScreenshot(output, layout, ImageResolution=[2 * size[0], 2 * size[1]], SeparatorWidth=0)
sys.stdout.flush()
os._exit(0)   # ParaView's own end may crash without a window
