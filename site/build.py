#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the web site of the manual: build.py SOURCE OUTPUT SEMSURF VERSION.

The pages of docs/, README.md and CHANGELOG.md become a site in the folder OUTPUT, by MkDocs with the theme Material. Three
things are added that plain Markdown cannot hold:
- Files of the tree that a page links to, and notebooks, become pages of their own.
- A comment '<!-- embed NAME.html', commands and '-->' on lines of their own becomes the interactive page NAME.html that the
  commands write. SEMSURF is the program that they call.
- The reference of the C++ libraries, by Doxygen, is in OUTPUT/cpp.
The site loads nothing from elsewhere; every link is looked up, and a dead one is an error. Exit code 77: a program is missing.
"""
import html.parser
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import urllib.parse

SOURCE, OUTPUT, SEMSURF = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
VERSION = sys.argv[4]
WORK = OUTPUT.with_name(OUTPUT.name + "_work")
PAGES = WORK / "pages"
KINDS = {"tutorials": "Tutorials", "how-to": "How to", "reference": "Reference", "explanation": "Explanation",
         "development": "For developers"}   # folders, and what headings of the index begin with
LINK = re.compile(r"(!?\[[^\]]*\]\()([^)\s]+)(\))")
CODE = re.compile(r"(^ *```.*?^ *```$|`[^`\n]*`)", re.MULTILINE | re.DOTALL)
EMBED = re.compile(r"^<!-- embed (\S+\.html)\n(.*?)^-->$", re.MULTILINE | re.DOTALL)
PICTURES = {".png", ".svg", ".jpg", ".gif"}
LANGUAGES = {".py": "python", ".toml": "toml", ".cpp": "cpp", ".h": "cpp", ".txt": "cmake", ".cmake": "cmake", ".sh": "sh", ".json": "json",
             ".mjs": "js"}


def place_of(path):
    """Where a file or folder of the tree is in the site; None for what does not exist."""
    file = SOURCE / path
    if file.is_dir():
        return place_of(f"{path}/README.md") if (file / "README.md").exists() else f"source/{path}/index.md"
    if not file.exists():
        return None
    special = {"README.md": "index.md", "CHANGELOG.md": "changelog.md", "docs/README.md": "contents.md"}
    if path in special:
        return special[path]
    inside = path.removeprefix("docs/") if path.startswith("docs/") else f"source/{path}"
    if file.suffix == ".ipynb":
        return inside.removesuffix(".ipynb") + ".md"
    if file.suffix == ".md" or file.suffix in PICTURES:
        return inside
    return f"source/{path}.md"


class Stage:
    """Pages as MkDocs reads them, made of what pages of the tree link to."""

    def __init__(self):
        self.made, self.waiting = set(), []

    def want(self, path):
        if path not in self.made:
            self.made.add(path)
            self.waiting.append(path)

    def run(self):
        while self.waiting:
            path = self.waiting.pop()
            file, place = SOURCE / path, PAGES / place_of(path)
            place.parent.mkdir(parents=True, exist_ok=True)
            if file.is_dir():
                if not (file / "README.md").exists():
                    place.write_text(self.listing(path))
                else:
                    self.want(f"{path}/README.md")
            elif file.suffix == ".md":
                place.write_text(self.page(path, file.read_text()))
            elif file.suffix == ".ipynb":
                place.write_text(self.page(path, self.notebook(file, place)))
            elif file.suffix in PICTURES:
                shutil.copy(file, place)
            else:
                place.write_text(self.source(path, place))

    def page(self, path, text):
        folder, here = os.path.dirname(path), os.path.dirname(place_of(path))

        def link(match):
            before, target, after = match.groups()
            target, hash_sign, anchor = target.partition("#")
            if not target or re.match(r"[a-z]+:", target):
                return match.group()
            there = os.path.normpath(os.path.join(folder, target))
            if place_of(there) is None:
                sys.exit(f"{path}: {target} does not exist")
            self.want(there)
            return before + os.path.relpath(place_of(there), here or ".") + hash_sign + anchor + after

        def embed(match):
            name, commands = match.groups()
            if not made_by(name, commands):
                return ""
            url = urllib.parse.quote(os.path.relpath(f"view/{name}", here or "."))
            return (f'<iframe class="viewer" src="{url}" title="Interactive page" loading="lazy"></iframe>\n\n'
                    f'[Open this page on its own]({url}){{ .viewer-link target=_blank }}\n')

        parts = CODE.split(indented(text))   # code is at odd places
        parts[::2] = [LINK.sub(link, part) for part in parts[::2]]
        text = EMBED.sub(embed, "".join(parts))
        cpp = os.path.relpath("cpp/index.html", here or ".")
        return text.replace("`build/site/cpp/index.html`", f"[reference of the C++ libraries]({cpp})")

    def listing(self, path):
        lines = [f"# {path}", ""]
        here = os.path.dirname(place_of(path))
        for entry in sorted((SOURCE / path).iterdir()):
            if entry.name.startswith((".", "__")):
                continue
            inside = f"{path}/{entry.name}"
            self.want(inside)
            lines.append(f"- [{entry.name}]({os.path.relpath(place_of(inside), here)})")
        return "\n".join(lines) + "\n"

    @staticmethod
    def source(path, place):
        file = SOURCE / path
        shutil.copy(file, place.with_name(file.name))
        raw = f"[The file itself]({file.name})" + '{ download="" }'
        try:
            text = file.read_text()
        except UnicodeDecodeError:
            return f"# {path}\n\n{raw}\n"
        if len(text) > 200_000:
            return f"# {path}\n\n{raw}\n"
        return f"# {path}\n\n{raw}\n\n~~~~{LANGUAGES.get(file.suffix, 'text')}\n{text.rstrip()}\n~~~~\n"

    @staticmethod
    def notebook(file, place):
        shutil.copy(file, place.with_name(file.name))
        blocks = []
        for cell in json.loads(file.read_text())["cells"]:
            text = "".join(cell["source"]).rstrip()
            blocks.append(text if cell["cell_type"] == "markdown" else f"```python\n{text}\n```")
        head, _, rest = blocks[0].partition("\n")
        blocks[0] = f"{head}\n\n<a href=\"{file.name}\" download>Download this notebook</a>\n{rest}"
        return "\n\n".join(blocks) + "\n"


def indented(text):
    """Lists as Python-Markdown wants them: a blank line before, and four spaces a level, whatever the marker's width."""
    lines, offsets, fenced, before = [], [], False, ""
    for line in text.split("\n"):
        indent = len(line) - len(line.lstrip(" "))
        item = None if fenced else re.match(r" *([-*+]|\d+[.)]) +(?=\S)", line)
        if line.strip() and not fenced:
            continues = before.strip() and not item and indent == 0 and offsets   # a line of the paragraph before
            while offsets and indent < offsets[-1] and not continues:
                offsets.pop()
        shifted = " " * (4 * len(offsets) + indent - (offsets[-1] if offsets else 0)) + line.lstrip(" ") if line.strip() else ""
        if item and not offsets and before.strip() and not before.startswith((" ", "#", "- ", "* ")) and \
                not re.match(r"\d+[.)] ", before):
            lines.append("")
        lines.append(shifted if offsets else line)
        if item:
            offsets.append(len(item.group()))
        if line.lstrip(" ").startswith("```"):
            fenced = not fenced
        before = line
    return "\n".join(lines)


