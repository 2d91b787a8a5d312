# SPDX-License-Identifier: Apache-2.0
"""What holds for every verb: help, versions, unknown words, options, and where results go."""

import json
import os
import re
import subprocess
import unittest

from program import PROGRAM, ProgramTest

# A square in the plane, so that every alignment is determined, and the same path 10 cm aside.
TRUTH = "".join(f"{i}.0 {x} {y} 0 0 0 0 1\n" for i, (x, y) in enumerate([(0, 0), (1, 0), (1, 1), (0, 1)]))
ESTIMATE = "".join(f"{i}.0 {x} {y} 0.1 0 0 0 1\n" for i, (x, y) in enumerate([(0, 0), (1, 0), (1, 1), (0, 1)]))


class Shell(ProgramTest):
    def verbs(self, *group):
        """All verbs as lists of words, as --help lists them."""
        text = self.assert_succeeds(*group, "--help").stdout
        listed = re.search(r"^Subcommands:\n((?:  .*\n)+)", text, re.MULTILINE)
        if not listed:
            return [list(group)]
        names = re.findall(r"^  (\w+)", listed.group(1), re.MULTILINE)
        return [verb for name in names for verb in self.verbs(*group, name)]

    def test_every_verb_has_help_with_an_example_of_itself_and_the_shared_flags(self):
        verbs = self.verbs()
        self.assertIn(["evaluate"], verbs)
        for verb in verbs:
            text = self.assert_succeeds(*verb, "--help").stdout
            self.assertIn("Example:\n  alidade " + " ".join(verb), text)
            writes_one_file = verb in (["convert"], ["calibrate", "board"])
            output = "--output FILE" if writes_one_file else "--output DIR"
            for flag in (output, "--quiet", "--json", "--seed", "--config FILE"):
                self.assertIn(flag, text, verb)

    def test_says_its_version(self):
        for words in (["--version"], ["evaluate", "--version"]):
            self.assertRegex(self.assert_succeeds(*words).stdout, r"^alidade \d+\.\d+\.\d+\n$")

    def test_unknown_verbs_and_flags_are_named_with_the_nearest_known_one(self):
        self.assert_refuses(["evalute", "a", "b"], r"^alidade: unknown verb 'evalute'; did you mean 'evaluate'\?$")
        self.assert_refuses(["evaluate", "a", "b", "--algin", "se3"],
                            r"^alidade evaluate: unknown flag '--algin'; did you mean '--align'\?$")
        self.assert_refuses([], r"^alidade: a verb is missing; one of: .*evaluate")

    def test_unknown_option_keys_are_named_with_their_line_and_the_nearest_known_one(self):
        self.write("c.yaml", "# mine\nrpe_stepp: 2\n")
        self.assert_refuses(["evaluate", "a", "b", "--config", "c.yaml"],
                            r"^c\.yaml:2: unknown key 'rpe_stepp'; did you mean 'rpe_step'\?$")

    def test_options_written_by_one_run_give_the_same_result_in_the_next(self):
        self.write("truth.tum", TRUTH)
        self.write("estimate.tum", ESTIMATE)
        self.assert_succeeds("evaluate", "estimate.tum", "truth.tum", "--align", "none", "-o", "first")
        options = self.directory / "first" / "options.yaml"
        self.assertIn("align: none", options.read_text())
        self.assert_succeeds("evaluate", "estimate.tum", "truth.tum", "--config", options, "-o", "second")
        self.assertEqual(self.summary("first"), self.summary("second"))

    def test_results_are_whole_and_never_overwrite_what_is_not_theirs(self):
        self.write("truth.tum", TRUTH)
        self.write("thesis/text.txt", "precious")
        words = ["evaluate", "truth.tum", "truth.tum", "-o"]
        self.assert_refuses([*words, "thesis"], r"^thesis: holds files that are not an alidade result; give -o")
        self.assert_refuses([*words, "truth.tum"], r"^truth\.tum: is not a directory")
        for _ in range(2):  # the second replaces the first
            self.assert_succeeds(*words, "out")
            self.assertEqual(sorted(os.listdir(self.directory / "out")), sorted(self.summary("out")["files"]))

    def test_quiet_prints_nothing_and_json_prints_only_json(self):
        self.write("truth.tum", TRUTH)
        quiet = self.assert_succeeds("evaluate", "truth.tum", "truth.tum", "--quiet")
        self.assertEqual((quiet.stdout, quiet.stderr), ("", ""))
        lines = self.assert_succeeds("evaluate", "truth.tum", "truth.tum", "--json").stdout.splitlines()
        self.assertIn("result", [json.loads(line)["event"] for line in lines])

    def test_a_full_standard_output_is_told(self):
        if not os.path.exists("/dev/full"):
            self.skipTest("no /dev/full")
        self.write("truth.tum", TRUTH)
        with open("/dev/full", "w") as full:
            done = subprocess.run([PROGRAM, "evaluate", "truth.tum", "truth.tum"], cwd=self.directory, stdout=full,
                                  stderr=subprocess.PIPE, text=True, check=False)
        self.assertEqual(done.returncode, 3)
        self.assertRegex(done.stderr, r"^standard output: write: ")


if __name__ == "__main__":
    unittest.main()
