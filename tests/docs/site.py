# SPDX-License-Identifier: GPL-3.0-or-later
"""The web site of the manual is built and opened in a browser: python3 site.py SOURCE SEMSURF VERSION NODE PACKAGES SITE.

Exit code 77: MkDocs, Doxygen, Node.js or a browser is missing.
"""
import pathlib
import subprocess
import sys

source, semsurf, version, node, packages, site = sys.argv[1:7]
here = pathlib.Path(__file__).resolve().parent
for command in ([sys.executable, "-B", f"{source}/site/build.py", source, site, semsurf, version],
                [node, here / "site.mjs", packages, site]):
    code = subprocess.run(command).returncode
    if code:
        sys.exit(code)
