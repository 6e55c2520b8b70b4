#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The README's picture: readme.py SEMSURF PLUGINS [--keep FOLDER] writes docs/figures/readme.png.

Four panels: a mesh and its SEM image; a scan and an SEM image, the surface found from both and the true one; ParaView; a page of
`semsurf view`. Takes ten minutes on two cores. --keep FOLDER keeps what is made, and uses it next time. Needs numpy,
matplotlib, Pillow, ParaView, Xvfb, xdotool, ImageMagick and Chromium.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import LightSource
from PIL import Image

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(HERE))
import paraview_steps  # noqa: E402

TILT_DEG = 30
REGION = -420, -340, 420, 290
PIXEL_NM, AFM_PITCH_NM, SECTION_ROW = 10, 20, 42


def knot(along, around, scale_nm=100, tube=0.42):
    """A trefoil knot lying on z = 0: vertices and triangles, outward."""
    def line(t):
        return np.stack([np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t), -np.sin(3 * t)], -1)
    t = np.linspace(0, 2 * np.pi, along, endpoint=False)
    tangent = line(t + 1e-5) - line(t - 1e-5)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    side = np.cross(tangent, [0, 0, 1.0])
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    up = np.cross(tangent, side)
    a = -np.linspace(0, 2 * np.pi, around, endpoint=False)[:, None]
    vertices = line(t)[:, None] + tube * (np.cos(a) * side[:, None] + np.sin(a) * up[:, None])
    vertices = vertices.reshape(-1, 3) * scale_nm
    vertices[:, 2] -= knot_floor(line, scale_nm, tube)
    i, j = np.meshgrid(np.arange(along), np.arange(around), indexing="ij")

    def index(i, j):
        return ((i % along) * around + j % around).ravel()
    here, ahead, beside, across = index(i, j), index(i + 1, j), index(i, j + 1), index(i + 1, j + 1)
    return vertices, np.concatenate([np.stack([here, ahead, across], 1), np.stack([here, across, beside], 1)])


def knot_floor(line, scale_nm, tube):
    return scale_nm * (line(np.linspace(0, 2 * np.pi, 6000))[:, 2].min() - tube)


def write_off(path, vertices, triangles):
    with path.open("w") as file:
        file.write(f"OFF\n{len(vertices)} {len(triangles)} 0\n")
        np.savetxt(file, vertices, fmt="%.4f")
        np.savetxt(file, np.c_[np.full(len(triangles), 3), triangles], fmt="%d")


def heights_nm(path):
    """Of a Gwyddion Simple Field; row 0 is the lowest."""
    content = path.read_bytes()
    end = content.index(b"\0")
    fields = dict((part.strip() for part in line.split("=", 1))
                  for line in content[:end].decode("utf-8", "replace").splitlines() if "=" in line)
    width, height = int(fields["XRes"]), int(fields["YRes"])
    return 1e9 * np.frombuffer(content, "<f4", width * height, end + 4 - end % 4).reshape(height, width)[::-1]


def make(semsurf, plugins, folder):
    def run(made, *command):
        if not (folder / made).exists():
            print(" ".join(command), flush=True)
            done = subprocess.run([semsurf, *command], cwd=folder)
            if done.returncode not in (0, 4):
                sys.exit(done.returncode)
    write_off(folder / "knot.off", *knot(480, 48))
    run("knotfine.png", "simulate", "knot.off", "--material", "Si", "--substrate", "Si", "--tilt", f"{TILT_DEG}deg", "--azimuth=-90deg",
        "--region=" + ",".join(map(str, REGION)), "--size", "480x360", "--electrons", "64", "--estimate", "guided", "-o", "knotfine.png",
        "-o", "knotfine.exr")
    run("pads/truth.gsf", "sample", "pads", "-o", "pads", "--size", "192x144", "--electrons", "200")
    run("result/surface.gsf", "reconstruct", "--afm", "pads/afm.gsf", "--sem", "pads/sem.tif", "--material", "Si", "--energy", "1keV",
        "--model", str(ROOT / "samples/si-1keV-10nm.json"), "--truth", "pads/truth.gsf", "-o", "result")
    run("flat.gsf", "level", "pads/afm.gsf", "-o", "flat.gsf")
    run("page.html", "view", "result/surface.gsf", "pads/truth.gsf", "pads/sem.tif", "--drape", "pads/sem.tif", "--title",
        "Pads: surface from AFM and SEM", "-o", "page.html")
    if not (folder / "page.png").exists():
        subprocess.run(["chromium", "--headless=new", "--no-sandbox", "--hide-scrollbars", "--use-gl=angle", "--use-angle=swiftshader",
                        "--enable-unsafe-swiftshader", "--window-size=1150,760", "--virtual-time-budget=6000",
                        f"--screenshot={folder}/page.png", f"file://{folder}/page.html"], check=True)
    if not (folder / "paraview.png").exists():
        with tempfile.TemporaryDirectory(prefix="semsurf_readme_") as home, paraview_steps.replay.Screen() as display:
            environment = {**paraview_steps.environment_of(pathlib.Path(home), plugins), "FOLDER": str(folder / "pads")}
            paraview_steps.take(display, [f"--script={HERE}/readme_paraview.py"], folder / "paraview.png", environment, 1150, 256)


