#!/usr/bin/python3
"""Runs every tool on small inputs that are mutated at random: command_fuzz.py [COUNT [SEED [TOOL...]]].

A finding is a signal, a traceback, an exit code outside 0 to 4 and 130, 10 s of CPU or 1 GB. Each lies with its
command in out/fuzz/findings/<tool>-<seed>-<number>; exit code 1 if there is any. A number alone decides an input,
so `--only NUMBER` repeats one. Calibrations of valid rows may take longer, so a slow one is listed apart.
"""

import argparse
import concurrent.futures
import gzip
import os
import pathlib
import random
import re
import resource
import shlex
import shutil
import subprocess
import sys
import tempfile
import threading
import time

sys.dont_write_bytecode = True
SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(SOURCE / "tests/apps"), str(SOURCE / "tests/import")]

import hostile_input_test as hostile  # the good inputs of all executables
import samples  # the good recordings of all formats

SECONDS, BYTES, PATIENCE_S = 10, 1 << 30, 60
ADDRESSES = 8 << 30  # bounds a run that would take all memory
CODES = (0, 1, 2, 3, 4, 130)
CALIBRATES = ("calibrate", "plan", "design")
FINDINGS = pathlib.Path("out/fuzz/findings")

RIG_MAPPING = b"""columns: {time_s: time_s, gauge_1_V: gauge_1_V, gauge_2_V: gauge_2_V, force_N: force_N}
"""
DXF = "0\nSECTION\n2\nENTITIES\n" + "".join(
    f"0\nLINE\n8\n0\n10\n{a}\n20\n{b}\n11\n{c}\n21\n{d}\n" for a, b, c, d in (
        (0, 0, 0, 100), (0, 100, 30, 100), (30, 100, 60, 0), (60, 0, 58, 0), (58, 0, 28.5, 98),
        (28.5, 98, 2, 98), (2, 98, 2, 0), (2, 0, 0, 0))) + "0\nENDSEC\n0\nEOF\n"


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


def tools():
    """{tool: [(files, arguments)]}: the good inputs. Files that a run only reads once are pipes of stdin."""
    found = {tool: [case] for tool, case in hostile.APPS.items()}
    finger, scene, plan, log = hostile.FINGER, hostile.SCENE, hostile.PLAN, hostile.LOG
    found["simulate"].append((
        {"finger.yaml": finger, "scene.yaml": hostile.SCENE,
         "in.csv": b"object_x_mm,object_y_mm,object_angle_deg\n-10,60,0\n-12,90,10\n"},
        "--finger finger.yaml --scene scene.yaml --frames in.csv --out out --log_out log.csv --shape_out shape.csv"))
    found["estimate"].append(({"finger.yaml": finger, "stdin": log}, "--follow --finger finger.yaml"))
    found["estimate"].append((
        {"finger.yaml": finger, "scene.yaml": b"contacts: 1\nsmoothing: {contact_std_mm: 1, normal_std_N: 0.2}\n"
         b"gauge_offset_walk: {start_std_V: 0.001, std_V_per_sqrt_s: 0.0001}\n", "log.csv": log},
        "--finger finger.yaml --scene scene.yaml --logs log.csv --out_dir out --joint --report"))
    found["check"] = [({"finger.yaml": finger}, "--finger finger.yaml --out out.svg")]
    found["zero"] = [({"finger.yaml": finger, "log.csv": b"gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V\n"
                       + b"0.001,0.002,0.001,-0.001\n0.0012,0.0021,0.0011,-0.0011\n" * 5},
                      "--finger finger.yaml --logs log.csv --out out.yaml")]
    found["design"] = [({"finger.yaml": finger}, "--finger finger.yaml --out_dir out --gauges 3"),
                       ({"outline.dxf": DXF.encode()},
                        "--dxf outline.dxf --width_mm 20 --youngs_modulus_GPa 2.1 --gauges 2 --out_dir out")]
    found["plan"] = [({"finger.yaml": finger, "plan.yaml": plan},
                      "--finger finger.yaml --plan plan.yaml --x_mm -20:5 --y_mm 30:100 --force_max_N 5"
                      " --target_force_N 0.1 --most_frames 20 --out_dir out")]
    found["convert"] = [({"finger.yaml": finger, "plan.yaml": plan}, "--files finger.yaml,plan.yaml --out_dir out")]
    found["import"] = [({name: data, "mapping.yaml": RIG_MAPPING},
                        f"--logs {name} --mapping mapping.yaml --out out.csv") for name, data in recordings().items()]
    found["import"].append(({"rec.csv": samples.csv_text(samples.readings()).encode()}, "--logs rec.csv --inspect"))
    return found


