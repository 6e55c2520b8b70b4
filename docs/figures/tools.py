# SPDX-License-Identifier: GPL-3.0-or-later
"""What the figures share: the program's files, the style, and saving. Each figure is made by python3 docs/figures/NAME.py SEMSURF, and
needs numpy, matplotlib and Pillow."""
import contextlib
import pathlib
import re
import subprocess
import sys
import tempfile

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from PIL import Image  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
SAMPLES = HERE.parents[1] / "samples"
GREY, BLUE, ORANGE, GREEN, BLACK = "#999999", "#0072B2", "#D55E00", "#009E73", "#222222"   # Okabe and Ito: told apart by all eyes
plt.rcParams.update({"font.size": 9, "axes.titlesize": 10, "axes.titleweight": "bold", "axes.titlelocation": "left",
                     "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False, "lines.linewidth": 1.6,
                     "image.origin": "lower", "image.interpolation": "nearest", "svg.hashsalt": "semsurf", "figure.dpi": 130})


@contextlib.contextmanager
def workshop():
    """A function that runs the program in a new folder, and the folder."""
    program = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory(prefix="semsurf_figure_") as name:
        (pathlib.Path(name) / "samples").symlink_to(SAMPLES)

        def run(command):
            done = subprocess.run([program, *command.split()], cwd=name, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            if done.returncode not in (0, 4):
                sys.exit(f"semsurf {command}\n{done.stderr}")
            return done.stdout
        yield run, pathlib.Path(name)


def make_pads(run, folder):
    """A pair whose truth is known, in pads/, and the surface found from it, in result/. PADS, a second argument, has both already."""
    if len(sys.argv) > 2:
        return pathlib.Path(sys.argv[2]).resolve()
    run("sample pads -o pads --size 192x144 --electrons 200")
    run("reconstruct --afm pads/afm.gsf --sem pads/sem.tif --material Si --energy 1keV --model samples/si-1keV-10nm.json "
        "--truth pads/truth.gsf -o result")
    return folder


def heights_nm(path):
    """Of a Gwyddion Simple Field; row 0 is the lowest."""
    content = pathlib.Path(path).read_bytes()
    end = content.index(b"\0")
    fields = dict((part.strip() for part in line.split("=", 1))
                  for line in content[:end].decode("utf-8", "replace").splitlines() if "=" in line)
    width, height = int(fields["XRes"]), int(fields["YRes"])
    return 1e9 * np.frombuffer(content, "<f4", width * height, end + 4 - end % 4).reshape(height, width)[::-1]


def channels(path):
    """Of a TIFF by semsurf: arrays by name; row 0 is the lowest."""
    image, found = Image.open(path), {}
    for page in range(image.n_frames):
        image.seek(page)
        name = re.search(r"image:channels=(\S+)", image.tag_v2[270]).group(1)
        found[name] = np.array(image)[::-1]
    return found


def save(figure, name):
    figure.savefig(HERE / name, metadata={"Date": None} if name.endswith(".svg") else {"Software": None})
    print(f"written {name}")


def picture(axes, data, title, extent=None, label=None, **look):
    shown = axes.imshow(data, extent=extent, **look)
    axes.set_title(title)
    if label:
        axes.figure.colorbar(shown, ax=axes, label=label, shrink=0.85)
    if extent:
        axes.set_xlabel("x (nm)")
        axes.set_ylabel("y (nm)")
    return shown
