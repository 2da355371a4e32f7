#!/usr/bin/python3
"""Compares the rate of finray.estimate with that of the C++ library, in pairs of one run.

python_speed.py [FRAMES [ROUNDS]]

Both estimate the same frames, in memory, on one and on two threads; Python also makes its columns. Prints frames per
second and the ratio, medians over pairs. On a machine with other work the ratio by processor time is the steadier one.
The C++ side is compiled here against the installed libfinray-dev. For an installation in a folder of your own set
PYTHONPATH and PKG_CONFIG_PATH.
"""

import pathlib
import subprocess
import sys
import tempfile
import time
import warnings

import numpy as np

import finray

FRAMES = int(sys.argv[1]) if len(sys.argv) > 1 else 100_000
ROUNDS = int(sys.argv[2]) if len(sys.argv) > 2 else 5
GAUGES = [f"gauge_{j}_V" for j in range(1, 5)]


def build(folder):
    """The C++ side, and the library that it and Python have loaded."""
    def pkg_config(*arguments):
        return subprocess.check_output(["pkg-config", *arguments, "finray"], text=True).split()

    program = folder / "estimate_rate"
    subprocess.run(["g++", "-std=c++17", "-O2", pathlib.Path(__file__).with_name("estimate_rate.cc"), "-o", program,
                    *pkg_config("--cflags", "--libs"), "-Wl,-rpath," + pkg_config("--variable=libdir")[0]], check=True)
    linked = [line.split()[2] for line in subprocess.check_output(["ldd", program], text=True).splitlines()
              if "libfinray.so" in line]
    loaded = {line.split()[-1] for line in open("/proc/self/maps", encoding="utf-8") if "libfinray.so" in line}
    library = {pathlib.Path(path).resolve() for path in [*linked, *loaded]}
    if len(library) != 1:
        sys.exit(f"Python and C++ do not use one library: {sorted(map(str, library))}")
    print("both use", library.pop())
    return program


def log_of(finger):
    """A smooth log of the finger's gauges, as a lab records it."""
    t = np.linspace(0, 2 * np.pi * FRAMES / 1000, FRAMES)[:1000]
    seen = finray.simulate(finger, {"contact_1_mm": 65 + 30 * np.sin(t), "normal_1_N": 2 + 1.5 * np.sin(3 * t + 1)})
    noise = np.random.default_rng(1)
    return {name: np.resize(seen[name], FRAMES) + 3e-4 * noise.standard_normal(FRAMES) for name in GAUGES}


def compare(program, folder, finger, log, threads):
    """Seconds by the clock and of the processor in Python and in C++, a row a pair."""
    estimator = finray.Estimator(finger, finray.Scene(contacts=1), threads=threads)
    worker = subprocess.Popen([program, folder / "finger.yaml", folder / "gauges.bin", str(FRAMES), str(threads)],
                              stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    for pair in range(ROUNDS + 1):
        worker.stdin.write("go\n")
        worker.stdin.flush()
        cpp = [float(word) for word in worker.stdout.readline().split()]
        begin, begin_busy = time.perf_counter(), time.process_time()
        found = estimator.estimate(log)
        python = [time.perf_counter() - begin, time.process_time() - begin_busy]
        assert len(found.codes) == FRAMES
        if pair:  # the first one makes the solvers
            yield python + cpp
    worker.stdin.close()
    worker.wait()


def main():
    warnings.simplefilter("ignore", finray.FinrayWarning)
    finger = finray.paper_finger()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        program = build(folder)
        finger.write(folder / "finger.yaml")
        log = log_of(finger)
        np.stack([log[name] for name in GAUGES]).tofile(folder / "gauges.bin")
        for threads in (1, 2):
            python, python_busy, cpp, cpp_busy = np.array(list(compare(program, folder, finger, log, threads))).T
            print(f"{threads} thread{'s' * (threads > 1)}: Python {FRAMES / np.median(python):.0f}, "
                  f"C++ {FRAMES / np.median(cpp):.0f} frames/s, ratio {np.median(cpp / python):.3f} by the clock, "
                  f"{np.median(cpp_busy / python_busy):.3f} by processor time")


if __name__ == "__main__":
    main()