NUMBERS = [b"0", b"-1", b"1e-320", b"-1e-9", b"1e9", b"1e15", b"-1e18", b"1e18", b"1e155", b"-1e155", b"1e300", b"1e308",
           b"9.9E+37", b"nan", b"inf", b"-inf", b"1e999", b"", b"0x10", b"1,5", b"2147483648", b"1e-30", b"1e30", b"3.7e12",
           b"99999999999999999999", b".inf", b"-0", b"1000000", b"abc", b"'1'", b"[1, 2]", b"{a: 1}", b"~"]
NUMBER = re.compile(rb"-?\d+\.?\d*(?:[eE][-+]?\d+)?")
PIECES = [b"\0", b"\r", b"\n", b"\n\n", b",", b";", b"\t", b'"', b"'", b"[", b"]", b"{", b"}", b": ", b"&a ", b"*a", b"#",
          b"!!binary ", b"- ", b"\xff", b"\xe9", b"\xef\xbb\xbf", b"| ", b"%", b"\x1b[2J", b"<<: ", b"\x1f\x8b"]


def mutated(data, rng):
    """`data` with one to four changes."""
    for _ in range(rng.choice((1, 1, 1, 2, 2, 3, 4))):
        data = rng.choice(CHANGES)(data, rng)
        if len(data) > 400_000:
            return data[:400_000]
    return data


def other_number(data, rng):
    found = list(NUMBER.finditer(data))
    if not found:
        return data
    at = rng.choice(found)
    value = rng.choice(NUMBERS)
    if rng.random() < 0.3:  # a value of the same kind, of any size
        value = b"%g" % (float(at[0]) * 10 ** rng.uniform(-12, 12) * rng.choice((1, 1, -1)))
    return data[:at.start()] + value + data[at.end():]


def all_numbers_of_a_column(data, rng):
    lines = data.split(b"\n")
    column = rng.randrange(max(1, lines[0].count(b",") + 1))
    value = rng.choice(NUMBERS)
    for i in range(1, len(lines)):
        cells = lines[i].split(b",")
        if column < len(cells):
            cells[column] = value
            lines[i] = b",".join(cells)
    return b"\n".join(lines)


def bytes_flipped(data, rng):
    data = bytearray(data)
    for _ in range(rng.choice((1, 1, 2, 8, 64)) if data else 0):
        data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
    return bytes(data)


def piece_inserted(data, rng):
    at = rng.randrange(len(data) + 1)
    return data[:at] + rng.choice(PIECES) * rng.choice((1, 1, 1, 3, 300)) + data[at:]


def cut(data, rng):
    return data[:rng.randrange(len(data) + 1)]


def stretch_removed(data, rng):
    a, b = sorted(rng.randrange(len(data) + 1) for _ in range(2))
    return data[:a] + data[min(b, a + rng.choice((1, 4, 16, 256))):]


def stretch_repeated(data, rng):
    a, b = sorted(rng.randrange(len(data) + 1) for _ in range(2))
    b = min(b, a + rng.choice((4, 64, 512)))
    return data[:b] + data[a:b] * rng.choice((1, 2, 20, 2000)) + data[b:]


