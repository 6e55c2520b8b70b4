#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""HyperSpy opens what `semsurf simulate -o image.hspy` writes: axes, units, energy, how it was made.

check_hyperspy.py SEMSURF SAMPLES"""
import json
import pathlib
import subprocess
import sys
import tempfile

try:
    import hyperspy.api as hs
    import numpy
except ImportError as missing:
    print(f"skipped: {missing}: apt-get install python3-hyperspy")
    sys.exit(77)

program, samples = sys.argv[1], pathlib.Path(sys.argv[2])
with tempfile.TemporaryDirectory() as folder:
    path = pathlib.Path(folder) / "image.hspy"
    subprocess.run([program, "simulate", samples / "mesa80.toml", "--size", "24x16", "--electrons", "10", "-q",
                    "-o", path, "-o", path.with_suffix(".exr")], check=True)
    signals = {signal.metadata.General.title: signal for signal in hs.load(str(path))}
    assert {"SE", "BSE", "SE.stderr", "BSE.stderr"} <= set(signals), set(signals)
    se = signals["SE"]
    assert se.data.shape == (16, 24) and type(se).__name__ == "Signal2D", se
    y, x = se.axes_manager.signal_axes[1], se.axes_manager.signal_axes[0]
    assert (x.name, x.units, x.size) == ("x", "nm", 24) and (y.name, y.units, y.size) == ("y", "nm", 16)
    assert abs(x.scale - 192 / 24) < 1e-9 and x.scale > 0 and y.scale > 0, (x, y)
    assert se.metadata.Acquisition_instrument.SEM.beam_energy == 1.0
    assert se.original_metadata.as_dictionary()["simulation.electrons"] == "10", se.original_metadata
    info = subprocess.run([program, "info", "--json", path.with_suffix(".exr")], check=True, capture_output=True, text=True)
    mean = json.loads(info.stdout)[0]["channels"][0]["mean"]
    assert abs(float(numpy.mean(se.data)) - mean) < 1e-5, mean
    se.isig[2:10, 3:8].sum()
print("HyperSpy opens it")
