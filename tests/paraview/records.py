# SPDX-License-Identifier: GPL-3.0-or-later
"""What a filter's output says of how it was made: each property is changed from its default and found again."""
from support import FOLDER, SOURCE, each, expect, fetch, messages, numpy, run, simple, text, texts

MODEL = str(SOURCE / "samples" / "si-1keV-3nm.json")

# By property: another value, and what is to be found in the image.
SIMULATE = {
    "Energy": (2000, {"beam.energy_ev": "2000"}), "Tilt": (30, {"beam.tilt_deg": "30"}),
    "Azimuth": (50, {"beam.azimuth_deg": "50"}), "Spot": (3, {"beam.spot_nm": "3"}),
    "Convergence": (2, {"beam.convergence_deg": "2"}), "Focus": (7, {"beam.focus_nm": "7"}),
    "WorkingDistance": (5e6, {"beam.working_distance_nm": "5e+06"}),
    "Pixels": (6, {"scan.width": "6", "scan.height": "6"}), "PixelSize": (25, {"scan.pixel_x_nm": "25", "scan.pixel_y_nm": "25"}),
    "Region": ([-20, -20, 20, 20], {"scan.pixel_x_nm": "5"}),
    "Electrons": (4, {"simulation.electrons": "4"}), "Seed": (9, {"simulation.seed": "9"}),
    "Method": ("Replay", {"simulation.method": "replay"}), "Cutoff": (20, {"simulation.cutoff_ev": "20"}),
    "MeshTolerance": (0.5, {"simulation.mesh_tolerance_nm": "0.5"}),
    "Physics": ("secondaries=off", {"simulation.physics": "inelastic=monsel,elastic=mott,atoms=free,loss=joy-luo,secondaries=off,barrier=quantum"}),
    "Detectors": ("SE1", {"detector.3": "SE1:energy=0eV..50eV,cone=0deg..180deg,axis=beam,sector=0deg..360deg,side=any,"
                                        "origin=se1,efficiency=1"}),
    "Materials": ("Au", {"material.1.name": "Au"}),
    "Substrate": ("C", {"specimen.substrate": "C, top at 0 nm"}),
    "Trajectories": (3, {"output.trajectories": "3"}),
}
TOGETHER = {
    "Accuracy": ({"Budget": "Accuracy", "Accuracy": 0.5}, {"simulation.accuracy": "0.5"}),
    "AccuracyFloor": ({"Budget": "Accuracy", "Accuracy": 0.5, "AccuracyFloor": 0.25}, {"simulation.accuracy_floor": "0.25"}),
    "Estimate": ({"Estimate": "Guided", "Electrons": 16}, {"simulation.estimate": "guided"}),
    "GuideModel": ({"Estimate": "Guided", "Electrons": 16, "GuideModel": "off"}, {"simulation.guide_model": "off"}),
    "SubstrateTop": ({"Substrate": "Si", "SubstrateTop": -60}, {"specimen.substrate": "Si, top at -60 nm"}),
}
# What is of the input, or of how the result is shown.
OTHERS = {"Input", "Scalars", "MaterialFile", "Edge", "Budget", "Live", "NeedsUpdate"}

# Of filters that work on scans, tips and meshes: by property another value, and the parameter as the output says it. What
# it is changed together with comes third.
LEVELLING = {"Method": ("Plane", "level.method=plane"), "Degree": (3, "level.degree=3", {"Method": "Polynomial"}),
             "Tolerance": (1.5, "level.tolerance_nm=1.5"), "Rows": ("Difference", "level.rows=difference")}
CHAIN = {"LevelMethod": ("Plane", "level.method=plane"),
         "LevelDegree": (1, "level.degree=1", {"LevelMethod": "Polynomial"}),
         "LevelTolerance": (1.5, "level.tolerance_nm=1.5", {"LevelMethod": "Hough"}), "Rows": ("Median", "level.rows=median"),
         "HeightNoise": ("0.25,0.5", "scan.height_noise_nm=0.25,0.5"), "TipSize": (7, "reconstruction.tip_size=7"),
         "Energy": (1000, "beam.energy_ev=1000"), "Spot": (0, "beam.spot_nm=0"), "Signal": ("SE", "reconstruction.signal=SE"),
         "Physics": ("barrier=classical", "simulation.physics=inelastic=monsel,elastic=mott,atoms=free,loss=joy-luo,secondaries=on,barrier=classical"),
         "Objective": ("Mutual information", "registration.objective=mutual-information")}