def bare(axes):
    axes.set_xticks([])
    axes.set_yticks([])
    for spine in axes.spines.values():
        spine.set_visible(False)


def draw_mesh(axes):
    """The knot as the beam sees it, with its triangles."""
    vertices, triangles = knot(150, 16)
    t = np.radians(TILT_DEG)
    u, v = vertices[:, 0], vertices[:, 1] * np.cos(t) - vertices[:, 2] * np.sin(t)
    towards = vertices[:, 2] * np.cos(t) + vertices[:, 1] * np.sin(t)
    corners = vertices[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    light = np.array([-0.4, -0.2, 0.9])
    shade = np.clip(normals @ (light / np.linalg.norm(light)), 0, 1)
    order = np.argsort(towards[triangles].mean(axis=1))
    colours = np.array([0.30, 0.47, 0.66]) * (0.35 + 0.65 * shade[:, None]) + 0.25 * shade[:, None] ** 3
    axes.add_collection(PolyCollection(np.stack([u, v], -1)[triangles][order], facecolors=np.clip(colours[order], 0, 1), edgecolors="#1f3b57",
                                       linewidths=0.25))
    middle = (REGION[1] + REGION[3]) / 2 * np.cos(t) - vertices[:, 2].max() / 2 * np.sin(t)   # of the specimen's height
    axes.set_xlim(REGION[0], REGION[2])
    axes.set_ylim(middle - 315, middle + 315)
    axes.set_aspect("equal")


def scale_bar(axes, length, width, text, colour="white", y=0.06):
    axes.plot([0.05, 0.05 + length / width], [y, y], color=colour, linewidth=3, transform=axes.transAxes, solid_capstyle="butt")
    axes.text(0.05, y + 0.03, text, color=colour, fontsize=8, transform=axes.transAxes, va="bottom")


def relief(axes, heights, limits, pitch):
    image = LightSource(315, 45).shade(heights, plt.get_cmap("viridis"), vmin=limits[0], vmax=limits[1], dx=pitch, dy=pitch, vert_exag=1.5,
                                       blend_mode="soft")
    axes.imshow(image, origin="lower", interpolation="bilinear")


def heights(folder):
    """Scan, as it lies below the SEM image, surface and truth."""
    flat = heights_nm(folder / "flat.gsf")
    surface, truth = heights_nm(folder / "result/surface.gsf"), heights_nm(folder / "pads/truth.gsf")
    xx, xy, x0, yx, yy, y0 = np.ravel(json.loads((folder / "pads/truth.json").read_text())["sem_to_afm"])
    y, x = np.mgrid[:surface.shape[0], :surface.shape[1]] * PIXEL_NM
    scan = bilinear(flat, (xx * x + xy * y + x0) / AFM_PITCH_NM, (yx * x + yy * y + y0) / AFM_PITCH_NM)
    return scan, surface, truth


def bilinear(grid, x, y):
    i, j = np.clip(x.astype(int), 0, grid.shape[1] - 2), np.clip(y.astype(int), 0, grid.shape[0] - 2)
    a, b = x - i, y - j
    return (1 - b) * ((1 - a) * grid[j, i] + a * grid[j, i + 1]) + b * ((1 - a) * grid[j + 1, i] + a * grid[j + 1, i + 1])


def draw_section(axes, scan, surface, truth):
    x = np.arange(surface.shape[1]) * PIXEL_NM / 1000
    for data, colour, style, width, label in ((scan, "#999999", "-", 1.5, "AFM scan"), (surface, "#0072B2", "-", 2, "surface found"),
                                              (truth, "black", (0, (4, 2)), 1.3, "truth")):
        row = data[SECTION_ROW]
        axes.plot(x, row - np.median(row), color=colour, linestyle=style, linewidth=width, label=label)
    axes.set_xlim(1.05, 1.7)
    axes.set_ylim(-12, 150)
    axes.set_xlabel("x (µm)", fontsize=8, labelpad=1)
    axes.set_ylabel("height (nm)", fontsize=8, labelpad=1)
    axes.tick_params(labelsize=8, length=2)
    axes.legend(fontsize=8, frameon=False, loc="upper left")
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    box = axes.get_position()
    axes.set_position([box.x0 + 0.035, box.y0 + 0.034, box.width - 0.04, box.height - 0.04])


def reduce(path):
    """To 256 colours: 80 greys, for SEM images, and those that the rest has."""
    image = Image.open(path).convert("RGB")
    pixels = np.asarray(image).reshape(-1, 3)
    colourful = pixels[np.ptp(pixels.astype(int), axis=1) > 6]
    colours = Image.fromarray(colourful[None]).quantize(176, method=Image.Quantize.MEDIANCUT).getpalette()[:3 * 176]
    greys = [int(round(value)) for value in np.linspace(0, 255, 80) for _ in range(3)]
    palette = Image.new("P", (1, 1))
    palette.putpalette(greys + colours)
    image.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG).save(path, optimize=True)


