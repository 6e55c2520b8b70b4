# SPDX-License-Identifier: GPL-3.0-or-later
"""What is made of scans with a tip is what the commands make."""
import time

from vtkmodules.vtkCommonCore import vtkInformationKeyLookup

from support import DATA, FOLDER, abort_and_rerun, array, column, expect, fetch, matrix, numpy, progress_of, quiet, \
    refuses, refuses_until, run, same, semsurf, simple, text


def scan():
    return simple.AFMScanReader(FileName=str(DATA / "noisy.gsf"))


def heights(source):
    data = quiet(source)
    return array(data, data.GetPointData().GetScalars().GetName())


def tip():
    return simple.AFMTip(Radius=5, HalfAngle=20, TipSize=9, Pitch=1)


def tips_equal_the_command():
    for shape, properties in {"cone:5nm,20deg": {}, "parabola:5nm": {"Shape": "Parabola"},
                              "pyramid:5nm,20deg,3": {"Shape": "Pyramid", "Faces": 3}, "ball:3nm": {"Shape": "Ball", "Radius": 3}}.items():
        semsurf("tip", "--shape", shape, "--tip-size", 9, "--height-pitch", "1nm", "-o", "tip.txt")
        source = tip()
        for name, value in properties.items():
            setattr(source, name, value)
        data = quiet(source)
        same(array(data, "z_nm"), matrix(FOLDER / "tip.txt"), shape)
        expect(data.GetBounds()[0:4] == (-4, 4, -4, 4), f"the apex is at (0, 0): {data.GetBounds()}")
        expect(text(data, "tip") == "structuring function", "it says what it is")


def morphology_equals_the_command():
    semsurf("tip", "--shape", "cone:5nm,20deg", "--tip-size", 9, "--height-pitch", "1nm", "-o", "tip.txt")
    for command, make in {"erode": simple.ErodebyTip, "dilate": simple.DilatebyTip}.items():
        semsurf(command, DATA / "noisy.gsf", "--tip", "tip.txt", "-o", "out.txt")
        same(heights(make(Input=scan(), Tip=tip())), matrix(FOLDER / "out.txt"), command)
        semsurf(command, DATA / "noisy.gsf", "--tip", "tip.txt", "--distance", "2nm", "--upsample", 2, "-o", "out.txt")
        same(heights(make(Input=scan(), Tip=tip(), Distance=2, Upsample=2)), matrix(FOLDER / "out.txt"), command)
    plain = heights(scan())
    for make, command, steps in [(simple.OpenbyTip, "open", ["erode", "dilate"]),
                                 (simple.ClosebyTip, "close", ["dilate", "erode"])]:
        semsurf(command, DATA / "noisy.gsf", "--tip", "tip.txt", "-o", "out.txt")
        got = heights(make(Input=scan(), Tip=tip()))
        same(got, matrix(FOLDER / "out.txt"), command)
        semsurf(steps[0], DATA / "noisy.gsf", "--tip", "tip.txt", "-o", "half.txt")
        semsurf(steps[1], "half.txt", "--tip", "tip.txt", "-o", "both.txt")
        same(got, matrix(FOLDER / "both.txt"), f"{steps}")
        expect(numpy.abs(got - plain).max() > 0.1, f"{command} changes something")
    expect((heights(simple.OpenbyTip(Input=scan(), Tip=tip())) <= plain + 1e-6).all(), "an opening is never above")
    expect((heights(simple.ClosebyTip(Input=scan(), Tip=tip())) >= plain - 1e-6).all(), "a closing is never below")


def tips_are_resampled():
    coarse = simple.AFMTip(Radius=5, HalfAngle=20, TipSize=5, Pitch=2)
    semsurf("tip", "--shape", "cone:5nm,20deg", "--tip-size", 5, "--height-pitch", "2nm", "-o", "coarse.txt")
    semsurf("erode", DATA / "noisy.gsf", "--tip", "coarse.txt", "-o", "out.txt")
    same(heights(simple.ErodebyTip(Input=scan(), Tip=coarse)), matrix(FOLDER / "out.txt"), "a coarser tip")


def certainty_equals_the_command():
    semsurf("tip", "--shape", "cone:5nm,20deg", "--tip-size", 9, "--height-pitch", "1nm", "-o", "tip.txt")
    semsurf("certainty", DATA / "noisy.gsf", "--tip", "tip.txt", "-o", "map.tif", "--eroded", "out.txt", "-q")
    source = simple.CertaintyMap(Input=scan(), Tip=tip())
    data = fetch(source)
    same(array(data, "Height"), matrix(FOLDER / "out.txt"), "surface")
    want = simple.SEMImageReader(FileName=str(FOLDER / "map.tif"), Channel="certain")
    same(array(data, "certain").astype(float), array(fetch(want), "certain"), "certain")
    want.Channel = "radius_px"
    same(array(data, "radius_px").astype(float), array(fetch(want), "radius_px"), "radius")


