# SPDX-License-Identifier: Apache-2.0
"""What the test programs left, as one record."""

import json

# What GoogleTest says of each test itself; the rest are figures that the test reported.
OF_THE_TEST = {"name", "file", "line", "status", "result", "timestamp", "time", "classname", "failures",
               "value_param", "type_param"}  # fmt: skip


def number(text):
    try:
        value = float(text)
    except ValueError:
        return text
    return int(value) if value.is_integer() else value


def outcome(test):
    if test["result"] == "SKIPPED":
        return "skipped"
    return "failed" if test.get("failures") else "passed"


def results_of(folder):
    """{"tests": {name: {"outcome": ..., "seconds": ...}}, "figures": {name: number}} from the files in the folder; what
    is absent is left out."""
    results = {"tests": {}, "figures": {}}
    report = folder / "tests.json"
    if report.is_file():
        for suite in json.loads(report.read_text())["testsuites"]:
            for test in suite["testsuite"]:
                if test["status"] != "RUN":
                    continue
                results["tests"][f"{suite['name']}.{test['name']}"] = {
                    "outcome": outcome(test),
                    "seconds": float(test["time"].removesuffix("s")),
                }
                results["figures"].update({k: number(v) for k, v in test.items() if k not in OF_THE_TEST})
    compared = folder / "opencv.json"
    if compared.is_file() and compared.read_text().strip():
        results["figures"].update(json.loads(compared.read_text()))
    return results
