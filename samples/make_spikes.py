#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A scan of spikes and its truth: make_spikes.py FOLDER writes spikes.gsf and spikes_truth.gsf. Needs `import semsurf` and numpy.

Nine spikes, 28 to 42 nm high, and a block of 25 nm stand on a plane. A cone with an end of 12 nm radius and a half angle of
20 degrees scans them. The scan has noise (0.15 nm, correlated along rows), a tilt, rows that are displaced, and single samples
that jump.
"""
import pathlib
import sys

import numpy
import semsurf

COUNT, PITCH_NM = 144, 2.0
SPIKES_NM = [(40, 44, 34), (120, 60, 40), (210, 40, 30), (70, 140, 36), (230, 130, 42), (50, 230, 30), (140, 240, 38), (244, 232, 34),
             (160, 110, 28)]


def true_heights(x, y):
    z = numpy.zeros(x.shape)
    for at_x, at_y, height in SPIKES_NM:
        z = numpy.maximum(z, height - numpy.hypot(x - at_x, y - at_y) / numpy.tan(numpy.radians(8)))
    inside = numpy.minimum(numpy.minimum(x - 110, 190 - x), numpy.minimum(y - 150, 206 - y))
    return numpy.maximum(z, numpy.clip(3 * inside, 0, 25))


def add_faults(scan, x, y):
    random = numpy.random.default_rng(7)
    noise = random.normal(0, 0.15, scan.shape)
    for column in range(1, COUNT):
        noise[:, column] = 0.5 * noise[:, column - 1] + numpy.sqrt(1 - 0.5 ** 2) * noise[:, column]
    level = numpy.argwhere(scan < 1)
    scan = scan + noise + 0.02 * x - 0.01 * y + random.normal(0, 0.3, COUNT)[:, None]
    for row, column in level[random.integers(0, len(level), 25)]:
        scan[row, column] += 8
    return scan


def main():
    folder = pathlib.Path(sys.argv[1])
    y, x = numpy.mgrid[0:COUNT, 0:COUNT] * PITCH_NM
    truth = semsurf.HeightField(true_heights(x, y), pitch=PITCH_NM)
    tip = semsurf.tip(shape="cone:12nm,20deg", tip_size=31, height_pitch=PITCH_NM)
    scan = add_faults(numpy.array(semsurf.dilate(truth, tip).heights), x, y)
    semsurf.write_heights(folder / "spikes.gsf", semsurf.HeightField(scan, pitch=PITCH_NM))
    semsurf.write_heights(folder / "spikes_truth.gsf", truth)


main()
