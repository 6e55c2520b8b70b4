#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Puts pictures side by side: draw.py OUTPUT.png TITLE=PICTURE.png ..."""
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def main():
    output, pairs = sys.argv[1], [a.split("=", 1) for a in sys.argv[2:]]
    figure, axes = plt.subplots(1, len(pairs), figsize=(2.4 * len(pairs), 2.6), dpi=150)
    for axis, (title, path) in zip(axes, pairs):
        axis.imshow(plt.imread(path), cmap="gray", interpolation="nearest")
        axis.set_title(title, fontsize=8)
        axis.axis("off")
    figure.subplots_adjust(left=0.01, right=0.99, top=0.9, bottom=0.01, wspace=0.04)
    figure.savefig(output, metadata={"Software": None})


main()
