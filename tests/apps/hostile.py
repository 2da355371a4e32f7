"""Runs executables on the good inputs, or with others in their place, in a folder of the test's own."""

import functools
import os
import pathlib
import resource
import shutil
import subprocess
import tempfile
import unittest

from good_inputs import APPS

BINARIES = pathlib.Path(os.environ.get("FINRAY_BINARY_DIR", ".")).resolve()
# Sanitizers reserve terabytes of addresses.
BOUNDED = os.environ.get("FINRAY_SANITIZE", "") == ""
MEMORY = 1 << 30  # bytes of addresses
SECONDS = 60       # a hang, on a busy machine too


class HostileCase(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="finray_hostile_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def put(self, app):
        """The good files, nothing else; returns the arguments."""
        files, arguments = APPS[app]
        out = self.folder / "out"
        if out.is_dir():
            shutil.rmtree(out)
        else:
            out.unlink(missing_ok=True)
        for name, content in files.items():
            path = self.folder / name
            if path.is_dir():
                path.rmdir()
            else:
                path.unlink(missing_ok=True)
            path.write_bytes(content)
        return arguments

    def run_app(self, app, arguments, **more):
        def bound():
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        return subprocess.run(
            [BINARIES / f"finray_{app}", *arguments.split()], cwd=self.folder,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=SECONDS, check=False,
            preexec_fn=bound if BOUNDED else None, **more)

    def expect_refused(self, app, arguments, name, **more):
        """One line on stderr, about the file `name`; returns it."""
        outcome = self.run_app(app, arguments, **more)
        line = outcome.stderr.decode(errors="replace")
        self.assertEqual(outcome.returncode, 2, line[:500])
        self.assertEqual(line.count("\n"), 1, line[:500])
        self.assertTrue(line.startswith(f"finray_{app}: {name}"), line[:500])
        self.assertLess(len(line), 1300)
        self.assertFalse((self.folder / "out").exists())
        self.assertEqual(list(self.folder.glob(".*")), [])
        return line

    def on_small_disk(self, size, commands):
        """Shell commands where `out` is a disk of that size."""
        shell = ["unshare", "--map-root-user", "--mount", "sh", "-c"]
        mount = f"mkdir -p out && mount -t tmpfs -o size={size} tmpfs out"
        run = functools.partial(subprocess.run, cwd=self.folder, timeout=SECONDS, check=False,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        if not shutil.which("unshare") or run([*shell, mount]).returncode != 0:
            self.skipTest("no mounting here")
        return run([*shell, f"{mount}\n{commands}"])
