"""Logs, runs of scripts/batch/run and comparisons for the tests beside this file."""

import csv
import fcntl
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True
SOURCE = pathlib.Path(__file__).resolve().parents[2]
SCRIPTS = SOURCE / "scripts" / "batch"
sys.path.insert(0, str(SCRIPTS))
ESTIMATE = os.environ.get("FINRAY_ESTIMATE", "finray_estimate")
FINGER = SOURCE / "datasets" / "simulated_r15" / "hidden_finger.yaml"
SCENE = SOURCE / "configs" / "scenes" / "auto.yaml"
DATASET = SOURCE / "datasets" / "simulated_r15" / "holdout.csv"
FRAMES = "groups/**/[!.]*.frames.csv"  # results under their final names
SKIPPED = 77


def write_log(path, frames, first):
    """Rows of the dataset, over and over, from row `first` on."""
    head, *rows = DATASET.read_text().splitlines()
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join([head] + [rows[(first + i) % len(rows)]
                                         for i in range(frames)]) + "\n")


class BatchTestCase(unittest.TestCase):
    profile = []

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="finray_batch_"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.finger = self.folder / "finger.yaml"
        shutil.copy(FINGER, self.finger)
        self.out = self.folder / "out"

    def write_logs(self, names, frames=12):
        for i, name in enumerate(names):
            write_log(self.folder / "runs" / name, frames + i, 7 * i)

    def command(self, *more, logs="runs/*/*.csv", out="out"):
        return [str(SCRIPTS / "run"), "--finray_estimate", ESTIMATE, "--finger",
                str(self.finger), "--scene", str(SCENE), "--logs", logs,
                "--out_dir", out, *self.profile, *more]

    def run_batch(self, *more, code=0, env=None, **arguments):
        """Both streams of a run that ends with `code`."""
        outcome = subprocess.run(self.command(*more, **arguments), cwd=self.folder,
                                 text=True, check=False, env=env,
                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertEqual(outcome.returncode, code, outcome.stdout)
        return outcome.stdout

    def start(self, *more):
        return subprocess.Popen(self.command(*more), cwd=self.folder, text=True,
                                start_new_session=True, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT)

    def wait_for_results(self, process, count):
        while len(list(self.out.glob(FRAMES))) < count:
            self.assertIsNone(process.poll(), "ended early")
            time.sleep(0.01)

    def kill_runner(self, process):
        """The runner and Snakemake; their tasks go on."""
        with open(f"/proc/{process.pid}/task/{process.pid}/children",
                  encoding="ascii") as children:
            for pid in [process.pid, *map(int, children.read().split())]:
                os.kill(pid, signal.SIGKILL)
        process.wait()
        process.stdout.close()

    def wait_until_ended(self):
        """All that was killed has let the lock go; a busy machine takes its time."""
        with open(self.out / "plan/.lock", encoding="ascii") as file:
            fcntl.flock(file, fcntl.LOCK_EX)

    def run_single(self, out, code, more=()):
        """One finray_estimate over all logs."""
        runs = self.folder / "runs"
        done = subprocess.run([ESTIMATE, "--finger", self.finger, "--scene", SCENE, "--logs",
                        f"{runs}/*/*.csv", "--logs_root", runs, "--out_dir", out,
                        "--keep_going", *more], cwd=self.folder, check=False,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.assertEqual(done.returncode, code)
        return self.folder / out

    def rows(self, out):
        with open(out / "summary.csv", encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def expect_equal_to_single(self, out=None, code=0, more=()):
        """Summaries and every result's bytes; only places differ."""
        out, single = out or self.out, self.run_single("single", code, more)
        rows, expected = self.rows(out), self.rows(single)
        self.assertEqual([row["log"] for row in rows],
                         [row["log"] for row in expected])
        merged = (out / "summary.yaml").read_text()
        for row, other in zip(rows, expected):
            results = row["result"], other["result"]
            self.assertEqual({**row, "result": ""}, {**other, "result": ""})
            if row["reason"]:
                continue
            self.assertEqual((out / results[0]).read_bytes(),
                             (self.folder / results[1]).read_bytes())
            merged = merged.replace(f"result: {results[0]}\n",
                                    f"result: {results[1]}\n")
        self.assertEqual(merged, (single / "summary.yaml").read_text())

    def times(self, pattern):
        return {str(path.relative_to(self.out)): path.stat().st_mtime_ns
                for path in self.out.glob(pattern)}

    def changed(self, pattern, before):
        """Files that were written since times(pattern) gave `before`."""
        return sorted(name for name, time in self.times(pattern).items()
                      if before.get(name) != time)


def main(programs=("snakemake",)):
    os.environ["PATH"] += ":/usr/sbin"
    for program in programs:
        if shutil.which(program) is None:
            print(f"skipped: {program} is not installed")
            sys.exit(SKIPPED)
    unittest.main()
