#!/usr/bin/env python3
"""scripts/source_archive: two clones make the same bytes, and what they hold can be configured (BytesTest) and built (BuildTest)."""
import os
import pathlib
import subprocess
import sys
import tarfile
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def run(*command, **more):
    ended = subprocess.run(list(map(str, command)), capture_output=True, text=True, **more)
    if ended.returncode:
        print(ended.stdout[-4000:], ended.stderr[-4000:], file=sys.stderr)
    ended.check_returncode()
    return ended.stdout


def commit_of(folder):
    return run("git", "rev-parse", "HEAD", cwd=folder).strip()


try:
    commit_of(ROOT)
except (OSError, subprocess.CalledProcessError):
    print("skipped: this is no clone")
    sys.exit(77)


class ArchiveTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        # An archive lies in no clone, and Git must not look for one above it.
        self.outside = {**os.environ, "GIT_CEILING_DIRECTORIES": str(self.folder)}

    def unpacked(self, archive):
        with tarfile.open(archive) as tar:
            tar.extractall(self.folder / "unpacked")
        (source,) = (self.folder / "unpacked").iterdir()
        return source


class BytesTest(ArchiveTest):
    def test_two_clones_make_the_same_bytes(self):
        # Of this tree's script, also while it is not committed yet.
        script = (ROOT / "scripts/source_archive").read_text()
        archives = []
        for number, (umask, locale, prefix) in enumerate([(0o022, "C", "a"), (0o077, "C.UTF-8", "b" * 40)]):
            clone = self.folder / f"{prefix}{number}"
            run("git", "clone", "-q", "--no-hardlinks", *(["--depth=1"] if number else []), f"file://{ROOT}", clone,
                umask=umask)
            (clone / "scripts/source_archive").write_text(script)
            run("bash", "scripts/source_archive", self.folder / f"out{number}", cwd=clone, umask=umask,
                env={**os.environ, "LC_ALL": locale, "TZ": f"UTC+{number}"})
            (archive,) = (self.folder / f"out{number}").iterdir()
            archives.append(archive)
        self.assertEqual(archives[0].name, archives[1].name)
        self.assertTrue(archives[0].read_bytes() == archives[1].read_bytes(), "the archives differ")

        with tarfile.open(archives[0]) as tar:
            names = tar.getnames()
            self.assertEqual({name.split("/")[0] for name in names}, {archives[0].name[:-len(".tar.gz")]})
            self.assertEqual({member.uname for member in tar if member.uname}, {"root"})
        source = self.unpacked(archives[0])
        committed = run("git", "ls-tree", "-r", "-z", "--name-only", "HEAD", cwd=ROOT).split("\0")[:-1]
        for name in committed:
            self.assertTrue((source / name).exists() or (source / name).is_symlink(), name)
        if not (source / "cmake/commit.txt").exists():
            self.skipTest("the commit is older than cmake/commit.txt")
        self.assertEqual((source / "cmake/commit.txt").read_text().strip(), commit_of(ROOT))
        run("cmake", "-S", source, "-B", self.folder / "build", "-DFINRAY_BUILD_TESTS=OFF", env=self.outside)
        build_h = (self.folder / "build/generated/finray/benchmark/build.h").read_text()
        self.assertIn(commit_of(ROOT)[:12], build_h)


class BuildTest(ArchiveTest):
    def test_the_archive_builds_an_executable_that_runs(self):
        run("bash", "scripts/source_archive", self.folder / "out", cwd=ROOT)
        (archive,) = (self.folder / "out").iterdir()
        source = self.unpacked(archive)
        run("cmake", "--preset", "demo", cwd=source, env=self.outside)
        run("cmake", "--build", "--preset", "demo", "--parallel", os.cpu_count(), "--target", "finray_check", cwd=source,
            env=self.outside)
        checked = run(source / "build/demo/finray_check", "--finger", "configs/fingers/paper_140mm.yaml", "--out", "finger.svg",
                      cwd=source)
        self.assertIn("paper_140mm", checked)
        self.assertIn("<svg", (source / "finger.svg").read_text())


if __name__ == "__main__":
    unittest.main()
