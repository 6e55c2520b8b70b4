# SPDX-License-Identifier: GPL-3.0-or-later
"""Under mpirun each rank simulates a share of the pixels, and the images are those of one rank to the last byte."""
import os
import shutil
import subprocess
import sys

BUDGETS = [dict(Electrons=20), dict(Budget="Accuracy", Accuracy=0.2), dict(Electrons=8, Method="Replay", Detectors="SE1")]


def simulate_in_pieces(folder):
    """On each rank: its piece of every image goes into a file of its own."""
    import numpy
    from paraview import simple
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkParallelCore import vtkMultiProcessController
    rank = vtkMultiProcessController.GetGlobalController().GetLocalProcessId()
    body = simple.SampleBody(Shape="Sphere", Radius=50, Subdivisions=2)
    for number, budget in enumerate(BUDGETS):
        source = simple.SimulateSEM(Input=body, Pixels=40, **budget)
        source.UpdatePipeline()
        data = source.GetClientSideObject().GetOutputDataObject(0)
        arrays = {}
        if data.GetNumberOfPoints() > 0:
            x0, x1, y0, y1, _, _ = data.GetExtent()
            arrays["extent"] = numpy.array([x0, x1, y0, y1])
            for i in range(data.GetPointData().GetNumberOfArrays()):
                array = data.GetPointData().GetArray(i)
                arrays[array.GetName()] = vtk_to_numpy(array).reshape(y1 - y0 + 1, x1 - x0 + 1)
        numpy.savez(os.path.join(folder, f"{number}.{rank}.npz"), **arrays)


def ranks_make_the_same_bytes():
    from support import FOLDER, array, expect, fetch, numpy, same, simple
    wanted = []
    body = simple.SampleBody(Shape="Sphere", Radius=50, Subdivisions=2)
    for budget in BUDGETS:
        data = fetch(simple.SimulateSEM(Input=body, Pixels=40, **budget))
        names = [data.GetPointData().GetArrayName(i) for i in range(data.GetPointData().GetNumberOfArrays())]
        wanted.append({name: array(data, name).copy() for name in names})
    # This process is a run of MPI of its own, which one inside of it would take for its own.
    clean = {key: value for key, value in os.environ.items() if not key.startswith(("OMPI_", "PMIX_", "PRTE_"))}
    for ranks in (2, 3):
        folder = FOLDER / str(ranks)
        folder.mkdir()
        command = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", str(ranks), "pvbatch", "--sym", __file__, str(folder)]
        done = subprocess.run(command, capture_output=True, text=True, timeout=250, env=clean)
        expect(done.returncode == 0, f"{ranks} ranks: {done.stdout}{done.stderr}")
        for number, want in enumerate(wanted):
            got = {name: numpy.full_like(values, -1) for name, values in want.items()}
            pieces = 0
            for rank in range(ranks):
                piece = numpy.load(folder / f"{number}.{rank}.npz")
                if "extent" not in piece:
                    continue
                pieces += 1
                x0, x1, y0, y1 = piece["extent"]
                for name in got:
                    got[name][y0:y1 + 1, x0:x1 + 1] = piece[name]
            expect(pieces == ranks, f"{ranks} ranks give {pieces} pieces")
            for name in want:
                same(got[name], want[name], f"{ranks} ranks, {BUDGETS[number]}: {name}")


if len(sys.argv) > 1:
    simulate_in_pieces(sys.argv[1])
elif not shutil.which("mpirun") or not shutil.which("pvbatch"):
    print("mpirun or pvbatch is not there: not tested")
    sys.exit(77)
else:
    from support import run
    run(ranks_make_the_same_bytes)