def draw(folder, output):
    figure = plt.figure(figsize=(12, 7.3), dpi=150)
    outer = figure.add_gridspec(2, 2, height_ratios=(3.05, 3.85), left=0.006, right=0.994, top=0.957, bottom=0.006, wspace=0.03, hspace=0.085)

    def title_of(cell, title):
        box = cell.get_position(figure)
        figure.text(box.x0 + 0.002, box.y1 + 0.008, title, fontsize=13, weight="bold", va="bottom")

    def panel(cell, title, columns):
        title_of(cell, title)
        axes = [figure.add_subplot(one) for one in cell.subgridspec(1, columns, wspace=0.03)]
        for one in axes:
            bare(one)
        return axes

    mesh, sem = panel(outer[0, 0], "Any mesh, and its SEM image", 2)
    draw_mesh(mesh)
    picture = np.array(Image.open(folder / "knotfine.png").convert("L"))
    sem.imshow(picture, cmap="gray", interpolation="bilinear")
    scale_bar(sem, 200, REGION[2] - REGION[0], "200 nm")
    width = picture.shape[1]
    sem.set_xlim(0.03 * width, 0.93 * width)
    mesh.set_xlim(REGION[0] + 0.03 * 840, REGION[0] + 0.93 * 840)

    scan, surface, truth = heights(folder)
    signal = np.array(Image.open(folder / "pads/sem.tif"))
    title_of(outer[0, 1], "AFM scan + SEM image: the surface, beside the truth")
    inner = outer[0, 1].subgridspec(2, 3, wspace=0.04, hspace=0.05)
    for cell, data, text in ((inner[0, 0], scan, "AFM scan"), (inner[1, 0], None, "SEM image"), (inner[0, 1], surface, "surface found"),
                             (inner[0, 2], truth, "truth")):
        axes = figure.add_subplot(cell)
        bare(axes)
        if data is None:
            axes.imshow(signal, cmap="gray", vmin=np.percentile(signal, 1), vmax=np.percentile(signal, 99.7), interpolation="bilinear")
        else:
            relief(axes, data, (-60, 120), PIXEL_NM)
            axes.axhline(SECTION_ROW, color="white", linewidth=0.8, linestyle=(0, (4, 3)))
        axes.text(0.03, 0.96, text, transform=axes.transAxes, va="top", fontsize=9, color="white", weight="bold",
                  bbox={"facecolor": "#00000088", "edgecolor": "none", "pad": 2})
        if text == "SEM image":
            scale_bar(axes, 500, 1920, "500 nm")
    axes = figure.add_subplot(inner[1, 1:])
    draw_section(axes, scan, surface, truth)
    for cell, title, name in ((outer[1, 0], "In ParaView, with the mouse", "paraview.png"),
                              (outer[1, 1], "One web page to share", "page.png")):
        axes, = panel(cell, title, 1)
        axes.imshow(np.array(Image.open(folder / name).convert("RGB")), interpolation="antialiased")
        for spine in axes.spines.values():
            spine.set(visible=True, color="#999999", linewidth=0.6)
    figure.savefig(output, metadata={"Software": None})
    reduce(output)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("semsurf", type=pathlib.Path)
    parser.add_argument("plugins", type=pathlib.Path)
    parser.add_argument("--keep", type=pathlib.Path)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="semsurf_readme_") as name:
        folder = (options.keep or pathlib.Path(name)).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        make(options.semsurf.resolve(), options.plugins.resolve(), folder)
        draw(folder, HERE / "readme.png")


main()
