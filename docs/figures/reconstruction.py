# SPDX-License-Identifier: GPL-3.0-or-later
"""A section of a surface found from both images, with its interval: reconstruction.py SEMSURF [PADS] writes reconstruction.svg."""
from tools import BLACK, BLUE, ORANGE, heights_nm, make_pads, np, plt, save, workshop

PIXEL_NM, ROW = 10, 42
with workshop() as (run, folder):
    pads = make_pads(run, folder)
    for channel in ("deviation_nm", "start_nm"):
        run(f"level {pads}/result/surface.vti --height-channel {channel} --level-method none -o {channel}.gsf")
    deviation, start = (heights_nm(folder / f"{channel}.gsf")[ROW] for channel in ("deviation_nm", "start_nm"))
    surface, truth = heights_nm(pads / "result/surface.gsf")[ROW], heights_nm(pads / "pads/truth.gsf")[ROW]
x = np.arange(len(truth)) * PIXEL_NM
truth = truth + np.median(surface - truth)
figure, (above, below) = plt.subplots(2, 1, figsize=(7.5, 4.2), sharex=True, layout="constrained", height_ratios=(2, 1))
above.fill_between(x, surface - 2 * deviation, surface + 2 * deviation, color=BLUE, alpha=0.25, linewidth=0, label="two standard deviations")
above.plot(x, start, color=ORANGE, linewidth=1.2, label="eroded scan")
above.plot(x, surface, color=BLUE, label="surface from both images")
above.plot(x, truth, "--", color=BLACK, linewidth=1.1, label="truth")
above.set_ylabel("height (nm)")
above.legend(loc="upper left", fontsize=8)
below.fill_between(x, -2 * deviation, 2 * deviation, color=BLUE, alpha=0.25, linewidth=0)
below.plot(x, surface - truth, color=BLUE, linewidth=1.2)
below.set(xlabel="x (nm)", ylabel="error (nm)", xlim=(1000, 1750), ylim=(-45, 45))
save(figure, "reconstruction.svg")
