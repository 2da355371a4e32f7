#!/usr/bin/python3
"""scripts/batch/run interrupted and started again, on this machine."""

import os
import signal

import batch_fixture
from batch_fixture import FRAMES

LOGS = ["d1/a.csv", "d1/b.csv", "d2/a.csv", "d2/b.csv", "d3/a.csv", "d3/b.csv"]


class InterruptTest(batch_fixture.BatchTestCase):
    def setUp(self):
        super().setUp()
        self.write_logs(LOGS, frames=6000)

    def test_killed_and_resumed(self):
        arguments = "--logs_per_task", "2", "--jobs", "2"
        # The runner and Snakemake, their tasks going on.
        process = self.start(*arguments)
        self.wait_for_results(process, 1)
        self.kill_runner(process)
        self.wait_until_ended()
        # All there is.
        process = self.start(*arguments)
        self.wait_for_results(process, 4)
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        process.stdout.close()
        self.wait_until_ended()
        self.assertFalse((self.out / "summary.yaml").exists())
        frames = self.times(FRAMES)
        self.assertGreater(len(frames), 3)
        self.run_batch(*arguments)
        self.expect_equal_to_single()
        self.assertEqual(self.changed(FRAMES, frames),
                         sorted(set(self.times(FRAMES)) - set(frames)))

    def test_interrupt_ends_it_and_says_how_to_go_on(self):
        process = self.start("--logs_per_task", "6")
        self.wait_for_results(process, 1)
        os.killpg(process.pid, signal.SIGINT)
        output, _ = process.communicate()
        self.assertEqual(process.returncode, 130, output)
        self.assertIn("0 of 1 groups are done, 0 failed", output)
        frames = self.times(FRAMES)
        self.run_batch("--logs_per_task", "6")
        self.assertFalse(set(frames) & set(self.changed(FRAMES, frames)))

    def test_second_run_is_told_that_there_is_one(self):
        process = self.start()
        self.wait_for_results(process, 1)
        output = self.run_batch(code=2)
        self.assertIn("another batch is at work there", output)
        output, _ = process.communicate()
        self.assertEqual(process.returncode, 0, output)


if __name__ == "__main__":
    batch_fixture.main()
