#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks who includes whom. Usage: layers.py ROOT | layers.py --self-test

Reads every source and header of the libraries and the program and complains, a line per fault,
about arrows that run back, third-party headers outside the one place that is theirs or in a public
header, quoted includes that leave their library, and files without an SPDX line.
"""
import fnmatch
import pathlib
import re
import sys
import tempfile

# The rooms of mc_sim: each may include those before it. What lies in none is the last.
ROOMS = ["physics", "geometry", "transport", "request", "cascades", "replay", "results", "sampling", "scheduling"]
MC = {f"mc/{room}" for room in ROOMS} | {"mc"}
# The rooms of libsurf's models of SEM images, likewise.
SEM_ROOMS = ["model", "minimise", "facet", "network", "baselines", "noise", "calibration", "guided", "training"]
SEM = {f"sem/{room}" for room in SEM_ROOMS} | {"sem"}
SURF = {"core", "mesh", "afm", "registration", "compare", "profile", "refinement", "reconstruction"} | SEM


def rooms_of_mc():
    parts = {f"mc/{room}": ([f"mc_sim/src/{room}/*", f"mc_sim/include/surf/mc/{room}/*"],
                            {"core", "mesh"} | {f"mc/{before}" for before in ROOMS[:i]}) for i, room in enumerate(ROOMS)}
    tables = {"mc_tables": (["mc_sim/src/tables/*", "mc_sim/include/surf/mc/tables/*"], {"core", "mesh", "sem"} | MC)}
    return {**parts, **tables, "mc": (["mc_sim/*"], {"core", "mesh"} | MC)}


def parts_of_libsurf():
    def places(part):
        return [f"libsurf/src/{part}/*", f"libsurf/include/surf/{part}/*"]
    rooms = {f"sem/{room}": (places(f"sem/{room}"),
                             {"core", "mesh", "afm", "sem"} | {f"sem/{before}" for before in SEM_ROOMS[:i]})
             for i, room in enumerate(SEM_ROOMS)}
    return {"core": (places("core"), set()), "mesh": (places("mesh"), {"core"}), "afm": (places("afm"), {"core"}),
            "registration": (places("registration"), {"core"}), "compare": (places("compare"), {"core", "registration"}),
            "profile": (places("profile"), {"core", "mesh"}), "refinement": (places("refinement"), {"core", "mesh"}), **rooms,
            "sem": (places("sem"), {"core", "mesh", "afm"} | SEM),
            "reconstruction": (places("reconstruction"), {"core", "afm"} | SEM)}


# A part of the project: the folder patterns it lives in and the parts it may include. First match.
ALL = SURF | MC | {"mc_tables", "io", "io_models", "io_sim", "workflow"}
PARTS = {
    "io_sim": (["io/include/surf/io/sim/*", "io/src/sim/*"], {"core", "mesh", "io"} | MC),
    "io_models": (["io/include/surf/io/model/*", "io/src/model/*"], {"core", "sem", "io"}),
    "io": (["io/*"], {"core", "mesh", "afm"}),
    **parts_of_libsurf(),
    **rooms_of_mc(),
    "workflow": (["workflow/*"], ALL - {"workflow"}),
    "cli": (["cli/*"], ALL),
    "samples": (["samples/*"], ALL),
    "paraview_plugin": (["paraview_plugin/*"], ALL),
    "python": (["python/*"], ALL),
}
# Whose header "surf/..." is. First match.
OWNERS = [("surf/io/sim/", "io_sim"), ("surf/io/model/", "io_models"), ("surf/io/", "io"),
          *((f"surf/mc/{room}/", f"mc/{room}") for room in ROOMS), ("surf/mc/tables/", "mc_tables"), ("surf/mc/", "mc"),
          ("surf/workflow/", "workflow"),
          *((f"surf/{part}/", part) for part in ["core", "mesh", "afm", "sem", "registration", "compare", "profile", "refinement",
                                                 "reconstruction"])]
# Third-party headers <...> and the files that may include them. First match; public headers never.
THIRD_PARTY = [
    ("embree*/*", ["mc_sim/src/geometry/embree_scene.cpp"]),
    ("CGAL/*", ["libsurf/src/mesh/cgal_*.cpp"]),
    ("OpenMesh/*", ["libsurf/src/mesh/openmesh_*.cpp"]),
    ("Eigen/*", ["libsurf/src/afm/cholesky.cpp", "libsurf/src/reconstruction/descent.cpp", "libsurf/src/reconstruction/discrepancy.cpp", "libsurf/src/reconstruction/map_deviation.cpp", "libsurf/src/reconstruction/preconditioner.cpp",
                 "libsurf/src/reconstruction/tilt_by_sem.cpp", "libsurf/src/registration/correlation.cpp", "libsurf/src/registration/landmarks.cpp",
                 "libsurf/src/registration/uncertainty.cpp", "libsurf/src/sem/calibration/calibration.cpp",
                 "libsurf/src/sem/facet/fit_filter_bank.cpp", "libsurf/src/sem/noise/flat_samples.cpp",
                 "libsurf/src/profile/fit_profile.cpp", "libsurf/src/profile/sight_of_walls.*", "libsurf/src/profile/simulation_errors.*", "libsurf/src/reconstruction/damped_steps.h", "libsurf/src/profile/profile_library.cpp", "libsurf/src/refinement/fit_modes.cpp", "libsurf/src/sem/model/film_model.cpp", "libsurf/src/sem/network/network_trainer.cpp"]),
    # In correlation.cpp only what needs no library.
    ("ceres/*", ["libsurf/src/sem/minimise/ceres_module.cpp", "libsurf/src/registration/correlation.cpp"]),
    ("cholmod.h", ["libsurf/src/reconstruction/cholmod_module.cpp"]),
    ("fftw3.h", ["libsurf/src/compare/noise_fields.cpp", "libsurf/src/registration/shift_search.cpp"]),
    ("hwy/*", ["libsurf/src/core/each_target.h"]),
    ("nlopt.h", ["libsurf/src/profile/edge_roughness.cpp", "libsurf/src/reconstruction/tip_search.cpp", "libsurf/src/registration/mutual_information.cpp"]),
    ("OpenImageIO/*", ["io/src/raster/raster_*"]),
    ("vtk*", ["io/src/vtk/vti_file.cpp", "io/src/vtk/vti_volume.cpp", "io/src/vtk/vtp_*.cpp", "io/src/vtk/vtk_support.h",
              "paraview_plugin/*"]),
    ("pugixml.hpp", ["io/src/vtk/vtk_xml.cpp", "io/src/mesh/three_mf_file.cpp",
                    "paraview_plugin/tools/expand_proxies.cpp"]),
    ("zlib.h", ["io/src/files/deflate.cpp", "io/src/vtk/vtk_data.cpp", "io/src/files/zip_file.cpp"]),
    ("tiny_gltf.h", ["io/src/gltf/write_gltf.cpp"]),
    ("cairo*.h", ["io/src/pictures/canvas.cpp"]),
    ("hdf5.h", ["io/src/hdf5/hspy_write.cpp"]),
    ("xxhash.h", ["io/src/files/cache_entry.cpp"]),
    ("toml++/*", ["io/src/sim/*"]),
    ("nlohmann/*", ["workflow/src/*", "io/src/*"]),
    ("openssl/*", ["io/src/*"]),
    ("CLI/*", ["cli/*"]),
    ("mpi.h", ["workflow/src/mpi_team.cpp"]),
    ("pybind11/*", ["python/*"]),
    ("Random123/*", ["libsurf/src/core/random.cpp"]),
    ("tbb/*", ["libsurf/src/core/parallel.cpp"]),
    ("oneapi/*", ["libsurf/src/core/parallel.cpp"]),
    ("fmt/*", ["*"]),
    # The operating system and the compiler.
    ("sys/*", ["*"]),
    ("*intrin.h", ["*"]),
    ("dlfcn.h", ["libsurf/src/core/module.cpp"]),
    ("fcntl.h", ["*"]),
    ("linux/magic.h", ["io/src/files/read_file.cpp"]),
    ("malloc.h", ["*"]),
    ("poll.h", ["*"]),
    ("sched.h", ["*"]),
    ("signal.h", ["*"]),
    ("spawn.h", ["*"]),
    ("termios.h", ["*"]),
    ("unistd.h", ["*"]),
]
SOURCE_FOLDERS = ["libsurf", "mc_sim", "io", "workflow", "cli", "samples", "paraview_plugin", "python"]
SPDX_FOLDERS = SOURCE_FOLDERS + ["tests", "bench", "cmake", "docs", "site"]
SPDX_SUFFIXES = {".cpp", ".h", ".py", ".sh"}
SPDX_LINE = "SPDX-License-Identifier: GPL-3.0-or-later"
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def matches(name, patterns):
    return any(fnmatch.fnmatchcase(name, pattern) for pattern in patterns)


def part_of(path):
    return next(part for part, (folders, _) in PARTS.items() if matches(path, folders))


def is_public(path):
    return path.split("/")[1] == "include"


def files(root, folders, suffixes):
    for folder in folders:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in suffixes and path.is_file():
                yield path.relative_to(root).as_posix(), path.read_text(encoding="utf-8")


def quoted_fault(root, path, name):
    part = part_of(path)
    if name.startswith("surf/"):
        owner = next(owner for prefix, owner in OWNERS if name.startswith(prefix))
        if owner != part and owner not in PARTS[part][1]:
            return f"{part} must not know {owner}"
        return None
    if is_public(path):
        return "a public header includes public headers only, as surf/..."
    home = (root / path).parent
    library_source = root / path.split("/")[0] / "src"
    inside = [(home / name).resolve(), (library_source / name).resolve()]
    allowed = (root / path.split("/")[0]).resolve()
    for candidate in inside:
        if candidate.is_file():
            if allowed not in candidate.parents:
                return "leaves its library"
            other = part_of(candidate.relative_to(root.resolve()).as_posix())
            if other != part and other not in PARTS[part][1]:
                return f"{part} must not know {other}"
            return None
    return "is neither surf/... nor a private header of this library"


def angle_fault(path, name):
    if name.startswith("surf/"):
        return 'own headers are included with "..."'
    if re.fullmatch(r"[a-z0-9_]+", name):
        return None   # the standard library
    if is_public(path):
        return "public headers include the standard library and surf/... only"
    for pattern, places in THIRD_PARTY:
        if fnmatch.fnmatchcase(name, pattern):
            return None if matches(path, places) else "belongs in " + ", ".join(places) + " only"
    return "is unknown: say in THIRD_PARTY of tests/architecture/layers.py where it belongs"


def check(root):
    faults = []
    count = 0
    for path, text in files(root, SOURCE_FOLDERS, {".cpp", ".h"}):
        count += 1
        for match in INCLUDE.finditer(text):
            kind, name = match.groups()
            fault = quoted_fault(root, path, name) if kind == '"' else angle_fault(path, name)
            if fault:
                line = text.count("\n", 0, match.start(1)) + 1
                faults.append(f"{path}:{line}: {name}: {fault}")
    for path, text in files(root, SPDX_FOLDERS, SPDX_SUFFIXES):
        if SPDX_LINE not in "\n".join(text.split("\n")[:3]):
            faults.append(f"{path}:1: no line '{SPDX_LINE}' at the top")
    return count, faults


GOOD = {
    "libsurf/include/surf/core/a.h": '#include <vector>\n#include "surf/core/b.h"\n',
    "libsurf/src/core/random.cpp": '#include <Random123/philox.h>\n#include "surf/core/a.h"\n',
    "libsurf/src/core/parallel.cpp": "#include <tbb/parallel_for.h>\n#include <unistd.h>\n",
    "mc_sim/include/surf/mc/a.h": '#include "surf/core/a.h"\n',
    "mc_sim/include/surf/mc/physics/b.h": "",
    "mc_sim/src/geometry/embree_scene.cpp": '#include <embree3/rtcore.h>\n#include "surf/mc/physics/b.h"\n',
    "mc_sim/src/physics/b.cpp": '#include "surf/mc/physics/b.h"\n',
    "libsurf/include/surf/mesh/mesh.h": '#include "surf/core/a.h"\n',
    "libsurf/include/surf/afm/scan.h": '#include "surf/core/a.h"\n',
    "libsurf/src/sem/model/padded.h": '#include "surf/core/a.h"\n',
    "libsurf/src/sem/facet/pass.cpp": '#include "sem/model/padded.h"\n#include "surf/mesh/mesh.h"\n',
    "mc_sim/src/private.h": '#include <fmt/format.h>\n#include "surf/mc/a.h"\n',
    "io/src/raster/raster_file.cpp": "#include <OpenImageIO/imageio.h>\n",
    "io/src/private.h": '#include "surf/io/files.h"\n',
    "io/src/sim/scene_file.cpp": '#include <toml++/toml.h>\n#include "surf/mc/a.h"\n#include "private.h"\n',
    "workflow/src/job.cpp": '#include <nlohmann/json.hpp>\n#include "surf/io/sim/scene_file.h"\n',
    "cli/main.cpp": '#include <CLI/CLI.hpp>\n#include "surf/workflow/job.h"\n#include "private.h"\n',
    "cli/private.h": "",
    "tests/anything.cpp": "#include <gtest/gtest.h>\n#include <Random123/philox.h>\n",
}
# Each line is one fault; the rest of the file is as in GOOD.
BAD = {
    "libsurf/include/surf/core/a.h": ["#include <fmt/format.h>", '#include "surf/mc/a.h"',
                                      "#include <unistd.h>", '#include "hidden.h"'],
    "libsurf/src/core/parallel.cpp": ['#include "surf/io/files.h"', "#include <surf/core/a.h>",
                                      "  #  include <Random123/philox.h>"],
    "libsurf/include/surf/mesh/mesh.h": ['#include "surf/afm/scan.h"', '#include "surf/sem/model.h"'],
    "libsurf/src/sem/model/padded.h": ['#include "sem/facet/pass.cpp"', '#include "surf/reconstruction/reconstruct.h"'],
    "mc_sim/include/surf/mc/a.h": ["#include <embree3/rtcore.h>", '#include "surf/workflow/job.h"'],
    "mc_sim/src/physics/b.cpp": ['#include "geometry/hidden.h"', '#include "surf/mc/transport/c.h"', '#include "surf/mc/a.h"'],
    "mc_sim/src/private.h": ["#include <embree3/rtcore.h>", '#include "surf/io/files.h"',
                             '#include "../../io/src/private.h"', '#include "nowhere.h"'],
    "io/src/private.h": ['#include "surf/mc/a.h"', '#include "surf/io/sim/scene_file.h"',
                         "#include <vtkImageData.h>", "#include <toml++/toml.h>",
                         '#include "sim/scene_file.cpp"'],
    "io/src/sim/scene_file.cpp": ['#include "surf/workflow/job.h"', "#include <CLI/CLI.hpp>"],
    "workflow/src/job.cpp": ["#include <OpenImageIO/imageio.h>", "#include <boost/any.hpp>",
                             '#include "../../cli/private.h"'],
    "cli/main.cpp": ["#include <nlohmann/json.hpp>", "#include <vtkImageData.h>"],
    "tests/no_licence.cpp": None,
}


def self_test():
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)

        def write(path, text):
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(f"// {SPDX_LINE}\n" + text if text is not None else "int x;\n",
                                     encoding="utf-8")

        for path, text in GOOD.items():
            write(path, text)
        _, faults = check(root)
        if faults:
            return ["a good tree was blamed:"] + faults

        expected = set()
        for path, lines in BAD.items():
            if lines is None:
                write(path, None)
                expected.add(f"{path}:1")
                continue
            good = GOOD[path]
            write(path, good + "\n".join(lines) + "\n")
            first = 2 + good.count("\n")
            expected.update(f"{path}:{first + i}" for i in range(len(lines)))
        _, faults = check(root)
        found = {":".join(fault.split(":")[:2]) for fault in faults}
        return ([f"missed: {place}" for place in sorted(expected - found)] +
                [f"wrongly blamed: {place}" for place in sorted(found - expected)])


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    if sys.argv[1] == "--self-test":
        faults = self_test()
        print(f"{len(faults)} surprises on the script's own example")
    else:
        count, faults = check(pathlib.Path(sys.argv[1]))
        print(f"{count} sources and headers, {len(faults)} faults")
        if count == 0:
            faults = ["found no sources: is this the project's root folder?"]
    print("\n".join(faults))
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
