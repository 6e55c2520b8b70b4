# SPDX-License-Identifier: GPL-3.0-or-later
"""Exceptions, warnings and notes."""


class Error(Exception):
    """What semsurf raises. The text says what is wrong, why, and what to do.

    Attributes: ``subject`` (a file or an argument), ``reason``, ``remedy``, and ``field``: the
    keyword argument that is meant, or None.
    """

    def __init__(self, subject, reason="", remedy="", field=None):
        text = f"{subject}: {reason}" if reason else subject
        super().__init__(f"{text}. {remedy}" if remedy else text)
        self.subject, self.reason, self.remedy, self.field = subject, reason, remedy, field


class UsageError(Error, ValueError):
    """An argument is missing, unknown, malformed or out of range."""


class InvalidInput(Error, ValueError):
    """Data cannot be used: NaN vertices, an open mesh, an empty image."""


class FileError(Error, OSError):
    """A file cannot be opened, read, understood or written."""


class Unsupported(Error, RuntimeError):
    """What is asked for is understood, but this build cannot do it."""


class Interrupted(KeyboardInterrupt):
    """Work was stopped by Ctrl-C. ``partial`` is what was done so far, where that is of use."""

    partial = None


class Doubt(UserWarning):
    """A result, or an argument, is possibly not what is wanted."""


def note(text):
    import logging
    logging.getLogger("semsurf").info(text)


def warn(text):
    import sys
    import warnings
    # To where semsurf was called from: frames of its own files do not count.
    depth, frame = 2, sys._getframe(1)
    while frame is not None and "semsurf" in frame.f_globals.get("__name__", "").split(".")[:1]:
        depth, frame = depth + 1, frame.f_back
    warnings.warn(text, Doubt, stacklevel=depth)
