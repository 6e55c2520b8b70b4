# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests of the ParaView plugin share. They run in pvpython, which finds the plugin by PV_PLUGIN_PATH;
SEMSURF is the program to compare with, SEMSURF_SOURCE the project's folder."""
import atexit
import contextlib
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import traceback

import numpy
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy

SOURCE = pathlib.Path(os.environ["SEMSURF_SOURCE"])
DATA = SOURCE / "tests" / "cli" / "data"
FOLDER = pathlib.Path(tempfile.mkdtemp(prefix="semsurf_paraview_"))
atexit.register(shutil.rmtree, FOLDER, True)


def expect(condition, message):
    if not condition:
        raise AssertionError(message)


def each(cases, check):
    """All cases, so that one that fails hides no other."""
    failed = []
    for case in cases:
        try:
            check(*case)
        except AssertionError as error:
            failed.append(f"{case[0]}: {str(error)[:300]}")
    expect(not failed, "\n".join(failed))


def fetch(source, port=0):
    """The data of an output, computed anew where something changed."""
    source.UpdatePipeline()
    return servermanager.Fetch(source, idx=port)


def array(data, name):
    """An array of the points as a grid of an image, row 0 lowest, or as it is."""
    found = data.GetPointData().GetArray(name)
    expect(found is not None, f"there is no array {name} among "
           f"{[data.GetPointData().GetArrayName(i) for i in range(data.GetPointData().GetNumberOfArrays())]}")
    values = vtk_to_numpy(found)
    if data.IsA("vtkImageData"):
        width, height, _ = data.GetDimensions()
        return values.reshape(height, width)
    return values


def column(table, name):
    found = table.GetColumnByName(name)
    expect(found is not None, f"there is no column {name}")
    if found.IsA("vtkStringArray"):
        return [found.GetValue(i) for i in range(found.GetNumberOfValues())]
    return vtk_to_numpy(found)


def text(data, name):
    found = data.GetFieldData().GetAbstractArray(name)
    return found.GetValue(0) if found else None


def texts(data):
    """All texts of the field data, by name."""
    arrays = [data.GetFieldData().GetAbstractArray(i) for i in range(data.GetFieldData().GetNumberOfArrays())]
    return {found.GetName(): str(found.GetValue(0)) for found in arrays}


def same(got, wanted, what):
    """To the last bit; NaN equals NaN."""
    got, wanted = numpy.asarray(got), numpy.asarray(wanted)
    expect(got.shape == wanted.shape, f"{what}: {got.shape} numbers, not {wanted.shape}")
    equal = numpy.array_equal(got, wanted, equal_nan=got.dtype.kind == "f")
    expect(equal, f"{what}: other numbers, at most {numpy.nanmax(numpy.abs(got - wanted))} off" if not equal else "")


def semsurf(*args, code=0):
    """Runs the program; returns what it printed. With the code None any end will do."""
    run = subprocess.run([os.environ["SEMSURF"], *map(str, args)], capture_output=True, text=True, cwd=FOLDER)
    expect(code is None or run.returncode == code, f"semsurf {args}: exit code {run.returncode}\n{run.stdout}{run.stderr}")
    return run.stdout


def matrix(path):
    """The heights of a text file that semsurf wrote, row 0 lowest, every digit."""
    return numpy.loadtxt(path, comments="#", ndmin=2)[::-1]


@contextlib.contextmanager
def messages():
    """Collects what ParaView prints meanwhile: vtkErrorMacro does not raise in Python."""
    said = []
    sys.stderr.flush()
    sys.stdout.flush()
    kept = os.dup(2), os.dup(1)
    with tempfile.TemporaryFile(mode="w+") as file:
        os.dup2(file.fileno(), 2)
        os.dup2(file.fileno(), 1)
        try:
            yield said
        finally:
            sys.stderr.flush()
            sys.stdout.flush()
            os.dup2(kept[0], 2)
            os.dup2(kept[1], 1)
            os.close(kept[0])
            os.close(kept[1])
            file.seek(0)
            said.append(file.read())


def refuses(source, *words, port=0):
    """The filter has no result and says why."""
    with messages() as said:
        try:
            source.UpdatePipeline()
        except RuntimeError:
            pass
        data = source.GetClientSideObject().GetOutputDataObject(port)
        count = data.GetNumberOfElements(0) if data else 0
        rows = data.GetNumberOfRows() if data and data.IsA("vtkTable") else 0
    expect(count == 0 and rows == 0, f"there is a result in spite of the error: {count} points, {rows} rows")
    for word in words:
        expect(word in said[0], f"'{word}' is not in the message:\n{said[0]}")


def refuses_until(source, words, **good):
    """Refused as it is; with these properties it gives a result, and nothing more is said of what was wrong."""
    refuses(source, *words)
    with messages() as said:
        for name, value in good.items():
            setattr(source, name, value)
        source.UpdatePipeline()
    expect("ERR" not in said[0], f"put right, ParaView complains:\n{said[0]}")
    expect(source.GetDataInformation().GetNumberOfPoints() > 0, f"no result with {good}")


def quiet(source, port=0):
    """The data, and no complaint."""
    with messages() as said:
        data = fetch(source, port)
    expect("ERR" not in said[0], f"ParaView complains:\n{said[0]}")
    return data


def progress_of(source):
    """What a filter tells of its progress during one update."""
    told = []
    observed = source.GetClientSideObject()
    tag = observed.AddObserver("ProgressEvent", lambda caller, event: told.append(caller.GetProgress()))
    source.UpdatePipeline()
    observed.RemoveObserver(tag)
    expect(told == sorted(told), f"progress runs backwards: {told}")
    expect(len(told) <= 110, f"progress was told {len(told)} times")
    expect(not told or told[-1] <= 1, f"progress is {told[-1]}")
    return told


def touch(source):
    """Makes what is up to date run again, as ParaView does it with live sources."""
    source.GetClientSideObject().Modified()
    source.SMProxy.MarkModified(source.SMProxy)


def abort_and_rerun(source, after=0.02, port=0):
    """Aborted from its own progress or, without one, at once; then run again, which gives the whole result."""
    observed = source.GetClientSideObject()

    def stop(caller, event):
        if caller.GetProgress() >= after:
            caller.SetAbortExecuteAndUpdateTime()
    tag = observed.AddObserver("ProgressEvent", stop)
    touch(source)
    with messages() as said:
        source.UpdatePipeline()
    observed.RemoveObserver(tag)
    expect("ERR" not in said[0], f"an abort is no error:\n{said[0]}")
    data = observed.GetOutputDataObject(port)
    rows = data.GetNumberOfRows() if data.IsA("vtkTable") else data.GetNumberOfPoints()
    expect(rows == 0, "there is a result in spite of the abort")
    observed.SetAbortExecute(0)
    touch(source)
    return fetch(source, port)


def run(*tests):
    """Each test is a function; all are tried, and the exit code says whether one failed."""
    failed = []
    for test in tests:
        try:
            test()
            print(f"ok     {test.__name__}", flush=True)
        except Exception:
            failed.append(test.__name__)
            print(f"FAILED {test.__name__}\n{traceback.format_exc()}", flush=True)
        for source in list(simple.GetSources().values()):
            simple.Delete(source)
    # ParaView's own clean-up at exit may change the code.
    sys.stdout.flush()
    shutil.rmtree(FOLDER, True)
    os._exit(1 if failed else 0)
