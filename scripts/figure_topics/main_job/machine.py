# SPDX-License-Identifier: Apache-2.0
"""A machine without our packages: the README's two commands, and how long all of CI takes there."""

import re

from figure_topics.bench import ROOT, last_line
from figure_topics.figure import Fact, Failed, Figure, Section, Skipped

CANNOT_TRY = 77
COMMANDS = {"demo": "./scripts/demo", "test": "./scripts/test", "ci": "CCACHE_DISABLE=1 ./.ci/run"}


def measure_fresh_machine(bench):
    run = bench.run(ROOT / "scripts" / "check_fresh_machine", *COMMANDS.values(), code=None)
    if run.code == CANNOT_TRY:
        raise Skipped(last_line(run.stderr))
    told = {command: (int(code), int(seconds)) for code, seconds, command in
            re.findall(r"^fresh machine: (\d+) (\d+) (.*)$", run.stdout, re.MULTILINE)}
    if set(told) != set(COMMANDS.values()):
        raise Failed(f"the fresh machine broke off: {last_line(run.stderr)}")
    for name in ("demo", "test", "ci"):
        code, _ = told[COMMANDS[name]]
        yield f"fresh-machine/{name}", Fact(f"exit {code}", code == 0)
    built = re.search(r"^build: ci took (\d+) s$", run.stdout, re.MULTILINE)  # everything, warnings as errors
    error = re.search(r"([\d.]+) % of the path", run.stdout)
    yield "fresh-machine/demo-ate-rmse-sim3", float(error.group(1)) if error else float("inf")
    yield "fresh-machine/full-build-time", int(built.group(1)) / 60 if built else float("inf")
    yield "fresh-machine/ci-time", told[COMMANDS["ci"]][1] / 60


FRESH_MACHINE = Section("fresh-machine", [
    Figure("fresh-machine/demo", expected="exit 0"),
    Figure("fresh-machine/test", expected="exit 0"),
    Figure("fresh-machine/ci", expected="exit 0"),
    Figure("fresh-machine/demo-ate-rmse-sim3", "% of path", at_most=0.3),
    Figure("fresh-machine/full-build-time", "min", at_most=10),
    Figure("fresh-machine/ci-time", "min", at_most=40),
], measure_fresh_machine)

SECTIONS = [FRESH_MACHINE]
