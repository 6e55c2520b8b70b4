#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""f3d shows the meshes: pixels differ from the background. Usage: check_f3d.py WRITER"""
import re

from samples import expect, need, run, samples

f3d = need("f3d", "f3d")
display = need("xvfb-run", "xvfb xauth")
oiiotool = need("oiiotool", "openimageio-tools")


def lit_share(picture):
    """The share of pixels that are brighter than a tenth in any colour."""
    text = run([oiiotool, picture, "--ch", "R,G,B", "--rangecheck", "0,0,0", "0.1,0.1,0.1"])
    dark = re.search(r"(\d+)\s+within range", text)
    expect(dark, "no count of pixels", text)
    return 1 - int(dark.group(1)) / 200**2


with samples() as (folder, _):
    checked = 0
    for name in ["letter.stl", "letter.obj", "letter.ply", "letter.vtp", "letter.glb", "letter.gltf"]:
        if not (folder / name).exists():
            continue
        picture = folder / (name + ".png")
        text = run([display, "-a", f3d, "--dry-run", "--resolution=200,200", "--bg-color=0,0,0",
                    f"--output={picture}", folder / name], home=folder)
        expect(picture.exists(), f"{name}: no picture", text)
        lit = lit_share(picture)
        expect(0.02 < lit < 0.9, f"{name}: {100 * lit:.1f} % of the pixels are lit", text)
        print(f"{name}: {100 * lit:.1f} % of the pixels are lit")
        checked += 1
    expect(checked >= 3, "too few formats")
