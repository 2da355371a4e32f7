#!/usr/bin/python3
"""Compares the rate of finray.estimate with that of the C++ library, in pairs of one run.

python_speed.py BUILD_DIR [FRAMES] [ROUNDS]

Both estimate the same frames, in memory, on one and on two threads; Python also makes its columns. Prints frames per
second and the ratio, medians over pairs. On a machine with other work the ratio by processor time is the steadier one.
"""

import pathlib
import subprocess
import sys
import time
import warnings

BUILD = pathlib.Path(sys.argv[1]).resolve()
FRAMES = int(sys.argv[2]) if len(sys.argv) > 2 else 100_000
ROUNDS = int(sys.argv[3]) if len(sys.argv) > 3 else 5
sys.path.insert(0, str(BUILD / "python"))

import numpy as np  # noqa: E402

import finray  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
FINGER = ROOT / "datasets/simulated_r15/hidden_finger.yaml"


def main():
    warnings.simplefilter("ignore", finray.FinrayWarning)
    finger, scene = finray.Finger.read(FINGER), finray.Scene(contacts=1)
    # A smooth log, as a lab records it.
    t = np.linspace(0, 2 * np.pi * FRAMES / 1000, FRAMES)
    loads = {"contact_1_mm": 65 + 30 * np.sin(t), "normal_1_N": 2 + 1.5 * np.sin(3 * t + 1)}
    few = {name: values[:1000] for name, values in loads.items()}
    seen = finray.simulate(finger, few)
    noise = np.random.default_rng(1)
    log = {f"gauge_{j}_V": np.resize(seen[f"gauge_{j}_V"], FRAMES) + 3e-4 * noise.standard_normal(FRAMES)
           for j in range(1, 5)}
    raw = BUILD / "python_speed.bin"
    np.stack([log[f"gauge_{j}_V"] for j in range(1, 5)]).tofile(raw)

    for threads in (1, 2):
        estimator = finray.Estimator(finger, scene, threads=threads)
        worker = subprocess.Popen([BUILD / "estimate_rate", FINGER, raw, str(FRAMES), str(threads)],
                                  stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        rounds = []
        for _ in range(ROUNDS + 1):
            worker.stdin.write("go\n")
            worker.stdin.flush()
            clock, busy = (float(word) for word in worker.stdout.readline().split())
            begin, begin_busy = time.perf_counter(), time.process_time()
            found = estimator.estimate(log)
            rounds.append((time.perf_counter() - begin, clock, time.process_time() - begin_busy, busy))
            assert len(found.codes) == FRAMES
        worker.stdin.close()
        worker.wait()
        rounds = np.array(rounds[1:])  # the first round makes the solvers
        python, cpp, python_busy, cpp_busy = rounds.T
        print(f"{threads} thread{'s' * (threads > 1)}: Python {FRAMES / np.median(python):.0f}, "
              f"C++ {FRAMES / np.median(cpp):.0f} frames/s, ratio {np.median(cpp / python):.3f} by the clock, "
              f"{np.median(cpp_busy / python_busy):.3f} by processor time")
    raw.unlink()


if __name__ == "__main__":
    main()
