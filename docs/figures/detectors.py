# SPDX-License-Identifier: GPL-3.0-or-later
"""One scene in several detectors: detectors.py SEMSURF writes detectors.png."""
from tools import channels, np, plt, save, workshop

SHOWN = ("SE", "SE1", "SE2", "BSE", "BSE-left", "BSE-right")
with workshop() as (run, folder):
    run("simulate samples/cube.toml --size 128x128 --electrons 40 --estimate guided --detector SE1 --detector SE2 --detector quadrants -o cube.tif")
    found = channels(folder / "cube.tif")
figure, axes = plt.subplots(1, 6, figsize=(12, 2.5), layout="constrained")
for one, name in zip(axes, SHOWN):
    data = found[name]
    low, high = np.percentile(data, (0.5, 99.7))
    shown = one.imshow(data, cmap="gray", vmin=low, vmax=high)
    one.set_title(name)
    one.axis("off")
    figure.colorbar(shown, ax=one, orientation="horizontal", shrink=0.9, pad=0.02).ax.tick_params(labelsize=7)
figure.supxlabel("electrons per primary", fontsize=8)
save(figure, "detectors.png")