def lines_changed(data, rng):
    lines = data.split(b"\n")
    kind = rng.randrange(4)
    i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
    if kind == 0:
        del lines[i]
    elif kind == 1:
        lines.insert(j, lines[i])
    elif kind == 2:
        lines[i], lines[j] = lines[j], lines[i]
    else:
        lines[i:i + 1] = [lines[i]] * rng.choice((3, 50, 3000))
    return b"\n".join(lines)


def words_changed(data, rng):
    words = re.findall(rb"[A-Za-z_]{2,}", data)
    if not words:
        return data
    return data.replace(rng.choice(words), rng.choice((*words, b"", b"contacts", b"ok", b"nan", b"true")),
                        rng.choice((1, -1)))


def packed(data, rng):
    return gzip.compress(data + data[-1:] * rng.choice((0, 0, 5_000_000)), 6)


CHANGES = [other_number] * 6 + [all_numbers_of_a_column] * 3 + [bytes_flipped] * 2 + [
    piece_inserted, cut, stretch_removed, stretch_repeated, lines_changed, lines_changed, words_changed, packed]


def mutated_flag(arguments, rng):
    words = arguments.split()
    numeric = [i for i, word in enumerate(words) if NUMBER.fullmatch(word.encode())]
    if numeric:
        words[rng.choice(numeric)] = rng.choice(NUMBERS).decode("latin-1") or "0"
    else:
        words += rng.choice((["--scheme", "rigid_chain"], ["--scheme", "taylor4"], ["--resolution", "3"],
                             ["--resolution", "100000"], ["--seed", "-1"], ["--threads", "3"]))
    return " ".join(words)


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


def run(tool, files, arguments, folder):
    """(exit code or None after PATIENCE_S, seconds of CPU, bytes, stdout, stderr). The calling thread waits."""
    for name, data in files.items():
        (folder / name).write_bytes(data)
    stdin = open(folder / "stdin", "rb") if "stdin" in files else subprocess.DEVNULL
    limits = lambda: resource.setrlimit(resource.RLIMIT_AS, (ADDRESSES, ADDRESSES))
    with open(folder / ".stdout", "wb") as out, open(folder / ".stderr", "wb") as err:
        process = subprocess.Popen([hostile.BINARIES / f"finray_{tool}", *arguments.split()], cwd=folder, stdin=stdin,
                                   stdout=out, stderr=err, preexec_fn=limits)
        late = threading.Timer(PATIENCE_S, process.kill)
        late.start()
        _, status, usage = os.wait4(process.pid, 0)
        timed_out = not late.is_alive()
        late.cancel()
        process.returncode = status  # waited for
    code = None if timed_out else os.waitstatus_to_exitcode(status)
    return (code, usage.ru_utime + usage.ru_stime, usage.ru_maxrss << 10,
            (folder / ".stdout").read_bytes(), (folder / ".stderr").read_bytes())


def judged(number, seed, names, all_tools):
    tool, files, arguments = case_of(number, seed, names, all_tools)
    folder = pathlib.Path(tempfile.mkdtemp(prefix="finray_fuzz_"))
    try:
        code, seconds, size, out, err = run(tool, files, arguments, folder)
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
    names = flags.tools or sorted(all_tools)
    FINDINGS.mkdir(parents=True, exist_ok=True)
    numbers = range(flags.count) if flags.only is None else [flags.only]
    start, found, codes = time.monotonic(), 0, {}
    with concurrent.futures.ThreadPoolExecutor(flags.jobs) as pool:
        for tool, number, code, seconds, faults, arguments in pool.map(
                lambda n: judged(n, flags.seed, names, all_tools), numbers):
            codes[code] = codes.get(code, 0) + 1
            if faults:
                found += not all("of a calibration" in fault for fault in faults)
                print(f"{tool} {number}: {', '.join(faults)}  (finray_{tool} {arguments})", flush=True)
    counts = ", ".join(f"{n} with {code}" for code, n in sorted(codes.items(), key=str))
    print(f"{len(numbers)} inputs in {time.monotonic() - start:.0f} s: {counts}; {found} findings")
    return found > 0


if __name__ == "__main__":
    sys.exit(main())
