# SPDX-License-Identifier: Apache-2.0
"""Runs alidade as a user does: the program, its words on stdout and stderr, its exit code, the files it leaves."""

import json
import os
import pathlib
import signal
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["ALIDADE"]  # set by ctest
ROOT = pathlib.Path(__file__).resolve().parents[2]


def data_folder():
    """The recordings that are not part of the project; None where they are absent."""
    folder = pathlib.Path(os.environ.get("ALIDADE_DATA") or ROOT.parent / "shared" / "data")
    return folder if folder.is_dir() else None


class ProgramTest(unittest.TestCase):
    """Each test has a fresh directory, self.directory, in which the program is run."""

    def setUp(self):
        holder = tempfile.TemporaryDirectory(prefix="alidade_cli_")
        self.addCleanup(holder.cleanup)
        self.directory = pathlib.Path(holder.name)

    def alidade(self, *words, timeout=300, **keywords):
        """The finished process, with text in stdout and stderr."""
        return subprocess.run([PROGRAM, *map(str, words)], cwd=self.directory, capture_output=True, text=True,
                              timeout=timeout, check=False, **keywords)

    def write(self, name, text):
        path = self.directory / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    def summary(self, out):
        return json.loads((self.directory / out / "summary.json").read_text(encoding="utf-8"))

    def assert_succeeds(self, *words, **keywords):
        done = self.alidade(*words, **keywords)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def assert_refuses(self, words, pattern, code=2):
        """Exit code, nothing on stdout, exactly one line on stderr that matches the pattern."""
        done = self.alidade(*words)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertEqual(done.stdout, "")
        lines = done.stderr.splitlines()
        self.assertEqual(len(lines), 1, done.stderr)
        self.assertRegex(lines[0], pattern)

    def interrupt(self, words, once_seen, signal_number=signal.SIGINT, timeout=300):
        """Starts the program, sends the signal when a line on stderr or stdout contains `once_seen`, and returns the
        exit code with all that was printed."""
        with subprocess.Popen([PROGRAM, *map(str, words)], cwd=self.directory, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True) as process:
            printed = []
            for line in process.stdout:
                printed.append(line)
                if once_seen in line:
                    process.send_signal(signal_number)
                    break
            printed.extend(process.stdout)
            return process.wait(timeout), "".join(printed)
