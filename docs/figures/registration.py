# SPDX-License-Identifier: GPL-3.0-or-later
"""An SEM image laid on a scan: registration.py SEMSURF [PADS] writes registration.png."""
import json

from tools import Image, ORANGE, heights_nm, make_pads, np, plt, save, workshop

AFM_NM, SEM_NM = 20, 10
with workshop() as (run, folder):
    pads = make_pads(run, folder)
    run(f"level {pads}/pads/afm.gsf -o {folder}/flat.gsf")
    scan = heights_nm(folder / "flat.gsf")
    sem = np.array(Image.open(pads / "pads/sem.tif"))[::-1]
    xx, xy, x0, yx, yy, y0 = np.ravel(json.loads((pads / "result/transform.json").read_text())["sem_to_afm"])
rows, columns = sem.shape
corner_x, corner_y = np.array([0, 1, 1, 0, 0]) * (columns - 1) * SEM_NM, np.array([0, 0, 1, 1, 0]) * (rows - 1) * SEM_NM
extent = 0, scan.shape[1] * AFM_NM, 0, scan.shape[0] * AFM_NM
low, high = np.percentile(sem, (1, 99.7))
y, x = np.mgrid[:scan.shape[0] * 2, :scan.shape[1] * 2] * AFM_NM / 2
scale = xx * yy - xy * yx
u = np.rint((yy * (x - x0) - xy * (y - y0)) / scale / SEM_NM).astype(int)
v = np.rint((xx * (y - y0) - yx * (x - x0)) / scale / SEM_NM).astype(int)
inside = (u >= 0) & (u < columns) & (v >= 0) & (v < rows)
laid = np.where(inside, sem[np.clip(v, 0, rows - 1), np.clip(u, 0, columns - 1)], np.nan)

figure, axes = plt.subplots(1, 3, figsize=(10.5, 3.9), layout="constrained")
axes[0].imshow(sem, cmap="gray", vmin=low, vmax=high, extent=(0, columns * SEM_NM, 0, rows * SEM_NM))
axes[0].set_title("SEM image")
axes[1].imshow(scan, cmap="viridis", extent=extent)
axes[1].set_title("AFM scan, and where the SEM image lies")
axes[2].imshow(scan, cmap="viridis", extent=extent)
axes[2].imshow(laid, cmap="gray", vmin=low, vmax=high, extent=extent)
axes[2].set_title("SEM image, laid on the scan")
for one in axes[1:]:
    one.plot(xx * corner_x + xy * corner_y + x0, yx * corner_x + yy * corner_y + y0, color=ORANGE)
    one.plot(x0, y0, "o", color=ORANGE)
axes[0].plot(0, 0, "o", color=ORANGE, clip_on=False)
for one in axes:
    one.set(xlabel="x (nm)", ylabel="y (nm)")
save(figure, "registration.png")
