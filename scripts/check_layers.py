#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds the layers of the code: which module may include which, without a circle, and no heavy library in a header.

Usage: scripts/check_layers.py [ROOT]. Prints one line per fault, "path:line: what; remedy", and exits 1 if there is one.
"""

import pathlib
import re
import subprocess
import sys

# What a module may include; what it may include, it may include through (see CONTRIBUTING.md, "Layers").
MAY_INCLUDE = {
    "core": [],
    "geometry": ["core"],
    "camera": ["geometry"],
    "io": ["camera"],
    "features": ["camera"],
    "estimation": ["camera"],
    "view": ["camera"],
    "capture": ["io"],
    "reconstruction": ["features", "estimation"],
    "marker1d": ["estimation"],
    "uav": ["estimation", "features"],
    "evaluation": ["estimation"],
    "tracking": ["reconstruction"],
    "calib": ["reconstruction"],
    "datasets": ["capture", "view"],
}
# These join everything and nothing includes them.
TOP = ["app", "tests"]
# Where a module lives when it is not modules/NAME.
FOLDERS = {"calib": "calib", "datasets": "datasets", "app": "app", "tests": "tests"}

# Libraries that cost seconds per file that sees them: in sources only.
HEAVY = re.compile(r"(vtk[A-Z]\w*\.h|Q[A-Z]\w*|Qt\w+/.*|arv\.h|aravis.*|ceres/.*|lib(av|sw)\w+/.*)$")
INCLUDE = re.compile(r'^\s*#\s*include\s*(?:"([^"]+)"|<([^>]+)>)')


def reachable(module, may_include):
    """All that `module` may include, directly or through others; raises ValueError on a circle."""
    found, trail = set(), []

    def visit(name):
        if name in trail:
            raise ValueError("circle in the list of layers: " + " -> ".join([*trail[trail.index(name):], name]))
        trail.append(name)
        for below in may_include[name]:
            visit(below)
            found.add(below)
        trail.pop()

    visit(module)
    return found


def module_of(path):
    """The module of a source file or of an included path; None outside all of them."""
    parts = pathlib.PurePosixPath(path).parts
    if parts[0] == "modules" and len(parts) > 2:
        return parts[1]
    return parts[0] if len(parts) > 1 and parts[0] in FOLDERS.values() else None


def included_module(included):
    """The module of the path in an #include, which is relative to modules/ or to the root; None for a library's."""
    first = pathlib.PurePosixPath(included).parts[0]
    return first if first in MAY_INCLUDE or first in TOP else None


def faults_of_line(path, module, allowed, line):
    match = INCLUDE.match(line)
    if not match:
        return
    ours, library = match.groups()
    included = ours or library
    if path.endswith(".h") and HEAVY.match(included):
        yield f"<{included}> in a header; include it in the source and declare forward or hide it behind a struct"
    if not ours:
        return
    if included.startswith(("./", "../")):
        yield f'"{included}" is relative; name the module: "{module}/..."'
        return
    target = included_module(included)
    if target is None and "/" in included:
        yield f'"{included}" is in no module of the list; use <> for libraries, or add the module to scripts/check_layers.py'
    elif target is not None and target != module and target not in allowed:
        yield f"{module} may not include {target}; see the layers in CONTRIBUTING.md"


def faults_of_file(root, path):
    module = module_of(path)
    if module is None:
        return
    if module not in MAY_INCLUDE and module not in TOP:
        yield f"{path}:1: module '{module}' has no layer; add it to scripts/check_layers.py"
        return
    everything = set(MAY_INCLUDE) | {"app"} | ({"tests"} if module == "tests" else set())
    allowed = everything if module in TOP else reachable(module, MAY_INCLUDE)
    text = (root / path).read_text(encoding="utf-8", errors="replace")
    for number, line in enumerate(text.splitlines(), start=1):
        for fault in faults_of_line(path, module, allowed, line):
            yield f"{path}:{number}: {fault}"


def sources(root):
    """Paths of all C++ files, relative to the root: those git knows or would add, or all where it is no checkout."""
    listed = subprocess.run(["git", "-C", str(root), "ls-files", "--cached", "--others", "--exclude-standard"],
                            capture_output=True, text=True, check=False)
    if listed.returncode == 0:
        paths = listed.stdout.splitlines()
    else:
        paths = [p.relative_to(root).as_posix() for p in root.rglob("*")]
    return sorted(p for p in paths if p.endswith((".h", ".cpp")) and (root / p).is_file())


def main(arguments):
    root = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).resolve().parent.parent)
    for module in MAY_INCLUDE:
        reachable(module, MAY_INCLUDE)
    faults = [fault for path in sources(root) for fault in faults_of_file(root, path)]
    for fault in faults:
        print(fault, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