STEPS = {
    "LevelScan": LEVELLING,
    "PredictSEM": {"Edge": ("Flat", "prediction.edge=flat"), "Resample": (0, "prediction.resample=off"),
                   "Material": ("Si", "specimen.material=Si"), "Energy": (1000, "beam.energy_ev=1000")},
    "CalibrateSEM": {"Fit": ("SE", "calibration.fit=SE"), "Offset": ("3", "calibration.offset=3"),
                     "Black": ("-4", "calibration.black=-4"), "White": ("1e6", "calibration.white=1e+06"),
                     "Ratio": ("0.5", "calibration.ratio=0.5", {"Fit": "SE,BSE"}), "Range": (30, "calibration.range_nm=30")},
    "CompareSurfaces": {"LargestShift": (12, "compare.largest_shift_nm=12"), "LeastOverlap": (0.6, "compare.least_overlap=0.6"),
                        "BeforeDeviation": (0.5, "compare.before_deviation_nm=0.5"),
                        "AfterDeviation": (0.25, "compare.after_deviation_nm=0.25"),
                        "FalseAlarms": (0.02, "compare.false_alarms=0.02"), "Registered": (1, "compare.registered=on"),
                        "LargestWindow": (24, "compare.largest_window_nm=24"), "Seed": (5, "compare.seed=5"),
                        "SmallestWindow": (3, "compare.smallest_window=3"), "Simulations": (60, "compare.simulations=60")},
    "CheckandRepairMesh": {"MaxHole": (4, "mesh.max_hole_nm=4"), "Stitch": (0.5, "mesh.stitch_nm=0.5"),
                           "Sliver": (0.25, "mesh.sliver_nm=0.25"), "MinComponent": (2, "mesh.min_component_nm=2"),
                           "KeepIntersections": (1, "mesh.keep_intersections=on")},
    "SimplifyMesh": {"MeshTolerance": (2, "mesh.mesh_tolerance_nm=2"),
                     "Triangles": (40, "mesh.triangles=40", {"Limit": "Triangles"})},
    "RegisterAFMandSEM": CHAIN | {"Seed": (5, "tip.seed=5"), "LandmarksOnly": (1, "registration.landmarks_only=on",
                                                                             {"landmarks": True})},
    "Reconstruct": CHAIN | {
        "Seed": (5, "reconstruction.seed=5"), "Gains": ("2,3", "reconstruction.gains=2,3"),
        "Offset": ("4", "reconstruction.offset=4", {"Gains": "2,3"}), "SemNoise": ("0,9", "reconstruction.sem_noise=0,9,"),
        "LandmarksOnly": (1, "registration.landmarks_only=on", {"landmarks": True, "UseTransform": 0}),
        "AcceptRegistration": (1, "registration.accept_registration=on"),
        "Transform": ([1, 0, 3, 0, 1, 0], "registration.transform=1,0,3,0,1,0"),
        "Optimiser": ("L-BFGS", "reconstruction.optimiser=lbfgs"), "Scales": ("2,1", "reconstruction.scales=2,1"),
        "Iterations": (2, "reconstruction.iterations=2"), "OptimiserTolerance": (0.5, "reconstruction.optimiser_tolerance=0.5"),
        "Prior": (0.25, "reconstruction.prior=0.25"), "FixedTransform": (1, "reconstruction.fixed_transform=on"),
        "FixedCalibration": (1, "reconstruction.fixed_calibration=on"), "RefineTip": (1, "reconstruction.refine_tip=on"),
        "KeepTip": (1, "reconstruction.keep_tip=on"), "NoUncertainty": (0, "reconstruction.no_uncertainty=off"),
        "Probes": (3, "reconstruction.probes=3"), "ModelError": (0.02, "reconstruction.model_error=0.02"),
        "Corrections": (1, "reconstruction.corrections=1"),
        "CorrectionElectrons": (8, "reconstruction.correction_electrons=8", {"Corrections": 1}),
        "LineJitter": (0.3, "reconstruction.line_jitter=0.3"),
        "Film": ("C", "reconstruction.film=C", {"Gains": "2,3", "Offset": "4"}),
        "Tilt": ("3", "beam.tilt_deg=3", {"views": True}),
        "Azimuth": ("90", "beam.azimuth_deg=90", {"views": True, "Tilt": "3"}),
        "TiltError": (0.2, "reconstruction.tilt_error_deg=0.2"),
        "ViewEnergy": ("1000", "reconstruction.view_energy_ev=1000", {"views": True}),
        "ViewSignal": ("SE", "reconstruction.view_signal=SE", {"views": True}),
        "ViewGains": ("2,3,4", "reconstruction.view_gains=2,3,4", {"views": True}),
        "ViewNoise": ("0,9", "reconstruction.view_noise=0,9,", {"views": True}),
        "ViewPlace": ("0,0", "reconstruction.view_place=0,0", {"views": True}),
        "FitDrift": (1, "reconstruction.fit_drift=on"), "FitSpot": (1, "reconstruction.fit_spot=on"),
        "ScanTilt": ("0,0", "reconstruction.scan_tilt=0,0,0,0"), "Upsample": (2, "reconstruction.upsample=2")},
    "AFMTip": {"Shape": ("Ball", "tip.shape=ball:5nm"), "Radius": (7, "tip.shape=cone:7nm,15deg"),
               "HalfAngle": (20, "tip.shape=cone:5nm,20deg"), "Faces": (3, "tip.shape=pyramid:5nm,15deg,3", {"Shape": "Pyramid"}),
               "Rotation": (9, "tip.shape=pyramid:5nm,15deg,4,9deg", {"Shape": "Pyramid"}),
               "StemRadius": (2, "tip.shape=ball:5nm,2nm,0deg", {"Shape": "Ball"}),
               "StemHalfAngle": (4, "tip.shape=ball:5nm,2nm,4deg", {"Shape": "Ball", "StemRadius": 2}),
               "TipSize": (9, "tip.size=9"), "Pitch": (2, "scan.height_pitch_nm=2")},
}
# Of a measurement, all changed together: it takes seconds.
PROFILE = {"Kind": ("Edge", "profile.kind=edge"), "AlongX": (1, "profile.along_x=on"), "Height": (31, "profile.height_nm=31"),
           "HeightError": (1, "profile.height_error_nm=1"), "Pitch": (0, "profile.pitch_nm=0"), "Angle": (85, "profile.angle_deg=85"),
           "AngleRange": (3, "profile.angle_range_deg=3"), "TopRadius": (0, "profile.top_radius_nm=0"),
           "FootRadius": (0, "profile.foot_radius_nm=0"), "WallsApart": (1, "profile.walls_apart=on"),
           "Threshold": (0.4, "profile.threshold=0.4"), "Energy": (300, "beam.energy_ev=300"), "Spot": (1, "beam.spot_nm=1"),
           "Physics": ("barrier=classical", "simulation.physics=inelastic=monsel,elastic=mott,atoms=free,loss=joy-luo,secondaries=on,barrier=classical"),
           "Signal": ("BSE", "profile.signal=BSE"), "ViewSignal": ("BSE;SE", "reconstruction.view_signal=BSE;SE"), "Tilt": ("1", "beam.tilt_deg=1"),
           "Azimuth": ("90", "beam.azimuth_deg=90"), "ViewEnergy": ("300", "reconstruction.view_energy_ev=300"),
           "TiltError": (0.2, "reconstruction.tilt_error_deg=0.2"), "Electrons": (10, "profile.electrons=10"),
           "MiddleElectrons": (20, "profile.middle_electrons=20"), "Rounds": (1, "profile.rounds=1"),
           "ModelError": (0.1, "profile.model_error=0.1"), "Seed": (5, "profile.seed=5")}
