# SPDX-License-Identifier: GPL-3.0-or-later
"""Two and three ranks give the bytes of one: images in pieces, surfaces and tables from the first rank alone."""
import filecmp
import json
import os
import pathlib
import shutil
import subprocess
import sys

from support import DATA, FOLDER, array, expect, fetch, run, same, simple, vtk_to_numpy


def pipelines():
    """Name to what is saved: images as pieces, the rest by semsurf's own writers and as tables."""
    scan = simple.AFMScanReader(FileName=str(DATA / "noisy.gsf"))
    made = simple.SampleSurface(Shape="Rough", Width=120, Depth=90)
    tip = simple.AFMTip(Radius=5, TipSize=9, Pitch=1)
    coarse = simple.AFMTip(Radius=5, TipSize=9, Pitch=2)
    images = {"scan": scan, "surface": made, "tip": tip,
              "level": simple.LevelScan(Input=scan, Rows="Median"),
              "clean": simple.CleanScan(Input=scan, MedianFilter=1, Closing=1),
              "erode": simple.ErodebyTip(Input=scan, Tip=tip), "dilate": simple.DilatebyTip(Input=made, Tip=coarse),
              "open": simple.OpenbyTip(Input=scan, Tip=tip), "close": simple.ClosebyTip(Input=scan, Tip=tip),
              "certainty": simple.CertaintyMap(Input=scan, Tip=tip),
              "found": simple.EstimateTip(Input=scan, TipSize=5, HeightNoise="0.1", Sweep="0.03,0.8,6")}
    sheet = simple.HeightFieldtoSurface(Input=images["level"], Simplify=1)
    images["seen"] = simple.SurfacetoHeightField(Input=sheet, Samples=40)
    images["sem"] = simple.SimulateSEM(Input=sheet, Pixels=24, Electrons=4)
    surfaces = {"sheet": sheet, "body": simple.SampleBody(Shape="Sphere"),
                "thin": simple.SimplifyMesh(Input=simple.SampleBody(Shape="Sphere"), MeshTolerance=1),
                "mended": simple.CheckandRepairMesh(Input=sheet)}
    return images, surfaces


def save(folder):
    images, surfaces = pipelines()
    counts = {}
    for name, image in images.items():
        image.UpdatePipeline()
        counts[name] = image.GetDataInformation().GetNumberOfPoints()
    pathlib.Path(folder, "counts.json").write_text(json.dumps(counts))
    for name, image in images.items():
        simple.SaveData(f"{folder}/{name}.pvti", proxy=image, DataMode="Binary")
    for name, surface in surfaces.items():
        simple.SaveData(f"{folder}/{name}.glb", proxy=surface)
        simple.SaveData(f"{folder}/{name}.pvtp", proxy=surface, DataMode="Binary")
    simple.SaveData(f"{folder}/level.gsf", proxy=images["level"])
    simple.SaveData(f"{folder}/noise.csv", proxy=simple.NoiseModel(Input=images["scan"]))


def run_with(ranks):
    folder = FOLDER / str(ranks)
    folder.mkdir()
    mpirun = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", str(ranks)]
    # This process is a run of MPI of its own, which one inside of it would take for its own.
    clean = {key: value for key, value in os.environ.items() if not key.startswith(("OMPI_", "PMIX_", "PRTE_"))}
    done = subprocess.run([*mpirun, "pvbatch", __file__, "--save", str(folder)], capture_output=True, text=True,
                          timeout=200, env=clean)
    expect(done.returncode == 0 and "ERR|" not in done.stderr, f"{ranks} ranks:\n{done.stdout}{done.stderr}")
    return folder


def need(*tools):
    """Ends as skipped where a program is not there."""
    for tool in tools:
        if not shutil.which(tool):
            print(f"skipped: {tool} is not there")
            sys.stdout.flush()
            os._exit(77)


def written(folder):
    """The names of what was saved; all of it is there."""
    names = sorted(p.name for p in folder.iterdir() if p.suffix in (".pvti", ".pvtp", ".glb", ".gsf", ".csv"))
    expect(len(names) == 13 + 8 + 2, f"what was written: {names}")
    return names


def compare(several, one, ranks):
    """What that many ranks have saved with what one has."""
    expect(written(several) == written(one), f"{ranks} ranks write {written(several)}")
    for name in written(one):
        if name.endswith(".pvti"):
            reader = simple.XMLPartitionedImageDataReader
            got, want = (fetch(reader(FileName=[str(folder / name)])) for folder in (several, one))
            expect(want.GetNumberOfPoints() > 0 and got.GetExtent() == want.GetExtent(),
                   f"{name}: {got.GetExtent()} on {ranks} ranks, {want.GetExtent()} on one")
            arrays = want.GetPointData()
            expect(arrays.GetNumberOfArrays() > 0, f"{name} has arrays")
            for i in range(arrays.GetNumberOfArrays()):
                key = arrays.GetArrayName(i)
                same(array(got, key), array(want, key), f"{name}, {key}, {ranks} ranks")
        elif name.endswith(".pvtp"):
            reader = simple.XMLPartitionedPolydataReader
            got, want = (fetch(reader(FileName=[str(folder / name)])) for folder in (several, one))
            expect(got.GetNumberOfPoints() == want.GetNumberOfPoints() > 0, f"{name}: points on {ranks} ranks")
            expect(got.GetNumberOfCells() == want.GetNumberOfCells() > 0, f"{name}: cells on {ranks} ranks")
            same(*(vtk_to_numpy(data.GetPoints().GetData()) for data in (got, want)), f"{name}, {ranks} ranks")
        else:
            expect(filecmp.cmp(several / name, one / name, shallow=False), f"{name} differs on {ranks} ranks")
    counts, whole = (json.loads((folder / "counts.json").read_text()) for folder in (several, one))
    for name, count in counts.items():   # pieces share a row of points
        expect(count < 1.5 * whole[name], f"{name}: {count} points on {ranks} ranks, {whole[name]} on one")
    pieces = len(list((several / "level").glob("*.vti")))
    expect(pieces == ranks, f"the image is in {pieces} pieces of {ranks}")


def equal_to_one_rank():
    need("mpirun", "pvbatch")
    one = run_with(1)
    for ranks in (2, 3):
        compare(run_with(ranks), one, ranks)


if __name__ == "__main__":
    if "--save" in sys.argv:
        save(sys.argv[-1])
    else:
        run(equal_to_one_rank)
