# SPDX-License-Identifier: GPL-3.0-or-later
"""The bar of ``progress=True``, on the standard error stream."""
import sys
import time


class Bar:
    WIDTH = 30

    def __init__(self):
        self.start = self.shown = time.monotonic()
        self.things = None
        self.first = 0.0

    def __call__(self, done, total, things):
        now = time.monotonic()
        if things != self.things:   # another part of the work
            self.things, self.start, self.first = things, now, done
        if now - self.shown < 0.1 and done < total:
            return
        self.shown = now
        share = min(max(done / total, 0), 1) if total > 0 else 0
        left = ""
        if done > self.first and share < 1:
            left = f" {(total - done) * (now - self.start) / (done - self.first):.0f} s left"
        filled = round(share * self.WIDTH)
        text = f"{'#' * filled}{'.' * (self.WIDTH - filled)} {100 * share:3.0f} % {things}{left}"
        sys.stderr.write(f"\r{text:<79.79}")
        sys.stderr.flush()

    def close(self):
        if self.things is not None:
            sys.stderr.write(f"\r{'':<79}\r")
            sys.stderr.flush()