# Inputs, and what says what is made or shown, not how.
APART = {"Input", "Scalars", "SEM", "SEMScalars", "Tip", "AFMLandmarks", "SEMLandmarks", "Simulated", "SimulatedScalars",
         "After", "AfterScalars", "ModelFile", "Material", "MaterialFile", "UseTransform", "Repair", "Limit"}


def sphere():
    return simple.SampleBody(Shape="Sphere", Radius=50, Subdivisions=2)


def simulations_say_every_property():
    plain = texts(fetch(simple.SimulateSEM(Input=sphere(), Pixels=8, Electrons=2)))
    names = set(simple.SimulateSEM(Input=sphere()).ListProperties())
    known = set(SIMULATE) | set(TOGETHER) | OTHERS
    expect(names <= known, f"nobody looks for {names - known}")

    def check(name, properties, wanted):
        data = fetch(simple.SimulateSEM(Input=sphere(), **{"Pixels": 8, "Electrons": 2, **properties}))
        for key, value in wanted.items():
            expect(plain.get(key) != value, f"{key} is {value} by default")
            expect(text(data, key) == value, f"{key} is {text(data, key)}, not {value}")
    each([(name, {name: value}, wanted) for name, (value, wanted) in SIMULATE.items()] +
         [(name, properties, wanted) for name, (properties, wanted) in TOGETHER.items()], check)


