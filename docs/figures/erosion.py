# SPDX-License-Identifier: GPL-3.0-or-later
"""Dilation and erosion in a section: erosion.py SEMSURF writes erosion.svg."""
from tools import BLACK, BLUE, GREY, heights_nm, np, plt, save, workshop

PITCH_NM, ROW = 2, 88   # through the block
with workshop() as (run, folder):
    run("tip --shape cone:12nm,20deg --tip-size 31 --height-pitch 2nm -o tip.gsf")
    run("dilate samples/spikes_truth.gsf --tip tip.gsf -o scan.gsf")
    run("erode scan.gsf --tip tip.gsf -o eroded.gsf")
    truth, scan, eroded = (heights_nm(path)[ROW] for path in (folder / "samples/spikes_truth.gsf", folder / "scan.gsf", folder / "eroded.gsf"))
    tip = heights_nm(folder / "tip.gsf")[15]
x = np.arange(len(truth)) * PITCH_NM
figure, axes = plt.subplots(figsize=(7.5, 3), layout="constrained")
axes.fill_between(x, -8, truth, color="#DDDDDD", label="specimen")
axes.plot(x, scan, color=GREY, label="scan: specimen dilated by the tip")
axes.plot(x, eroded, color=BLUE, label="scan eroded by the tip")
at = 104
u = at + (np.arange(31) - 15) * PITCH_NM
shape = np.interp(at, x, scan) - tip[::-1]
axes.plot(u[shape < 75], shape[shape < 75], color=BLACK)
axes.plot([at], [np.interp(at, x, scan)], "o", color=BLACK, markersize=4)
axes.annotate("tip", (u[2], shape[2]), (46, 68), arrowprops={"arrowstyle": "-", "color": BLACK, "linewidth": 0.7})
axes.set(xlim=(40, 250), ylim=(-8, 76), xlabel="x (nm)", ylabel="height (nm)", aspect="equal")
axes.legend(loc="upper right")
save(figure, "erosion.svg")
