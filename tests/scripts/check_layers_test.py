# SPDX-License-Identifier: Apache-2.0
"""scripts/check_layers.py on trees made for the purpose."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
sys.dont_write_bytecode = True
sys.path.insert(0, str(SCRIPTS))
import check_layers  # noqa: E402


def check(files):
    """Exit code and error lines of the script on a tree of {path: text}."""
    with tempfile.TemporaryDirectory() as root:
        for path, text in files.items():
            file = pathlib.Path(root, path)
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, encoding="utf-8")
        done = subprocess.run([sys.executable, SCRIPTS / "check_layers.py", root], capture_output=True, text=True,
                              check=False)
        return done.returncode, done.stderr.splitlines()


class CheckLayers(unittest.TestCase):
    def test_passes_what_the_list_allows_directly_and_through(self):
        self.assertEqual(check({
            "modules/tracking/tracker.cpp": '#include "tracking/tracker.h"\n#include "core/time.h"\n'
                                            '#include <ceres/ceres.h>\n',
            "app/main.cpp": '#include "tracking/tracker.h"\n#include "app/command.h"\n',
            "tests/core/time_test.cpp": '#include "tests/support/x.h"\n#include "core/time.h"\n',
        }), (0, []))

    def test_names_the_line_of_an_edge_beyond_the_list(self):
        code, lines = check({"modules/geometry/pose.h": '#pragma once\n\n#  include "camera/camera.h"\n'})
        self.assertEqual(code, 1)
        self.assertEqual(lines, ["modules/geometry/pose.h:3: geometry may not include camera; "
                                 "see the layers in CONTRIBUTING.md"])

    def test_keeps_the_methods_apart_from_each_other_and_from_files(self):
        for target in ("marker1d", "uav", "calib", "io", "capture", "view", "datasets", "app", "tests"):
            code, lines = check({"modules/tracking/tracker.cpp": f'#include "{target}/x.h"\n'})
            self.assertEqual((code, len(lines)), (1, 1), target)

    def test_refuses_heavy_libraries_in_headers_only(self):
        for header in ("ceres/ceres.h", "vtkActor.h", "QWidget", "QtCore/QObject", "arv.h", "libavcodec/avcodec.h"):
            self.assertEqual(check({"modules/view/a.cpp": f"#include <{header}>\n"})[0], 0, header)
            code, lines = check({"modules/view/a.h": f"#include <{header}>\n"})
            self.assertEqual(code, 1, header)
            self.assertTrue(lines[0].startswith(f"modules/view/a.h:1: <{header}> in a header"), lines)

    def test_refuses_relative_paths_and_unknown_modules(self):
        self.assertIn("is relative", check({"modules/core/a.cpp": '#include "../geometry/pose.h"\n'})[1][0])
        self.assertIn("has no layer", check({"modules/helpers/a.cpp": "\n"})[1][0])
        self.assertIn("in no module", check({"modules/core/a.cpp": '#include "helpers/a.h"\n'})[1][0])

    def test_finds_a_circle_in_the_list_itself(self):
        with self.assertRaisesRegex(ValueError, "a -> b -> a"):
            check_layers.reachable("a", {"a": ["b"], "b": ["a"]})

    def test_the_project_itself_passes(self):
        done = subprocess.run([sys.executable, SCRIPTS / "check_layers.py"], capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main()
