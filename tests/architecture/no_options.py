#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks that libraries do not speak the command line. Usage: no_options.py ROOT | no_options.py --self-test

Messages and comments of libsurf, mc_sim, io and workflow name fields, `scan.pixel_size`, which the program, scene files
and ParaView say in words of their own. A line is complained about where a text or a comment holds an option, as
--pixel-size. Whole commands are no fault: those of semsurf, as 'semsurf mesh part.stl --repair', and of OTHERS.
"""
import pathlib
import re
import sys
import tempfile

LIBRARIES = ("libsurf", "mc_sim", "io", "workflow")
# Files that start programs of others, write for them, or write the command that repeats a run, and what they may say.
OTHERS = {"io/src/afm/gwyddion_program.cpp": {"--no-log-to-file", "--convert-to-gwy"},
          "io/src/afm/gwyddion_program.h": {"--convert-to-gwy"},
          "libsurf/include/surf/core/command_words.h": {"--level-method", "--working-distance"},
          "workflow/src/train_parameters.cpp": {"--images", "--signal", "--materials", "--material", "--detector"},
          "workflow/src/reconstruction_report.cpp": {"--height-noise", "--level-method", "--level-degree",
                                                     "--level-tolerance"},
          "io/src/web/web_page_template.h": {"--semsurf"}}   # <!--semsurf:title-->
# Characters first: '"' begins no text. Of a comment or a text, what it says.
SAID = re.compile(r"""'(?:[^'\\\n]|\\.)'|//(?P<line>[^\n]*)|/\*(?P<block>.*?)\*/"""
                  r"""|R"(?P<mark>\w*)\((?P<raw>.*?)\)(?P=mark)"|(?P<text>"(?:[^"\\\n]|\\.)*"(?:\s*"(?:[^"\\\n]|\\.)*")*)""", re.S)
JOINT = re.compile(r'"\s*"')   # of texts that the compiler joins
BARE_FIELD = re.compile(r'UsageError\("([a-z_]+\.[a-z_.]+)"')   # a subject without backticks is not translated
OPTION = re.compile(r"(?<![\w-])(?:--[a-z][a-z-]*|-o(?= [a-z]))")
COMMAND = re.compile(r"semsurf [a-z]+\b[^'.;\n]*$")   # ends in the option that is looked at


def faults_of(name, source):
    for bare in BARE_FIELD.finditer(source):
        line = source.count("\n", 0, bare.start()) + 1
        yield f"{name}:{line}: {bare.group(1)} needs backticks to be said in the words of its reader"
    for said in SAID.finditer(source):
        for kind in ("line", "block", "raw", "text"):
            words = said.group(kind)
            if kind == "text" and words:   # joined, each joint as long as it was
                words = JOINT.sub(lambda joint: "\0" * len(joint.group()), words)
            for option in OPTION.finditer(words or ""):
                if COMMAND.search(words[:option.start()].replace("\0", "")) or option.group() in OTHERS.get(name, ()):
                    continue
                line = source.count("\n", 0, said.start(kind) + option.start()) + 1
                yield f"{name}:{line}: {option.group()} is the command line's: name the field, as `scan.pixel_size`"


def faults(root):
    found = []
    for library in LIBRARIES:
        for path in sorted((root / library).rglob("*")):
            if path.suffix in (".h", ".cpp", ".inc", ".in"):
                found += faults_of(path.relative_to(root).as_posix(), path.read_text(encoding="utf-8"))
    return found


def self_test():
    bad = {"a.cpp": 'throw UsageError("--tilt", "91", "see");', "b.h": "int a;\n/// What --size says\nint b;",
           "c.cpp": 'f("it is semsurf\'s; give --tilt");', "d.cpp": "/* two\nlines --seed */",
           "e.cpp": 'char c = \'"\'; f("or --unit")', "f.cpp": 'R"(as\n--unit)"',
           "fa.cpp": 'throw UsageError("tip.size", "even", "odd");'}
    good = {"g.cpp": 'for (int i = 3; i > 0; --i) f("Try: semsurf mesh {} --repair (--max-hole X fills)");',
            "ha.cpp": 'throw UsageError("`tip.size`", file("a.txt"));',
            "h.cpp": "x = a[--top]; // `semsurf simulate --seed`", "i.cpp": 'f("a--b", "--", " -- ", --count, "--1");'}
    lines = {"b.h": 2, "d.cpp": 2, "f.cpp": 2}
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in {**bad, **good}.items():
            (root / "io").mkdir(exist_ok=True)
            (root / "io" / name).write_text(text)
        found = [fault.split(": ")[0] for fault in faults(root)]
    wanted = [f"io/{name}:{lines.get(name, 1)}" for name in bad]
    return [] if found == wanted else [f"found {found}, not {wanted}"]


def main():
    found = self_test() if sys.argv[1] == "--self-test" else faults(pathlib.Path(sys.argv[1]))
    print("\n".join(found) or "No options of the command line in the libraries")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