def cleaning_equals_the_command():
    def check(properties, *options):
        semsurf("clean", DATA / "noisy.gsf", *options, "-o", "out.txt")
        same(heights(simple.CleanScan(Input=scan(), **properties)), matrix(FOLDER / "out.txt"), f"{properties}")
    check({"SpikeLimit": 0.1}, "--spikes", "3:0.1nm")
    check({"RemoveSpikes": 0, "MedianFilter": 1, "MedianWidth": 5, "Disc": 1}, "--median", 5, "--disc")
    check({"RemoveSpikes": 0, "Closing": 1, "ClosingWidth": 5}, "--closing", 5)
    plain = heights(scan())
    expect(numpy.array_equal(heights(simple.CleanScan(Input=scan(), RemoveSpikes=0)), plain), "nothing to do changes nothing")


def found_tips_equal_the_command():
    def check(properties, *options):
        semsurf("tip", DATA / "noisy.gsf", "--tip-size", 5, *options, "-o", "tip.txt")
        source = simple.EstimateTip(Input=scan(), TipSize=5, **properties)
        same(array(fetch(source), "z_nm"), matrix(FOLDER / "tip.txt"), f"{properties}")
        return fetch(source, 1)
    how = check({"Answer": "Blind", "Threshold": 0.2, "ApexTolerance": 0.1}, "--threshold", "0.2nm",
                "--apex-tolerance", "0.1nm")
    # This scan's tip does not depend on it.
    expect(column(how, "value")[column(how, "quantity").index("apex_tolerance_nm")] == 0.1, "the apex tolerance")
    check({"Answer": "Outer", "HeightNoise": "0.1"}, "--answer", "outer", "--height-noise", "0.1nm")
    curve = check({"HeightNoise": "0.1", "Sweep": "0.03,0.8,10"}, "--height-noise", "0.1nm",
                  "--sweep", "0.03nm,0.8nm,10")
    expect(curve.GetNumberOfRows() == 10 and column(curve, "chosen").sum() == 1, "a curve with the choice")
    candidates = check({"Answer": "Best", "HeightNoise": "0.1"}, "--answer", "best", "--height-noise", "0.1nm")
    expect((column(candidates, "risk") > 0).all(), "the candidates")


def outputs_tell_how_they_were_made():
    """As the files of the commands do."""
    options = {
        "level": (simple.LevelScan(Input=scan()), {"level.method": "hough"}),
        "clean": (simple.CleanScan(Input=scan(), SpikeLimit=0.5), {"clean.spikes": "3:0.5"}),
        "erode": (simple.ErodebyTip(Input=scan(), Tip=tip(), Distance=2), {"morphology.distance_nm": "2"}),
        "close": (simple.ClosebyTip(Input=scan(), Tip=tip(), Upsample=2), {"morphology.upsample": "2"}),
        "certainty": (simple.CertaintyMap(Input=scan(), Tip=tip(), HeightNoise=0.25), {"scan.height_noise_nm": "0.25"}),
        "tip": (tip(), {"tip.shape": "cone:5nm,20deg", "tip.size": "9", "scan.height_pitch_nm": "1"})}
    for command, (source, wanted) in options.items():
        data = fetch(source)
        expect(text(data, "command") == command, f"{command}: {text(data, 'command')}")
        for name, value in wanted.items():
            expect(text(data, f"option.{name}") == value, f"{name}: {text(data, f'option.{name}')}")


def wrong_properties_are_refused():
    refuses_until(simple.EstimateTip(Input=scan(), TipSize=4), ["Tip Size", "middle"], TipSize=5)
    refuses(simple.CleanScan(Input=scan(), MedianWidth=4), "Median Width", "Give 3 or 5")
    for without in (simple.ErodebyTip(Input=scan()), simple.CertaintyMap(Input=scan())):
        without.Tip = None
        refuses(without, "Tip", "missing", "Estimate Tip")
    refuses(simple.ErodebyTip(Input=scan(), Tip=tip(), Distance=-1), "Distance", "0nm or more")
    refuses(simple.CertaintyMap(Input=scan(), Tip=tip(), Sigmas=0), "Sigmas")
    refuses(simple.ErodebyTip(Input=scan(), Tip=simple.AFMTip(TipSize=4)), "Tip Size", "middle")
    refuses_until(simple.AFMTip(TipSize=4), ["Tip Size", "middle"], TipSize=9)
    refuses_until(simple.SampleSurface(Width=0), ["Width", "samples"], Width=20)
    two = simple.SampleSurface(Shape="Grating", Width=100, Depth=100, FeatureHeight=10, Period=40, FeatureWidth=4, WallRun=4)
    refuses(simple.ErodebyTip(Input=scan(), Tip=two), "Tip", "places that do not touch")


