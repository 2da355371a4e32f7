#!/usr/bin/python3
"""Does a second thread double the frames/s of a log, as far as the machine lets it?

compare_threads.py BUILD_DIR LOG.csv [RUNS]

Estimates a log of one contact of configs/fingers/paper_140mm.yaml with one
thread, with two threads, and with two processes of one thread side by side,
RUNS times (7) in turn. Prints medians of the seconds by the clock of the whole
command, how many times as many frames/s two threads and two processes have, and
the former over the latter: two processes share nothing but the machine.
"""

import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import guard  # noqa: E402

guard.protect("compare_threads.py", __name__)

ROOT = pathlib.Path(__file__).resolve().parents[2]


def start(build, log, folder, threads):
    return subprocess.Popen(
        [build / "finray_estimate", "--finger", ROOT / "configs/fingers/paper_140mm.yaml", "--scene",
         ROOT / "configs/scenes/one_contact.yaml", "--logs", log, "--out_dir", folder, "--threads", str(threads)],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def seconds(build, log, threads, processes):
    with tempfile.TemporaryDirectory() as folder:
        begin = time.monotonic()
        runs = [start(build, log, f"{folder}/{i}", threads) for i in range(processes)]
        if any([run.wait() for run in runs]):
            sys.exit("finray_estimate failed")
        return time.monotonic() - begin


def main():
    build, log, *runs = guard.words(__doc__, 2, 3)
    build, log = pathlib.Path(build).resolve(), pathlib.Path(log).resolve()
    ways = {"one thread": (1, 1), "two threads": (2, 1), "two processes": (1, 2)}
    times = {way: [] for way in ways}
    for _ in range(int(*runs or [7])):
        for way, (threads, processes) in ways.items():
            times[way].append(seconds(build, log, threads, processes))
    one, two, both = (statistics.median(times[way]) for way in ways)
    for way, own in times.items():
        print(f"{way:14} {statistics.median(own):6.2f} s, {min(own):.2f} to {max(own):.2f}")
    print(f"frames/s, times those of one thread: two threads {one / two:.2f}, two processes {2 * one / both:.2f};"
          f" threads over processes {both / two / 2:.2f}")


if __name__ == "__main__":
    main()
