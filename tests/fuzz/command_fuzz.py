#!/usr/bin/python3
"""Runs every tool on small inputs that are mutated at random: command_fuzz.py [COUNT [SEED [TOOL...]]].

A finding is a signal, a traceback, an exit code outside 0 to 4 and 130, 10 s of CPU or 1 GB. Each lies with its
command in out/fuzz/findings/<tool>-<seed>-<number>; exit code 1 if there is any. A number alone decides an input,
so `--only NUMBER` repeats one. Calibrations of valid rows may take longer, so a slow one is listed apart. Tools in
Python run in processes that preloaded.py forks, but for one of 41.
"""

import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time

sys.dont_write_bytecode = True
SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(SOURCE / "tests/apps"), str(SOURCE / "tests/import"), str(SOURCE / "tests/design")]

import dxf_finger_test
import good_inputs
import samples  # the good recordings of all formats
from mutations import mutated, mutated_flag

BINARIES = pathlib.Path(os.environ.get("FINRAY_BINARY_DIR", ".")).resolve()
SECONDS, BYTES, PATIENCE_S = 10, 1 << 30, 60
ADDRESSES = 8 << 30  # bounds a run that would take all memory
CODES = (0, 1, 2, 3, 4, 130)
CALIBRATES = ("calibrate", "plan", "design", "validate")
PYTHON, REAL = ("import", "convert"), 41
# Inputs of a tool for each one of a tool that is not here: those with more readers, and those that take less time, have more.
SHARE = {"import": 6, "estimate": 3, "simulate": 3, "convert": 2, "validate": 2, "view": 2, "zero": 2, "reconstruct": 2,
         "compliance": 2, "compare": 2}
FINDINGS = pathlib.Path("out/fuzz/findings")

RIG_MAPPING = b"""columns: {time_s: time_s, gauge_1_V: gauge_1_V, gauge_2_V: gauge_2_V, force_N: force_N}
"""


def drawing():
    """The outline of the paper's finger as lines in a DXF file."""
    lines = (line for loop in dxf_finger_test.contours() for line in zip(loop, [*loop[1:], loop[0]]))
    return ("0\nSECTION\n2\nENTITIES\n" + "".join(
        f"0\nLINE\n8\n0\n10\n{a[0]:.9g}\n20\n{a[1]:.9g}\n11\n{b[0]:.9g}\n21\n{b[1]:.9g}\n" for a, b in lines)
        + "0\nENDSEC\n0\nEOF\n").encode()


def recordings():
    """{name: bytes} of a recording in every format that this machine can write."""
    with tempfile.TemporaryDirectory() as folder:
        for ending in ("npz", "mat", "mat4", "hdf5", "mat73", "xlsx", "parquet"):
            name = {"mat4": "four.mat", "mat73": "seven.mat", "hdf5": "rec.h5"}.get(ending, f"rec.{ending}")
            try:
                getattr(samples, f"write_{ending}")(os.path.join(folder, name))
            except ImportError:
                continue
        for name, write in samples.BAGS.items():
            try:
                write(pathlib.Path(folder, f"rec_{name.replace('.', '_')}.{name.rpartition('.')[2]}"))
            except ImportError:
                continue
        found = {p.name: p.read_bytes() for p in sorted(pathlib.Path(folder).iterdir())}
    found["rec.csv"] = samples.csv_text(samples.readings()).encode()
    return found


