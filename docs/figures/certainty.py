# SPDX-License-Identifier: GPL-3.0-or-later
"""Where an eroded scan is the surface: certainty.py SEMSURF writes certainty.png."""
from tools import channels, heights_nm, np, picture, plt, save, workshop

with workshop() as (run, folder):
    run("tip --shape cone:12nm,20deg --tip-size 31 --height-pitch 2nm -o tip.gsf")
    run("level samples/spikes.gsf --rows median -o flat.gsf")
    run("clean flat.gsf --spikes 3:4nm -o clean.gsf")
    run("certainty clean.gsf --tip tip.gsf --height-noise 0.15nm -o map.tif --eroded eroded.gsf")
    eroded, truth = heights_nm(folder / "eroded.gsf"), heights_nm(folder / "samples/spikes_truth.gsf")
    certain = channels(folder / "map.tif")["certain"] > 0.5
extent = 0, 288, 0, 288
error = eroded - truth
error -= np.median(error)
figure, axes = plt.subplots(1, 3, figsize=(11, 3.3), layout="constrained")
picture(axes[0], eroded, "eroded scan", extent, "height (nm)", cmap="viridis")
picture(axes[1], certain, "certain (white)", extent, cmap="gray", vmin=0, vmax=1)
picture(axes[2], error, "eroded scan less truth", extent, "difference (nm)", cmap="RdBu_r", vmin=-15, vmax=15)
figure.suptitle(f"rms error {np.std(error[certain]):.1f} nm where certain, {np.sqrt(np.mean(error[~certain] ** 2)):.1f} nm elsewhere", fontsize=9, x=0.01, ha="left")
save(figure, "certainty.png")
