# SPDX-License-Identifier: GPL-3.0-or-later
"""What a filter's image says of how it was made: each property is changed from its default and found again."""
from support import each, expect, fetch, run, simple, text, texts

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
    "Physics": ("secondaries=off", {"simulation.physics": "elastic=mott,loss=joy-luo,secondaries=off,barrier=quantum"}),
    "Detectors": ("SE1", {"detector.3": "SE1:energy=0eV..50eV,cone=0deg..180deg,axis=beam,sector=0deg..360deg,side=any,"
                                        "origin=se1,efficiency=1"}),
    "Materials": ("Au", {"material.1.name": "Au"}),
    "Substrate": ("C", {"specimen.substrate": "C, top at 0 nm"}),
    "Trajectories": (3, {"output.trajectories": "3"}),
}
TOGETHER = {
    "Accuracy": ({"Budget": "Accuracy", "Accuracy": 0.5}, {"simulation.accuracy": "0.5"}),
    "AccuracyFloor": ({"Budget": "Accuracy", "Accuracy": 0.5, "AccuracyFloor": 0.25}, {"simulation.accuracy_floor": "0.25"}),
    "SubstrateTop": ({"Substrate": "Si", "SubstrateTop": -60}, {"specimen.substrate": "Si, top at -60 nm"}),
}
# What is of the input, or of how the result is shown.
OTHERS = {"Input", "Scalars", "MaterialFile", "Edge", "Budget", "Live", "NeedsUpdate"}


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


if __name__ == "__main__":
    run(simulations_say_every_property)