def points(places):
    return simple.PolyLineSource(Points=[v for x, y in places for v in (x, y, 0)])


def step(name, properties):
    """A filter that is done in a moment."""
    scan = simple.SampleSurface(Shape="Rough", Width=69, Depth=57, Pitch=3, CorrelationLength=9, RmsHeight=4)
    sem = simple.PredictSEM(Input=scan, ModelFile=MODEL)
    chain = {"Input": scan, "SEM": sem, "Tip": simple.AFMTip(TipSize=5, Radius=5, Pitch=3), "ModelFile": MODEL,
             "LevelMethod": "None"}
    usual = {"LevelScan": {"Input": scan}, "PredictSEM": {"Input": scan, "ModelFile": MODEL},
             "CompareSurfaces": {"Input": scan, "After": scan, "Simulations": 50},
             "CalibrateSEM": {"Input": sem, "Simulated": sem}, "CheckandRepairMesh": {"Input": sphere()},
             "SimplifyMesh": {"Input": sphere()}, "RegisterAFMandSEM": chain,
             "Reconstruct": chain | {"UseTransform": 1, "Iterations": 1, "NoUncertainty": 1, "Corrections": 0},
             "AFMTip": {"TipSize": 5, "Radius": 5, "Pitch": 3}}
    properties = usual[name] | properties
    if properties.pop("landmarks", False):
        places = [(-30, -20), (30, -20), (-20, 25), (25, 20)]
        properties |= {"SEMLandmarks": points(places), "AFMLandmarks": points(places)}
    if properties.pop("views", False):
        properties |= {"SEM": [sem, simple.PredictSEM(Input=scan, ModelFile=MODEL)]}
    return getattr(simple, name)(**properties)


def said(source):
    """What any of the outputs says: a sound mesh comes back as it was, and the table says how it was looked at."""
    with messages():
        source.UpdatePipeline()
    found = {}
    for port in range(source.SMProxy.GetNumberOfOutputPorts()):
        data = fetch(source, port)
        if data.IsA("vtkCompositeDataSet"):
            continue
        found |= {key.removeprefix("option."): value for key, value in texts(data).items() if key.startswith("option.")}
    return found


def steps_say_every_property():
    def check(name):
        known = set(STEPS[name]) | APART
        names = set(step(name, {}).ListProperties())
        if name == "PredictSEM":
            names -= {"Spot"}   # no other one than the model's is taken
        expect(names <= known, f"nobody looks for {names - known}")
        plain = said(step(name, {}))
        for what, (value, wanted, *more) in STEPS[name].items():
            key, _, number = wanted.partition("=")
            got = said(step(name, (more[0] if more else {}) | {what: value}))
            expect(got.get(key, "").startswith(number), f"{what}: {key} is {got.get(key)}, not {number}")
            expect(not plain.get(key, "none").startswith(number), f"{what}: {key} is {number} by default")
    each([(name,) for name in STEPS], check)


def measurements_say_every_property():
    """Two images of an edge along x, bright at its rim."""
    y = (numpy.arange(24) - 12)[:, None] * 3.0
    numpy.savetxt(FOLDER / "rim.txt", (1 + 0.5 * (y > 0) + 1.5 * numpy.exp(-(((y - 3) / 5) ** 2)) + numpy.zeros(24))[::-1])

    def image():
        return simple.AFMScanReader(FileName=str(FOLDER / "rim.txt"), PixelSize=[3, 3])
    source = simple.MeasureProfile(Input=[image(), image()])
    names, known = set(source.ListProperties()), set(PROFILE) | APART | {"AFM", "AFMScalars"}
    expect(names <= known, f"nobody looks for {names - known}")
    for what, (value, _) in PROFILE.items():
        expect(getattr(source, what) != value, f"{what} is {value} by default")
        setattr(source, what, value)
    got = said(source)

    def check(what, wanted):
        key, _, text_of_it = wanted.partition("=")
        expect(got.get(key) == text_of_it, f"{key} is {got.get(key)}, not {text_of_it}")
    each([(what, wanted) for what, (_, wanted) in PROFILE.items()], check)


if __name__ == "__main__":
    run(simulations_say_every_property, steps_say_every_property, measurements_say_every_property)
