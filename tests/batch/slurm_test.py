#!/usr/bin/python3
"""scripts/batch/run --slurm on a Slurm of one node, started here."""

import os
import subprocess

import batch_fixture
from batch_fixture import FRAMES, SCRIPTS

LOGS = ["d1/a.csv", "d1/b.csv", "d2/a.csv", "d2/b.csv", "d3/a.csv", "d3/b.csv"]
ARGUMENTS = "--logs_per_task", "2"


class SlurmTest(batch_fixture.BatchTestCase):
    def setUp(self):
        super().setUp()
        slurm = str(self.folder / "slurm")
        self.addCleanup(subprocess.run, [SCRIPTS / "single_node_slurm", "stop", slurm],
                        check=True)
        subprocess.run([SCRIPTS / "single_node_slurm", "start", slurm], check=True,
                       stdout=subprocess.DEVNULL)
        os.environ["SLURM_CONF"] = slurm + "/slurm.conf"

    def running(self):
        return subprocess.run(["squeue", "--noheader", "--states=RUNNING",
                               "--format=%i"], text=True, check=True,
                              stdout=subprocess.PIPE).stdout.split()

    def test_killed_cancelled_and_resumed_gives_the_bytes_of_a_local_run(self):
        self.write_logs(LOGS, frames=6000)
        process = self.start("--slurm", *ARGUMENTS)
        self.wait_for_results(process, 1)
        self.kill_runner(process)
        # One job is lost, the others go on and are found again.
        subprocess.run(["scancel", *self.running()[:1]], check=True)
        process = self.start("--slurm", *ARGUMENTS)
        self.wait_for_results(process, 3)
        subprocess.run(["scancel", *self.running()[:1]], check=True)
        output, _ = process.communicate()
        self.assertEqual(process.returncode, 0, output)
        self.assertIn("in 6 logs, 3 groups", output)
        self.expect_equal_to_single()

        self.run_batch(*ARGUMENTS, out="local")
        local = self.folder / "local"
        for path in [*local.glob("*.*"), *local.glob("groups/**/*.*")]:
            # What a task says has its time in it.
            if path.is_file() and path.suffix != ".log":
                other = self.out / path.relative_to(local)
                self.assertEqual(path.read_bytes(), other.read_bytes(), path)


if __name__ == "__main__":
    batch_fixture.main(("snakemake", "munged", "slurmctld", "slurmd"))
