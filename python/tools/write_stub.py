#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the stub of the package from its descriptions: write_stub.py > python/semsurf/__init__.pyi

Needs the package in PYTHONPATH. tests/python/test_interface.py says when the stub is out of date.
"""
import semsurf

HEAD = '''# SPDX-License-Identifier: GPL-3.0-or-later
# Written by python/tools/write_stub.py; not to be changed by hand.
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, Literal

from numpy import ndarray
from numpy.typing import ArrayLike

PathLike = str | os.PathLike[str]
__version__: str


class Findings(dict[str, Any]):
    def __getattr__(self, name: str) -> Any: ...


class Error(Exception):
    subject: str
    reason: str
    remedy: str
    field: str | None


class UsageError(Error, ValueError): ...
class InvalidInput(Error, ValueError): ...
class FileError(Error, OSError): ...
class Unsupported(Error, RuntimeError): ...
class Doubt(UserWarning): ...


class Interrupted(KeyboardInterrupt):
    partial: Any


def parameters(function: str | Callable[..., Any]) -> Findings: ...
'''

PITCH = "float | str | Sequence[float | str]"
INIT = {
    "HeightField": f"heights: ArrayLike, pitch: {PITCH} = 1, origin: tuple[float, float] = (0, 0), "
                   "valid: ArrayLike | None = None, record: Mapping[str, str] | None = None",
    "Tip": f"heights: ArrayLike, pitch: {PITCH} = 1, record: Mapping[str, str] | None = None",
    "Image": f"channels: dict[str, Any], pitch: {PITCH} = 1, origin: tuple[float, float] = (0, 0), "
             "units: Mapping[str, str] | None = None, record: Mapping[str, str] | None = None",
    "Mesh": "vertices: ArrayLike, triangles: ArrayLike, name: str = '', material: str = '', "
            "record: Mapping[str, str] | None = None",
}
PAIR = "tuple[float, float]"
TYPES = {"heights": "ndarray", "valid": "ndarray", "shape": "tuple[int, int]", "pitch": PAIR, "origin": PAIR,
         "extent": "tuple[float, float, float, float]", "record": "dict[str, str]", "found": "Findings",
         "apex": "tuple[int, int]", "doubt": "str", "channels": "list[str]", "units": "dict[str, str]",
         "vertices": "ndarray", "triangles": "ndarray", "name": "str", "material": "str",
         "bounds": "tuple[tuple[float, float, float], tuple[float, float, float]]"}
METHODS = {"plot": "(self, *args: Any, **keywords: Any) -> Any", "stderr": "(self, channel: str) -> ndarray",
           "keys": "(self) -> list[str]", "__getitem__": "(self, channel: str) -> ndarray",
           "__contains__": "(self, channel: object) -> bool", "__iter__": "(self) -> Iterator[str]",
           "__len__": "(self) -> int", "__array__": "(self, dtype: Any = None) -> ndarray",
           "_repr_html_": "(self) -> str"}


def classes():
    for name, init in INIT.items():
        kind = getattr(semsurf, name)
        yield f"\n\nclass {name}:\n    def __init__(self, {init}) -> None: ...\n"
        for member in vars(kind):
            if isinstance(vars(kind)[member], property):
                yield f"    @property\n    def {member}(self) -> {TYPES[member]}: ...\n"
                if vars(kind)[member].fset:
                    yield f"    @{member}.setter\n    def {member}(self, value: {TYPES[member]}) -> None: ...\n"
            elif member in METHODS:
                yield f"    def {member}{METHODS[member]}: ...\n"


def functions():
    for function in semsurf._semsurf.described_functions():
        parts, named = [], False
        for argument in function["arguments"]:
            if argument["by_name"] and not named:
                parts.append("*")
                named = True
            optional = "" if argument["required"] else " | None = None"
            parts.append(f"{argument['name']}: {argument['type']}{optional}")
        if not named and function["keywords"]:
            parts.append("*")
        for keyword in function["keywords"]:
            optional = " | None = None" if keyword["default"] == "None" else f" = {keyword['default']}"
            parts.append(f"{keyword['name']}: {keyword['type']}{optional}")
        lines = "".join(f"\n    {part}," for part in parts)
        yield f"\n\ndef {function['name']}({lines}\n) -> {function['result']}:\n    \"\"\"{function['summary']}\"\"\"\n"


print(HEAD + "".join(classes()) + "".join(functions()), end="")
