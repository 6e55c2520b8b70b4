# SPDX-License-Identifier: GPL-3.0-or-later
"""Where an eroded scan is the surface: certainty.py SEMSURF writes certainty.png."""
from tools import channels, heights_nm, np, picture, plt, save, workshop

with workshop() as (run, folder):
    run("tip --shape cone:12nm,20deg --tip-size 31 --height-pitch 2nm -o tip.gsf")
    run("level samples/spikes.gsf --rows median -o flat.gsf")
    run("clean flat.gsf --spikes 3:4nm -o clean.gsf")
    run("certainty clean.gsf --tip tip.gsf --height-noise 0.15nm -o map.tif --eroded eroded.gsf")
    run("certainty clean.gsf --tip tip.gsf --height-noise 0.15nm --neighbourhood 0 -o strict.tif")
    eroded, truth = heights_nm(folder / "eroded.gsf"), heights_nm(folder / "samples/spikes_truth.gsf")
    certain, strict = (channels(folder / name)["certain"] > 0.5 for name in ("map.tif", "strict.tif"))
extent = 0, 288, 0, 288
error = eroded - truth
error -= np.median(error)
figure, axes = plt.subplots(1, 4, figsize=(13, 3.1), layout="constrained")
picture(axes[0], eroded, "eroded scan", extent, "height (nm)", cmap="viridis")
for one, shown, title in ((axes[1], certain, "certain (white)"), (axes[2], strict, "with --neighbourhood 0")):
    picture(one, shown, title, extent, cmap="gray", vmin=0, vmax=1)
picture(axes[3], error, "eroded scan less truth", extent, "difference (nm)", cmap="RdBu_r", vmin=-15, vmax=15)
save(figure, "certainty.png")
