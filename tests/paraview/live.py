# SPDX-License-Identifier: GPL-3.0-or-later
"""Live sources as ParaView's window drives them: asked whether there is news, what follows marked, nothing else."""
import time

from support import array, expect, quiet, run, same, simple, text


def live_goes_on_by_being_asked(**estimate):
    heights = simple.SampleSurface(Width=80, Depth=60, Pitch=4)
    settings = dict(Input=heights, Pixels=24, Electrons=60, Method="Direct", **estimate)
    live = simple.SimulateSEM(Live=1, **settings)
    states, end = [text(quiet(live), "state")], time.monotonic() + 60
    while states[-1] != "done" and time.monotonic() < end:
        live.UpdatePropertyInformation()
        if not live.GetPropertyValue("NeedsUpdate"):
            time.sleep(0.05)
            continue
        live.SMProxy.MarkModified(live.SMProxy)
        states.append(text(quiet(live), "state"))
    expect(states[-1] == "done", f"it does not get on: {states[-5:]}")
    live.UpdatePropertyInformation()
    expect(not live.GetPropertyValue("NeedsUpdate"), "there is news after the end")
    same(array(quiet(live), "SE"), array(quiet(simple.SimulateSEM(**settings)), "SE"), "Live in the end and at once")


def guided_too():
    live_goes_on_by_being_asked(Estimate="Guided")


run(live_goes_on_by_being_asked, guided_too)
