# SPDX-License-Identifier: GPL-3.0-or-later
"""An image of a wanted accuracy: where electrons go, and how pixels are simulated. replay.py SEMSURF writes replay.png."""
from matplotlib.colors import ListedColormap

from tools import channels, np, plt, save, workshop

with workshop() as (run, folder):
    run("simulate samples/mesa80.toml --size 64x64 --accuracy 12% --channels model,electrons -o mesa.tif")
    found = channels(folder / "mesa.tif")
figure, axes = plt.subplots(1, 4, figsize=(12, 3), layout="constrained")
colours = ListedColormap(["#FFFFFF", "#D55E00", "#0072B2", "#56B4E9", "#BBBBBB"])
error = found["SE.stderr"] / found["SE"] * 100
for one, data, title, label, look in ((axes[0], found["SE"], "SE", "electrons per primary", {"cmap": "gray"}),
                                      (axes[1], found["electrons"], "primaries", "per pixel", {"cmap": "viridis"}),
                                      (axes[2], found["model"], "method", "", {"cmap": colours, "vmin": -0.5, "vmax": 4.5}),
                                      (axes[3], error, "standard error", "% of the pixel's yield", {"cmap": "viridis", "vmin": 0, "vmax": 15})):
    shown = one.imshow(data, **look)
    one.set_title(title)
    one.axis("off")
    bar = figure.colorbar(shown, ax=one, label=label, shrink=0.85)
    if title == "method":
        bar.set_ticks(range(5), labels=["none", "direct", "replay", "difference", "plane"])
save(figure, "replay.png")
