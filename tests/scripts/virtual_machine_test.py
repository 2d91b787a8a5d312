# SPDX-License-Identifier: Apache-2.0
"""What scripts/test-v4l2-vm makes of what the virtual machine leaves, and what it says where there can be none."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
sys.dont_write_bytecode = True
sys.path.insert(0, str(SCRIPTS))
from virtual_machine.results import results_of  # noqa: E402


def report(*tests):
    return json.dumps({"testsuites": [{"name": "Faults", "testsuite": list(tests)}]})


def told(name, **more):
    return {"name": name, "file": "a.cpp", "line": 1, "status": "RUN", "result": "COMPLETED", "time": "1.5s",
            "timestamp": "", "classname": "Faults", **more}  # fmt: skip


class Results(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_figures_are_told_apart_from_what_every_test_has(self):
        (self.folder / "tests.json").write_text(report(told("Stall", stall_s="0.134", cycles="50")))
        results = results_of(self.folder)
        self.assertEqual(results["tests"], {"Faults.Stall": {"outcome": "passed", "seconds": 1.5}})
        self.assertEqual(results["figures"], {"stall_s": 0.134, "cycles": 50})

    def test_outcomes_are_told_apart(self):
        tests = [told("A", failures=[{}]), told("B", result="SKIPPED"), told("C", status="NOTRUN")]
        (self.folder / "tests.json").write_text(report(*tests))
        outcomes = {name: test["outcome"] for name, test in results_of(self.folder)["tests"].items()}
        self.assertEqual(outcomes, {"Faults.A": "failed", "Faults.B": "skipped"})

    def test_figures_of_the_comparison_are_added(self):
        (self.folder / "opencv.json").write_text('{"opencv_s": 10.03}\n')
        self.assertEqual(results_of(self.folder), {"tests": {}, "figures": {"opencv_s": 10.03}})

    def test_a_machine_that_left_nothing_has_no_results(self):
        self.assertEqual(results_of(self.folder), {"tests": {}, "figures": {}})


class WithoutAnEmulator(unittest.TestCase):
    def test_the_script_skips_and_says_what_to_install(self):
        done = subprocess.run([sys.executable, "-B", str(SCRIPTS / "test-v4l2-vm")], capture_output=True, text=True,
                              env={**os.environ, "PATH": "/nonexistent"})  # fmt: skip
        self.assertEqual(done.returncode, 77, done.stderr)
        self.assertRegex(done.stdout, r"\Askipped: .*qemu-system-x86_64.* missing; apt-get install .*\n\Z")


if __name__ == "__main__":
    unittest.main()
