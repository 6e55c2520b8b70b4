# SPDX-License-Identifier: GPL-3.0-or-later
"""SEM images of surfaces, and surfaces from AFM and SEM images.

>>> import semsurf
>>> image = semsurf.simulate("cube.stl", material="Si", substrate="Si", tilt="40deg")
>>> image["SE"]                       # counts per primary, an array; row 0 is the lowest row
>>> image.stderr("SE")                # their standard errors
>>> semsurf.write_image("cube.exr", image)

Functions are called as the commands of the program ``semsurf`` are, and their keyword arguments as
the options, with underscores. Lengths are nm, energies eV, angles degrees; texts may carry another
unit, "5keV". What takes time is stopped by Ctrl-C (semsurf.Interrupted), shows a bar with
``progress=True``, and lets other Python threads run.

Row 0 of every array is the lowest row: y runs up.
"""
import os as _os

from . import _semsurf
from ._errors import Doubt, Error, FileError, Interrupted, InvalidInput, UsageError, Unsupported
from ._place import MODULES as _MODULES
from ._results import Findings
from ._semsurf import (HeightField, Image, Mesh, Tip, __version__, build_libraries, calibrate,
                      certainty, chart, check_mesh, clean, close, compare, dilate, erode, estimate,
                      info, level, libraries, materials, mesh_heights, noise, noise_counts,
                      noise_sem, open, predict, profile, read_bodies, read_heights, read_image,
                      read_mesh, read_sem_image, read_tip, reconstruct, refine, register,
                      remove_libraries, repair_mesh, sample, simplify, simulate, smooth, solid,
                      survey, sweep, tip, train, view, write_heights, write_image, write_mesh,
                      write_tip)

# Where the libraries are that are loaded when they are needed.
_semsurf.set_module_folder(_os.path.normpath(_os.path.join(_os.path.dirname(__file__), _MODULES)))


def parameters(function):
    """The keyword arguments of a function, by name: what each is, its unit, range and default.

    >>> semsurf.parameters("simulate")["energy"]
    """
    name = getattr(function, "__name__", function)
    for described in _semsurf.described_functions():
        if described["name"] == name:
            return Findings({k["name"]: Findings(k) for k in described["keywords"]})
    raise UsageError("function", f"there is no '{name}'", "See dir(semsurf)")


__all__ = [name for name in dir() if not name.startswith("_")]