def made_by(name, commands):
    """Runs commands that write a page of `semsurf view`; false where this program was built without the viewer."""
    folder = WORK / "view" / name.removesuffix(".html")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "samples").symlink_to(SOURCE / "samples")
    environment = {**os.environ, "PATH": f"{SEMSURF.parent}:{os.environ['PATH']}"}
    done = subprocess.run(["bash", "-euo", "pipefail", "-c", commands], cwd=folder, env=environment, text=True, capture_output=True)
    if "built without" in done.stderr:
        print(f"{name} is left out: {done.stderr.strip()}")
        return False
    if done.returncode:
        sys.exit(f"{name}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    (PAGES / "view").mkdir(exist_ok=True)
    shutil.copy(folder / name, PAGES / "view" / name)
    return True


def title_of(place):
    text = (PAGES / place).read_text()
    title = re.search(r"^# (.+)$", text, re.MULTILINE).group(1).replace("`", "")
    return f"{title} (in Python)" if place.startswith("notebooks/") else title


def navigation():
    """Pages by kind, in the order of the index; explanations in its groups, and at the end what it does not list."""
    index = (SOURCE / "docs/README.md").read_text()
    listed, heading = {kind: {} for kind in KINDS}, ""
    for line in index.splitlines():
        heading = line.removeprefix("## ") if line.startswith("## ") else heading
        group = re.match(r"\| *([\w ]+?) *\|", line)
        for _, target, _ in LINK.findall(line):
            place = place_of(os.path.normpath("docs/" + target.partition("#")[0])) if "//" not in target else None
            kind = place.split("/")[0] if place else ""
            kind = "tutorials" if kind == "notebooks" else kind
            if kind not in KINDS or not heading.startswith(KINDS[kind]):
                continue
            if not any(place in pages for pages in listed[kind].values()):
                listed[kind].setdefault(group.group(1) if group and kind == "explanation" else "", []).append(place)
    nav = [{"Home": "index.md"}]
    for kind, title in KINDS.items():
        there = [str(path.relative_to(PAGES)) for path in sorted((PAGES / kind).rglob("*.md"))]
        known = {place for pages in listed[kind].values() for place in pages}
        listed[kind].setdefault("", []).extend(place for place in there if place not in known)
        entries = []
        for group, places in listed[kind].items():
            pages = [{title_of(place): place} for place in places]
            entries += [{group: pages}] if group else pages
        nav.append({title: entries})
        if kind == "explanation":
            nav.append({"Gallery": "gallery/README.md"})
            nav.append({"C++": "cpp/index.html"})
    nav[-1][KINDS["development"]].append({"Changes": "changelog.md"})
    nav.insert(1, {"Contents": "contents.md"})
    return nav


def run_doxygen():
    text = (SOURCE / "site/Doxyfile.in").read_text()
    for name, value in {"SOURCE": SOURCE, "OUTPUT": WORK, "VERSION": VERSION}.items():
        text = text.replace(f"@{name}@", str(value))
    (WORK / "Doxyfile").write_text(text)
    done = subprocess.run(["doxygen", "-q", WORK / "Doxyfile"], text=True, capture_output=True)
    if done.returncode or done.stderr:
        sys.exit(f"doxygen:\n{done.stderr}")
    shutil.copytree(WORK / "cpp", PAGES / "cpp")


class References(html.parser.HTMLParser):
    """What a page of the site names: anchors, links, and what it loads."""

    def __init__(self, text):
        super().__init__()
        self.anchors, self.links, self.loaded = set(), [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.anchors.update(given[key] for key in ("id", "name") if given.get(key))
        if tag == "a" and given.get("href"):
            self.links.append(given["href"])
        if given.get("src") or (tag == "link" and given.get("rel") != "canonical"):
            self.loaded.append(given.get("src") or given.get("href"))


def check():
    there = {os.path.relpath(os.path.join(folder, name), OUTPUT) for folder, _, names in os.walk(OUTPUT) for name in names}
    pages = {name: References((OUTPUT / name).read_text()) for name in sorted(there) if re.match(r"(?!view/).*\.html$", name)}
    faults, links = [], 0
    for where, page in pages.items():
        faults += [f"{where} loads {url}" for url in page.loaded if re.match(r"(https?:)?//", url)]
        for url in page.links + page.loaded:
            parts = urllib.parse.urlsplit(url)
            if parts.scheme or parts.netloc or where == "404.html":
                continue
            links += 1
            path = urllib.parse.unquote(parts.path)
            target = os.path.normpath(os.path.join(os.path.dirname(where), path)) if path else where
            target = os.path.normpath(f"{target}/index.html") if path.endswith("/") or path == "." else target
            if target not in there:
                faults.append(f"{where}: {url} does not exist")
            elif parts.fragment and target in pages and not where.startswith("cpp/") and \
                    urllib.parse.unquote(parts.fragment) not in pages[target].anchors:
                faults.append(f"{where}: {url} is no heading")
    if faults:
        sys.exit("\n".join(faults))
    print(f"{OUTPUT}: {len(pages)} pages, {links} links")


def main():
    for program in ("mkdocs", "doxygen"):
        if not shutil.which(program):
            print(f"skipped: {program} is missing (apt-get install mkdocs mkdocs-material doxygen)")
            sys.exit(77)
    shutil.rmtree(WORK, ignore_errors=True)
    PAGES.mkdir(parents=True)
    shutil.copy(SOURCE / "site/site.css", PAGES)
    run_doxygen()
    stage = Stage()
    for path in ["README.md", "CHANGELOG.md", *(str(page.relative_to(SOURCE)) for page in sorted((SOURCE / "docs").rglob("*.md")))]:
        stage.want(path)
    for path in sorted((SOURCE / "docs").rglob("*.ipynb")):
        stage.want(str(path.relative_to(SOURCE)))
    stage.run()
    settings = (SOURCE / "site/mkdocs.yml").read_text()
    settings += f"docs_dir: {json.dumps(str(PAGES))}\nsite_dir: {json.dumps(str(OUTPUT))}\nnav: {json.dumps(navigation())}\n"
    (WORK / "mkdocs.yml").write_text(settings)
    done = subprocess.run(["mkdocs", "build", "--strict", "--quiet", "--clean", "--config-file", WORK / "mkdocs.yml"], text=True,
                          capture_output=True)
    if done.returncode:
        sys.exit(f"mkdocs:\n{done.stdout}{done.stderr}")
    check()


main()
