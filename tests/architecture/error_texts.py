# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors speak one way. A reason is a clause with a subject of its own: it begins with a small letter or a value, as
"the file is empty", and has no full stop. A remedy is a sentence that begins with a capital letter and has no full
stop: messages put them together. Usage: error_texts.py ROOT"""

import pathlib
import re
import sys

FOLDERS = ["libsurf", "mc_sim/include", "mc_sim/src", "io", "workflow"]
CALL = re.compile(r"\b(?:(?:throw\s+)(FileError|InvalidInput|UsageError|Unsupported)|(fail))\s*\(")
LITERAL = re.compile(r'"((?:[^"\\]|\\.)*)"')
VERBS = re.compile(r"^(is|are|has|have|cannot|can|must|does|do|was|were|needs|ends|holds|lies|failed)\b")


def arguments(text, start):
    """The arguments of a call whose parenthesis is opened before `start`."""
    parts, depth, begin, at, quoted = [], 0, start, start, False
    while at < len(text):
        c = text[at]
        if quoted:
            if c == "\\":
                at += 1
            quoted = c != '"'
        elif c == '"':
            quoted = True
        elif c in "([{":
            depth += 1
        elif c in ")]}":
            if depth == 0:
                parts.append(text[begin:at])
                return parts
            depth -= 1
        elif c == "," and depth == 0:
            parts.append(text[begin:at])
            begin = at + 1
        at += 1
    return parts


def faults_of(reason, remedy):
    found = []
    texts = LITERAL.findall(reason or "")
    if texts:
        if texts[0][:1].isupper() and not re.match(r"[A-Z][A-Z0-9]|OpenSSL|OpenImageIO|Nanoscope|Embree", texts[0]):
            found.append(f"the reason '{texts[0]}' begins with a capital letter")
        if VERBS.match(texts[0]):
            found.append(f"the reason '{texts[0]}' has no subject")
        if texts[-1].endswith((".", "!")):
            found.append(f"the reason '{texts[-1]}' ends with a stop")
    texts = LITERAL.findall(remedy or "")
    if texts:
        if texts[0] and "error.remedy()" not in remedy and not re.match(r"[A-Z0-9'{`%]", texts[0]) and "?" not in remedy:
            found.append(f"the remedy '{texts[0]}' does not begin with a capital letter")
        if texts[-1].endswith((".", "!")):
            found.append(f"the remedy '{texts[-1]}' ends with a stop")
    return found


def faults_in(text):
    for match in CALL.finditer(text):
        if not match.group(1) and re.search(r"(void|auto|bool) $", text[: match.start()]):
            continue  # its definition
        parts = arguments(text, match.end())
        if match.group(1):
            parts = parts[1:]  # behind the subject
        else:
            parts = [part for part in parts if LITERAL.search(part)]
            if len(parts) > 2 or (parts and " " not in "".join(LITERAL.findall(parts[0]))):
                parts = parts[1:]  # it names the subject, too
        reason, remedy = (parts + ["", ""])[:2]
        for fault in faults_of(reason, remedy):
            yield text.count("\n", 0, match.start()) + 1, fault


def check_itself():
    bad = 'throw FileError(file, "The file is empty.", "copy it again.");\nfail("has no end");'
    good = 'throw FileError(file, fmt::format("the file has {}, not 6", n), "Copy it again");\nfail("it has no end");'
    assert len(list(faults_in(bad))) == 5, list(faults_in(bad))
    assert not list(faults_in(good)), list(faults_in(good))


def main():
    if sys.argv[1] == "--self-test":
        return check_itself()
    root = pathlib.Path(sys.argv[1])
    count = 0
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix not in {".cpp", ".h"}:
                continue
            for line, fault in faults_in(path.read_text(encoding="utf-8")):
                print(f"{path.relative_to(root)}:{line}: {fault}")
                count += 1
    if count:
        sys.exit(f"{count} texts of errors are of another kind: see the head of this script")


if __name__ == "__main__":
    main()
