#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of docs/how-to/sample_scenes.md: draw_scenes.py OUTPUT.png FOLDER ..., folders as 'semsurf sample'
makes them. Needs matplotlib, numpy and Pillow."""
import json
import math
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from PIL import Image


def heights_nm(path):
    """Row 0 is the lowest."""
    content = path.read_bytes()
    end = content.index(b"\0")
    fields = dict(line.split("=", 1) for line in content[:end].decode("utf-8", "replace").splitlines() if "=" in line)
    fields = {key.strip(): value.strip() for key, value in fields.items()}
    width, height, first = int(fields["XRes"]), int(fields["YRes"]), end + 4 - end % 4
    return 1e9 * np.frombuffer(content, "<f4", width * height, first).reshape(height, width)[::-1]


def draw(axes, folder):
    truth = json.loads((folder / "truth.json").read_text())
    afm, sem = truth["afm"], truth["sem"]
    scan, pitch = heights_nm(folder / "afm.gsf"), afm["pitch_nm"]
    y, x = np.mgrid[: scan.shape[0], : scan.shape[1]] * pitch
    scan = scan - x * math.tan(math.radians(afm["tilt_x_deg"])) - y * math.tan(math.radians(afm["tilt_y_deg"]))
    xx, xy, x0, yx, yy, y0 = truth["sem_to_afm"]
    right, top = (sem["width"] - 1) * sem["pixel_nm"], (sem["height"] - 1) * sem["pixel_nm"]
    u, v = np.array([0, right, right, 0, 0]), np.array([0, 0, top, top, 0])
    axes[0].imshow(scan, origin="lower", cmap="gray")
    axes[0].plot((xx * u + xy * v + x0) / pitch, (yx * u + yy * v + y0) / pitch, "r", linewidth=0.8)
    axes[0].set_title(truth["sample"], fontsize=7, loc="left")
    axes[1].imshow(heights_nm(folder / "truth.gsf"), origin="lower", cmap="gray")
    signal = np.array(Image.open(folder / "sem.tif"))
    low, high = np.percentile(signal, [0.5, 99.5])
    axes[2].imshow(signal, cmap="gray", vmin=low, vmax=high)
    for axis in axes:
        axis.axis("off")


def main():
    folders = [pathlib.Path(name) for name in sys.argv[2:]]
    figure, axes = plt.subplots(len(folders), 3, figsize=(8, 1.4 * len(folders)), dpi=130, squeeze=False)
    for row, folder in zip(axes, folders):
        draw(row, folder)
    figure.subplots_adjust(left=0.01, right=0.99, top=0.97, bottom=0.01, wspace=0.03, hspace=0.12)
    figure.savefig(sys.argv[1], metadata={"Software": None})


main()