def benchmark():
    """A small result of finray_benchmark, twice, to compare."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([BINARIES / "finray_benchmark", *"--quick --only forward/no_contact/default --report=false --out_dir".split(),
                        folder], check=True, capture_output=True)
        result = pathlib.Path(folder, "benchmark.json").read_bytes()
    return {"a.json": result, "b.json": result}, "--compare a.json,b.json"


def tools():
    """{tool: [(files, arguments)]}: the good inputs. Files that a run only reads once are pipes of stdin."""
    found = {tool: [case] for tool, case in good_inputs.APPS.items()}
    finger, scene, plan, log = good_inputs.FINGER, good_inputs.SCENE, good_inputs.PLAN, good_inputs.LOG
    files, arguments = found["reconstruct"][0]
    found["reconstruct"] = [({**files, "log.csv": b"".join(files["log.csv"].splitlines(True)[:15])}, arguments)]
    found["simulate"].append((
        {"finger.yaml": finger, "scene.yaml": scene,
         "in.csv": b"object_x_mm,object_y_mm,object_angle_deg\n-10,60,0\n-12,90,10\n"},
        "--finger finger.yaml --scene scene.yaml --frames in.csv --out out --log_out log.csv --shape_out shape.csv"))
    found["estimate"].append(({"finger.yaml": finger, "stdin": log}, "--follow --finger finger.yaml"))
    found["estimate"].append((
        {"finger.yaml": finger, "scene.yaml": b"contacts: 1\nsmoothing: {contact_std_mm: 1, normal_std_N: 0.2}\n"
         b"gauge_offset_walk: {start_std_V: 0.001, std_V_per_sqrt_s: 0.0001}\n", "log.csv": log},
        "--finger finger.yaml --scene scene.yaml --logs log.csv --out_dir out --joint --report"))
    rows = log.replace(b",", b";").replace(b".", b",").splitlines(True)
    found["estimate"].append((
        {"finger.yaml": finger, "log.csv": b"recorded by hand\n" + rows[0].replace(b"force_N", b"Fz [mN]") + b"".join(rows[1:]),
         "scene.yaml": b"columns: {'Fz [mN]': force_N, gauge_1_V: {to: gauge_1_V, unit: mV, scale: -1}}\n"
         b"not_measured: [OVLD]\nmost_contacts: 1\nfriction_coefficient: 0.3\n"},
        "--finger finger.yaml --scene scene.yaml --logs log.csv --out_dir out --bad_rows skip --keep_going"))
    if (BINARIES / "finray_benchmark").exists():
        found["benchmark"] = [benchmark()]
    found["check"] = [({"finger.yaml": finger}, "--finger finger.yaml --out out.svg")]
    found["zero"] = [({"finger.yaml": finger, "log.csv": b"gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V\n"
                       + b"0.001,0.002,0.001,-0.001\n0.0012,0.0021,0.0011,-0.0011\n" * 5},
                      "--finger finger.yaml --logs log.csv --out out.yaml --zero_rows 1:6")]
    found["design"] = [({"finger.yaml": finger}, "--finger finger.yaml --out_dir out --gauges 3"),
                       ({"outline.dxf": drawing()},
                        "--dxf outline.dxf --width_mm 20 --youngs_modulus_GPa 2.1 --gauges 2 --out_dir out")]
    found["plan"] = [({"finger.yaml": finger, "plan.yaml": plan},
                      "--finger finger.yaml --plan plan.yaml --x_mm -20:5 --y_mm 30:100 --force_max_N 5"
                      " --target_force_N 0.1 --most_frames 20 --out_dir out")]
    found["convert"] = [({"finger.yaml": finger, "plan.yaml": plan}, "--files finger.yaml,plan.yaml --out_dir out")]
    mapping = {"bag": samples.BAG_MAPPING.encode(), "mcap": samples.BAG_MAPPING.encode(), "db3": samples.BAG_MAPPING.encode()}
    found["import"] = [({name: data, "mapping.yaml": mapping.get(name.rpartition(".")[2], RIG_MAPPING)},
                        f"--logs {name} --mapping mapping.yaml --out out.csv") for name, data in recordings().items()]
    still = [f"{i / 20:.2f},{0.01 * (i // 20):.3f},{-0.02 * (i // 20) + 1e-4 * (i % 3):.4f}" for i in range(80)]
    force = [f"{1000 + i / 10:.2f};{0.5 * (i // 10):.2f};{0.1 * (i // 10):.2f}" for i in range(42)]
    found["import"].append((
        {"gauges.csv": "\n".join(["t,g1,g2", "s,V,V", *still, ""]).encode(),
         "rig.csv": "\n".join(["time [s];Fx [N];Fy [N]", *force, ""]).replace(".", ",").encode(),
         "mapping.yaml": b"columns: {t: time_s, g1: gauge_1_V, g2: gauge_2_V}\ntables:\n  rig.csv:\n    columns: {'time [s]': time_s,"
         b" 'Fx [N]': force_x_N, 'Fy [N]': force_y_N}\n    time_offset_s: -1000\n"},
        "--logs gauges.csv,rig.csv --mapping mapping.yaml --out out.csv --plateaus --force_bias_N 0:0"))
    found["import"].append(({"rec.csv": samples.csv_text(samples.readings()).encode()}, "--logs rec.csv"))
    return found


def case_of(number, seed, names, all_tools):
    """(tool, files, arguments) of an input."""
    rng = random.Random(f"{seed}/{number}")
    tool = names[number % len(names)]
    files, arguments = rng.choice(all_tools[tool])
    files = dict(files)
    if rng.random() < 0.05:
        arguments = mutated_flag(arguments, rng)
    else:
        name = rng.choice(sorted(files))
        files[name] = mutated(files[name], rng)
        if rng.random() < 0.1:
            name = rng.choice(sorted(files))
            files[name] = mutated(files[name], rng)
    return tool, files, arguments


class Preloaded:
    """Runs of finray's scripts in processes that preloaded.py forks; for one thread."""

    def __init__(self):
        self.server = subprocess.Popen(["/usr/bin/python3", "-B", SOURCE / "tests/fuzz/preloaded.py"], text=True,
                                       stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def start(self, tool, arguments, folder):
        """The process of a run."""
        run = {"script": str(SOURCE / f"apps/finray_{tool}"), "arguments": arguments.split(), "folder": str(folder),
               "bytes": ADDRESSES}
        print(json.dumps(run), file=self.server.stdin, flush=True)
        return int(self.server.stdout.readline())

    def wait(self, _):
        """(status, seconds of CPU, kB) of the process that was started, once it ended."""
        return json.loads(self.server.stdout.readline())


class Real:
    """Runs of the executables themselves."""

    def start(self, tool, arguments, folder):
        limits = lambda: resource.setrlimit(resource.RLIMIT_AS, (ADDRESSES, ADDRESSES))
        piped = folder / "stdin"
        with open(piped if piped.exists() else os.devnull, "rb") as stdin, open(folder / ".stdout", "wb") as out, \
                open(folder / ".stderr", "wb") as err:
            process = subprocess.Popen([BINARIES / f"finray_{tool}", *arguments.split()], cwd=folder, stdin=stdin,
                                       stdout=out, stderr=err, preexec_fn=limits)
        process.returncode = 0  # wait() waits for it
        return process.pid

    def wait(self, process):
        _, status, usage = os.wait4(process, 0)
        return status, usage.ru_utime + usage.ru_stime, usage.ru_maxrss


OF_THREAD = threading.local()


def way_to_run(tool, number):
    if tool not in PYTHON or number % REAL == 0:
        return Real()
    if not hasattr(OF_THREAD, "preloaded"):
        OF_THREAD.preloaded = Preloaded()
    return OF_THREAD.preloaded


def run(way, tool, files, arguments, folder):
    """(exit code or None after PATIENCE_S, seconds of CPU, bytes, stdout, stderr). The calling thread waits."""
    for name, data in files.items():
        (folder / name).write_bytes(data)
    process = way.start(tool, arguments, folder)
    late = threading.Timer(PATIENCE_S, os.kill, (process, signal.SIGKILL))
    late.start()
    status, seconds, size = way.wait(process)
    timed_out = late.finished.is_set()
    late.cancel()
    code = None if timed_out else os.waitstatus_to_exitcode(status)
    return code, seconds, size << 10, (folder / ".stdout").read_bytes(), (folder / ".stderr").read_bytes()


def judged(number, seed, names, all_tools):
    tool, files, arguments = case_of(number, seed, names, all_tools)
    folder = pathlib.Path(tempfile.mkdtemp(prefix="finray_fuzz_"))
    try:
        code, seconds, size, out, err = run(way_to_run(tool, number), tool, files, arguments, folder)
        faults = []
        if code is None:
            faults.append(f"no end after {PATIENCE_S} s")
        elif code < 0:
            faults.append(f"signal {-code}")
        elif code not in CODES:
            faults.append(f"exit code {code}")
        if b"Traceback" in err + out:
            faults.append("traceback " + err.decode(errors="replace").strip().rpartition("\n")[2][:120])
        if code in (1, 2) and not err.strip():
            faults.append(f"exit code {code} without a word")
        if seconds > SECONDS and code is not None:
            faults.append(f"{seconds:.0f} s" + (" of a calibration" if tool in CALIBRATES else ""))
        if size > BYTES:
            faults.append(f"{size / 1e9:.1f} GB")
        if faults:
            kept = FINDINGS / f"{tool}-{seed}-{number}"
            shutil.rmtree(kept, ignore_errors=True)
            shutil.copytree(folder, kept)
            (kept / "command").write_text(f"finray_{tool} {arguments}\n")
        return tool, number, code, seconds, faults, arguments
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("count", nargs="?", type=int, default=200)
    parser.add_argument("seed", nargs="?", type=int, default=1)
    parser.add_argument("tools", nargs="*")
    parser.add_argument("--only", type=int)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    flags = parser.parse_args()
    all_tools = tools()
    unknown = set(flags.tools) - set(all_tools)
    if unknown:
        parser.error(f"no such tool: {' '.join(unknown)}; known are {' '.join(all_tools)}")
    names = flags.tools or [tool for tool in sorted(all_tools) for _ in range(SHARE.get(tool, 1))]
    FINDINGS.mkdir(parents=True, exist_ok=True)
    numbers = range(flags.count) if flags.only is None else [flags.only]
    start, found = time.monotonic(), 0
    codes, runs, cpu = collections.Counter(), collections.Counter(), collections.Counter()
    with concurrent.futures.ThreadPoolExecutor(flags.jobs) as pool:
        for tool, number, code, seconds, faults, arguments in pool.map(
                lambda n: judged(n, flags.seed, names, all_tools), numbers):
            codes[code] += 1
            runs[tool] += 1
            cpu[tool] += seconds
            if faults:
                found += not all("of a calibration" in fault for fault in faults)
                print(f"{tool} {number}: {', '.join(faults)}  (finray_{tool} {arguments})", flush=True)
    print("; ".join(f"{tool} {runs[tool]} in {cpu[tool]:.0f} s" for tool in sorted(runs)))
    counts = ", ".join(f"{n} with {code}" for code, n in sorted(codes.items(), key=str))
    print(f"{len(numbers)} inputs of seed {flags.seed} in {time.monotonic() - start:.0f} s: {counts}; {found} findings")
    return found > 0


if __name__ == "__main__":
    sys.exit(main())