def progress_and_abort():
    large = simple.SampleSurface(Shape="Rough", Width=1022, Depth=1022)
    blunt = simple.AFMTip(Radius=60, TipSize=61)
    erode = simple.ErodebyTip(Input=large, Tip=blunt, Distance=4, Upsample=4)
    expect(len(progress_of(erode)) > 3, "there is progress")
    whole = array(fetch(erode), "z_nm").copy()
    erode.Upsample = 3
    erode.Upsample = 4
    same(array(abort_and_rerun(erode), "z_nm"), whole, "after an abort")
    sweep = simple.EstimateTip(Input=simple.SampleSurface(Shape="Rough", Width=300, Depth=300), HeightNoise="0.3")
    expect(len(progress_of(sweep)) > 3, "the sweep tells its progress")


def the_library_tells_its_time():
    """bench/bench_paraview.py takes the plugin's own share from it."""
    key = vtkInformationKeyLookup.Find("LIBRARY_SECONDS", "vtkSemsurf")
    expect(key is not None, "the key is there")
    large = simple.SampleSurface(Shape="Rough", Width=600, Depth=600)
    large.UpdatePipeline()
    erode = simple.ErodebyTip(Input=large, Tip=simple.AFMTip(Radius=60, TipSize=61), Distance=4)
    seconds = []
    for upsample in (4, 1):
        erode.Upsample = upsample
        begin = time.perf_counter()
        erode.UpdatePipeline()
        wall = time.perf_counter() - begin
        seconds.append(erode.GetClientSideObject().GetInformation().Get(key))
        expect(0 < seconds[-1] <= wall, f"{seconds[-1]} s of the library in {wall} s")
    expect(seconds[1] < seconds[0], f"the time is that of the last update: {seconds}")


def measured_noise_equals_the_command():
    """To the digits that it prints."""
    for properties, options in [({}, []), ({"Flat": 1, "Degree": 3}, ["--flat", "--degree", 3]), ({"Lags": 3}, ["--lags", 3])]:
        printed = semsurf("noise", "scan", DATA / "noisy.gsf", *options)
        source = simple.NoiseModel(Input=scan(), **properties)
        table, lags = fetch(source), fetch(source, 1)
        v = dict(zip(column(table, "quantity"), column(table, "value")))
        largest = {}
        for row, direction in enumerate(column(lags, "direction")):
            found = [column(lags, name)[row] for name in ("correlation", "lag", "z")]
            if direction not in largest or abs(found[0]) > abs(largest[direction][0]):
                largest[direction] = found
        along, across = (f"largest correlation {c:.4f} at lag {lag} (z {z:.1f})"
                         for c, lag, z in (largest["along"], largest["across"]))
        for line in [f"alpha {v['alpha']:.4f} ± {v['alpha_stderr']:.1g}, sigma {v['sigma_nm']:.4g} ± {v['sigma_stderr_nm']:.1g}"
                     f" nm, innovation {v['innovation_nm2']:.4g} ± {v['innovation_stderr_nm2']:.1g} nm^2",
                     f"along rows p = {v['whiteness_along_p']:.4f}: {along}",
                     f"across rows p = {v['whiteness_across_p']:.4f}: {across}",
                     f"p = {v['normality_p']:.4f}: skewness {v['skewness']:.3f}, excess kurtosis {v['excess_kurtosis']:.3f}"]:
            expect(line in printed, f"{properties}: '{line}' is not in\n{printed}")
        if not properties:
            expect(f"{100 * v['substrate_share']:.1f} % of the image" in printed, f"the substrate of\n{printed}")
        expect(max(column(lags, "lag")) == properties.get("Lags", 10), "as many lags as were asked for")


run(tips_equal_the_command, morphology_equals_the_command, tips_are_resampled, certainty_equals_the_command,
    cleaning_equals_the_command, found_tips_equal_the_command, outputs_tell_how_they_were_made,
    wrong_properties_are_refused, progress_and_abort, the_library_tells_its_time, measured_noise_equals_the_command)
