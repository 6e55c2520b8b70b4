#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels of small reconstructions, nothing told, by what the model does not know: five views of 160 x 120 pixels each.

    python3 bench/reconstruction_panels.py WORK PICTURES [ROW ...]

WORK: folder for samples and results; what is there already is not done again. PICTURES: folder of the sheets, one a row. Prints for
each view the error, the eroded scan's, and the share of heights within two standard deviations. Needs Pillow.
"""
import json
import os
import pathlib
import subprocess
import sys

from PIL import Image

ROOT = pathlib.Path(__file__).parents[1]
PROGRAM = os.environ.get("SEMSURF", str(ROOT / "build/bin/semsurf"))
MODEL = str(ROOT / "samples/si-1keV-10nm.json")
VIEWS = ("islands", "pads", "terrain", "thick", "thin")
ROWS = {
    "tip": ["--tip-lean=-9deg", "--seed", "22"],
    "in_lens": ["--detector", "in-lens", "--tip-lean=-9deg", "--seed", "22"],
    "tier": ["--physics", "inelastic=dielectric", "--tip-lean=8deg", "--seed", "23"],
    "tier_60_electrons": ["--physics", "inelastic=dielectric", "--electrons", "60", "--tip-lean=-10deg", "--seed", "24"],
    "spot": ["--spot", "6nm", "--tip-lean=10deg", "--seed", "25"],
}
WIDTH = 900  # of a panel on a sheet, pixels


def run(*arguments, good=(0,)):
    done = subprocess.run([PROGRAM, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode not in good:
        sys.exit(f"semsurf {' '.join(map(str, arguments))}: exit {done.returncode}\n{done.stdout}")


def sheet(pictures, file):
    images = []
    for picture in pictures:
        with Image.open(picture) as image:
            height = round(image.height * WIDTH / image.width)
            images.append(image.convert("RGB").resize((WIDTH, height), Image.LANCZOS))
    high = max(image.height for image in images)
    rows = (len(images) + 1) // 2
    out = Image.new("RGB", (2 * WIDTH, rows * high), "white")
    for i, image in enumerate(images):
        out.paste(image, (i % 2 * WIDTH, i // 2 * high))
    out.quantize(128, dither=Image.Dither.NONE).save(file, optimize=True)


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    work, pictures = map(pathlib.Path, sys.argv[1:3])
    for row in sys.argv[3:] or ROWS:
        panels = []
        for view in VIEWS:
            sample, result = work / f"{row}-{view}", work / f"{row}-{view}-result"
            if not (sample / "truth.gsf").exists():
                name = f"nist0523-{view}" if view.startswith("thi") else view
                run("sample", name, "--size", "160x120", *ROWS[row], "-o", sample, "-q")
            if not (result / "panel.png").exists():
                run("reconstruct", "--afm", sample / "afm.gsf", "--sem", sample / "sem.tif", "--pixel-size", "10nm", "--model", MODEL,
                    "--truth", sample / "truth.gsf", "-o", result, "-q", good=(0, 4))
            report = json.loads((result / "report.json").read_text())
            truth = report["truth"]
            print(f"{row} {view}: {report['verdict']}, {truth['rms_nm']:.2f} nm off, eroded scan {truth['start_rms_nm']:.2f}, "
                  f"{100 * truth['within_2_deviations']:.0f} % within two", flush=True)
            panels.append(result / "panel.png")
        sheet(panels, pictures / f"reconstruction_panels_{row}.png")


if __name__ == "__main__":
    main()
