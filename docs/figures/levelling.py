# SPDX-License-Identifier: GPL-3.0-or-later
"""A scan before and after levelling: levelling.py SEMSURF writes levelling.png."""
from tools import heights_nm, np, picture, plt, save, workshop

with workshop() as (run, folder):
    run("level samples/spikes.gsf --level-method plane -o plane.gsf")
    run("level samples/spikes.gsf -o hough.gsf")
    run("level samples/spikes.gsf --rows median -o rows.gsf")
    data = [heights_nm(path) for path in (folder / "samples/spikes.gsf", folder / "plane.gsf", folder / "hough.gsf", folder / "rows.gsf")]
figure, axes = plt.subplots(1, 4, figsize=(12, 2.9), layout="constrained", sharey=True)
for one, heights, title in zip(axes, data, ("as scanned", "mean plane", "commonest plane (hough)", "and rows by their median")):
    ground = np.median(heights)
    shown = one.imshow(heights - ground, extent=(0, 288, 0, 288), cmap="viridis", vmin=-4, vmax=4)
    one.set(title=title, xlabel="x (nm)")
axes[0].set_ylabel("y (nm)")
figure.colorbar(shown, ax=axes, label="height above the median (nm)", extend="both", shrink=0.9)
save(figure, "levelling.png")
