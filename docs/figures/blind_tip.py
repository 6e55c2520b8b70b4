# SPDX-License-Identifier: GPL-3.0-or-later
"""The tip that is found from a scan, beside the true one: blind_tip.py SEMSURF writes blind_tip.svg."""
from tools import BLACK, BLUE, ORANGE, heights_nm, np, plt, save, workshop

with workshop() as (run, folder):
    run("level samples/spikes.gsf --rows median -o flat.gsf")
    run("clean flat.gsf --spikes 3:4nm -o clean.gsf")
    run("tip clean.gsf --tip-size 31 --height-noise 0.15nm,0.49 -o found.gsf")
    run("tip --shape cone:12nm,20deg --tip-size 31 --height-pitch 2nm -o true.gsf")
    scan, found, true = (heights_nm(folder / name) for name in ("clean.gsf", "found.gsf", "true.gsf"))
figure, (left, right) = plt.subplots(1, 2, figsize=(8, 3.3), layout="constrained", width_ratios=(1, 1.2))
shown = left.imshow(scan, extent=(0, 288, 0, 288), cmap="viridis")
left.set(title="scan of sharp spikes", xlabel="x (nm)", ylabel="y (nm)")
figure.colorbar(shown, ax=left, label="height (nm)", shrink=0.85)
u = (np.arange(31) - 15) * 2
right.plot(u, found[15], "o-", color=BLUE, markersize=3, label="found, along x")
right.plot(u, found[:, 15], "s-", color=ORANGE, markersize=3, label="found, along y")
right.plot(u, true[15], "--", color=BLACK, label="true")
right.set(title="sections of the tip", xlabel="from the apex (nm)", ylabel="height below the apex (nm)", ylim=(-44, 2))
right.legend(loc="lower center")
save(figure, "blind_tip.svg")
