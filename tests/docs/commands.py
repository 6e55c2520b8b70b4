# SPDX-License-Identifier: GPL-3.0-or-later
"""Every command of the manual is one that the program has: `semsurf COMMAND --option` in blocks and in running text, on all pages.
Commands whose files the reader brings cannot be run; their names, options and choices are looked up in the program's help.
Usage: commands.py ROOT SEMSURF"""
import pathlib
import re
import shlex
import subprocess
import sys

BLOCK = re.compile(r"^```(?:sh|bash|console)\n(.*?)^```", re.MULTILINE | re.DOTALL)
INLINE = re.compile(r"`(semsurf [^`]+)`")
OPTION = re.compile(r"^  (?:(-\w),)?(--[a-z0-9-]+)(?: (\S+))?", re.MULTILINE)
BETWEEN = re.compile(r"&&|;(?=(?:[^']*'[^']*')*[^']*$)|\|(?=\s)")
GROUPS = ("library", "noise")   # commands with commands of their own
PROGRAM_OPTIONS = {"--help", "-h", "--version", "--json"}


def commands_of(text):
    """(line, words) of each call of the program; `...` stands for what the reader adds."""
    for block in BLOCK.finditer(text):
        joined = re.sub(r"\\\n", lambda m: "  ", block[1])
        number = text.count("\n", 0, block.start()) + 2
        for line in joined.splitlines():
            for part in BETWEEN.split(line):
                if match := re.match(r"(?:\s*(?:for .* do|mpirun .*?|nice|time))?\s*(?:build/bin/)?(semsurf\s.*)", part):
                    yield number, match[1]
            number += 1
    for match in INLINE.finditer(BLOCK.sub(lambda m: re.sub(r"[^\n]", " ", m[0]), text)):
        yield text.count("\n", 0, match.start()) + 1, match[1]


class Program:
    def __init__(self, path):
        self.path, self.known = path, {}
        top = self.help()
        self.commands = set(re.findall(r"^  ([a-z]+)  ", top, re.MULTILINE))

    def help(self, *command):
        return subprocess.run([self.path, *command, "--help"], capture_output=True, text=True, check=True).stdout

    def options(self, command):
        if command not in self.known:
            found = {}
            for short, long, form in OPTION.findall(self.help(*command)):
                found[long] = form
                if short:
                    found[short] = form
            self.known[command] = found
        return self.known[command]

    def fault(self, text):
        """What the program would not understand, or None."""
        try:
            words = shlex.split(text, comments=True)[1:]
        except ValueError as error:
            return str(error)
        if not words or words[0].startswith(("-", "...", "COMMAND")):
            return next((w for w in words if w.startswith("--") and w not in PROGRAM_OPTIONS), None)
        if words[0] not in self.commands:
            return f"there is no command {words[0]}"
        deep = 2 if words[0] in GROUPS and len(words) > 1 and re.fullmatch("[a-z]+", words[1]) else 1
        if words[:2] == ["sweep", "join"]:
            deep = 2
        options = self.options(tuple(words[:deep]))
        for word in words[deep:]:
            name, _, value = word.partition("=")
            if not re.fullmatch(r"--[a-z][a-z0-9-]*|-[a-z]", name):
                continue
            if name not in options:
                return f"there is no option {name}"
        return None


def main():
    root, program = pathlib.Path(sys.argv[1]), Program(sys.argv[2])
    pages = sorted([*(root / "docs").rglob("*.md"), root / "README.md"])
    count, faults = 0, 0
    for page in pages:
        if page.parent.name == "reference" and page.name == "commands.md":   # made by the program itself
            continue
        for line, text in commands_of(page.read_text()):
            count += 1
            if fault := program.fault(text):
                print(f"{page.relative_to(root)}:{line}: '{text}': {fault}")
                faults += 1
    print(f"{count} commands on {len(pages)} pages, {faults} faults")
    return 1 if faults or count < 200 else 0


if __name__ == "__main__":
    sys.exit(main())
