#!/usr/bin/env python3
"""What scripts/source_archive packs builds and passes a test where there is no Git."""
import os
import pathlib
import subprocess
import sys
import tarfile
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]

if subprocess.run(["git", "rev-parse", "-q", "--verify", "HEAD"], cwd=ROOT, capture_output=True).returncode:
    print("skipped: this is no clone")
    sys.exit(77)


class SourceArchiveBuildTest(unittest.TestCase):
    def test_it_builds_without_git(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            self.run_in(ROOT, "scripts/source_archive", folder / "archive")
            (archive,) = (folder / "archive").iterdir()
            with tarfile.open(archive) as tar:
                tar.extractall(folder)
            source = folder / archive.name[:-len(".tar.gz")]
            (folder / "git").write_text("#!/bin/sh\necho no Git here >&2\nexit 127\n")
            (folder / "git").chmod(0o755)
            without_git = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}"}
            self.run_in(source, "cmake", "-S", ".", "-B", "build", "-DCMAKE_UNITY_BUILD=ON", env=without_git)
            self.run_in(source, "cmake", "--build", "build", "--parallel", str(os.cpu_count()), "--target", "api_test",
                        env=without_git)
            said = self.run_in(source, "build/tests/api_test", "--gtest_filter=*Estimat*", env=without_git)
            self.assertRegex(said, r"\[  PASSED  \] [1-9]")
            self.run_in(source, "scripts/check_names", env=without_git)

    def run_in(self, folder, *command, **more):
        done = subprocess.run([str(word) for word in command], cwd=folder, capture_output=True, text=True, **more)
        self.assertEqual(done.returncode, 0, done.stdout[-3000:] + done.stderr[-3000:])
        return done.stdout


if __name__ == "__main__":
    unittest.main()
