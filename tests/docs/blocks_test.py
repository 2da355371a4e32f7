#!/usr/bin/python3
"""Runs the command blocks (```sh) of README, guides and reference, and compares the output that a page shows behind one.

The blocks of a page run one after the other in a folder of their own, with this tree's configs, datasets and scripts, the
files that pages name without saying where they come from (`F.yaml`, `runs/`, `sensor`, ...), those whose content stands
in the page behind a line that ends with their name (`scene.yaml`:), and the executables of the build. A block that begins with `# not run by the tests: REASON` is left out and counted. An exit code other than 0 must
be named in its block ("exit code 4").

Behind a block, a block without a language is its output, for comparison: each line of it must be printed, in this order.
Words must be the same, numbers within 5 %; times and rates (s, us, frames/s) are not compared.

usage: blocks_test.py [PAGE...]
"""
import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
BINARIES = pathlib.Path(os.environ.get("FINRAY_BINARY_DIR", ROOT / "build/dev")).resolve()
PAGES = ["README.md", "examples/ros2/README.md", *(str(path.relative_to(ROOT)) for shelf in ("guides", "reference")
                                                   for path in sorted((ROOT / "docs" / shelf).glob("*.md")))]
BLOCK = re.compile(r"^```(\w*)\n([\s\S]*?)^```\n(\n*(?=```\n))?", re.M)
NOT_RUN = re.compile(r"\A# not run by the tests: (.+)\n")
BUILDS = re.compile(r"scripts/(demo|test)\b")
FILE = re.compile(r"`(\w+\.(?:yaml|csv))`:\n```(?:yaml|csv|)\n([\s\S]*?)^```", re.M)
COMMAND = re.compile(r"^(\$ |scripts/|finray_\w+ -|sensor \||cmake |pip |sudo |ros2 )", re.M)
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?", re.I)
TIME = re.compile(r"(?<=[\d.]) (s|us|ms|frames/s)\b")
TOLERANCE, PATIENCE_S = 0.05, 1500
RUN = r"""
set -E
trap 'echo "$?	$BASH_COMMAND" >>failed' ERR
for block in blocks/*; do
  : >failed
  . "$block" >"out_${block##*/}" 2>&1 </dev/null
  mv failed "failed_${block##*/}"
done
"""


class Block:
    def __init__(self, text, output, line):
        self.text, self.output, self.line = text, output, line
        found = NOT_RUN.match(text)
        self.reason = found[1] if found else "it installs and builds" if BUILDS.match(text) else None


def blocks_of(page):
    """Command blocks of a page, and the faults of those that look like one."""
    text = (ROOT / page).read_text(encoding="utf-8")
    found, faults, before = [], [], None
    for match in BLOCK.finditer(text):
        language, body, near = match.groups()
        line = text.count("\n", 0, match.start()) + 1
        if language == "sh":
            before = Block(body, None, line)
            found.append(before)
            if near is None:
                before = None
        else:
            if language == "" and before:
                before.output = body
            elif language == "" and COMMAND.search(body):
                faults.append(f"{page}:{line}: commands stand in ```sh blocks")
            before = None
    return found, faults


def calibrated(folder):
    """The text of the bundled finger, calibrated as the guide does it."""
    subprocess.run([BINARIES / "finray_calibrate", "--finger", ROOT / "configs/fingers/paper_140mm.yaml", "--plan",
                    ROOT / "configs/plans/force_and_circle.yaml", "--logs", ROOT / "datasets/simulated_r15/train.csv", "--out_dir",
                    folder, "--report=false", "--leave_one_log_out=false"], check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return (pathlib.Path(folder) / "finger.yaml").read_text()


def fixtures(folder, finger):
    """What pages name without saying where it comes from."""
    for name in ("configs", "datasets", "scripts", "calib", "examples", "CMakeLists.txt"):
        (folder / name).symlink_to(ROOT / name)
    data = ROOT / "datasets/simulated_r15"
    train = (data / "train.csv").read_text().splitlines(keepends=True)
    for name in ("a", "b", "first"):
        rows = train[1:106] if name == "a" else train[106:]
        (folder / f"{name}.csv").write_text(train[0] + "".join(rows))
    for name in ("c", "other"):
        shutil.copy(data / "holdout.csv", folder / f"{name}.csv")
    shutil.copy(ROOT / "configs/fingers/paper_140mm.yaml", folder / "nominal.yaml")
    shutil.copy(ROOT / "configs/plans/force_and_circle.yaml", folder / "P.yaml")
    shutil.copy(ROOT / "configs/scenes/auto.yaml", folder / "S.yaml")
    shutil.copy(ROOT / "configs/control/fixed_step.yaml", folder / "E.yaml")
    shutil.copy(ROOT / "configs/control/fixed_harmonic.yaml", folder / "E2.yaml")
    shutil.copy(ROOT / "datasets/touches_square/touches.csv", folder)
    (folder / "springs").symlink_to(ROOT / "datasets/springs")
    for name in ("F.yaml", "D/finger.yaml", "cal/finger.yaml", "old/finger.yaml", "today.yaml"):
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(finger)
    for name in ("A", "B"):
        shutil.copytree(ROOT / "tests/data/formats/1.0/calibration", folder / name)
    (folder / "E").mkdir()
    shutil.copy(ROOT / "tests/data/formats/1.0/estimated/log.frames.csv", folder / "E/a.frames.csv")
    (folder / "old/scene.yaml").write_text("contacts: 1\n")
    holdout = (data / "holdout.csv").read_text().splitlines(keepends=True)
    free = ",".join(["0.0377", "-0.0311", "0.0238", "-0.0698"])
    (folder / "free.csv").write_text("time_s,gauge_1_V,gauge_2_V,gauge_3_V,gauge_4_V,force_N\n" +
                                     "".join(f"{0.01 * i:.2f},{free},0\n" for i in range(250)))
    (folder / "in.csv").write_text("contact_1_mm,normal_1_N\n70,2\n")
    runs = folder / "runs/monday"
    runs.mkdir(parents=True)
    for place in (folder / "runs", runs):
        for name in ("a", "b"):
            (place / f"{name}{'2' if place == runs else ''}.csv").write_text("".join(holdout[:31]))
    tools = folder / "tools"
    tools.mkdir()
    for name, text in (("sensor", f"exec cat {folder}/free.csv"), ("consumer", "exec cat >/dev/null")):
        (tools / name).write_text(f"#!/bin/sh\n{text}\n")
        (tools / name).chmod(0o755)
    return tools


def words(line):
    """A line as words with # for numbers, the numbers, and which of them are times."""
    numbers, timed = [], []
    for match in NUMBER.finditer(line):
        numbers.append(float(match[0]))
        timed.append(bool(TIME.match(line, match.end())))
    return re.sub(r"\s+", " ", NUMBER.sub("#", line)).strip(), numbers, timed


def same(shown, found):
    (words_a, numbers_a, timed), (words_b, numbers_b, _) = words(shown), words(found)
    return words_a == words_b and all(
        t or math.isclose(a, b, rel_tol=TOLERANCE, abs_tol=1e-12) for a, b, t in zip(numbers_a, numbers_b, timed))


def missing_line(shown, found):
    """The first line of the shown output that is not printed where it should be, or None."""
    rest = iter(found.splitlines())
    for line in shown.splitlines():
        if line.strip() in ("", "..."):
            continue
        if not any(same(line, printed) for printed in rest):
            return line
    return None


def run_page(page, blocks, folder, finger):
    """Faults of a page's blocks."""
    tools = fixtures(folder, finger)
    for name, text in FILE.findall((ROOT / page).read_text(encoding="utf-8")):
        (folder / name).write_text(text)
    (folder / "blocks").mkdir()
    for number, block in enumerate(blocks):
        (folder / f"blocks/{number:02}").write_text(block.text)
    environment = {**os.environ, "PATH": f"{tools}:{BINARIES}:{os.environ['PATH']}", "MPLBACKEND": "Agg", "LC_ALL": "C.UTF-8"}
    shell = subprocess.Popen(["bash", "-c", RUN], cwd=folder, env=environment, stdin=subprocess.DEVNULL, start_new_session=True)
    try:
        shell.wait(PATIENCE_S)
    except subprocess.TimeoutExpired:
        os.killpg(shell.pid, signal.SIGKILL)  # with all that it has started
        shell.wait()
        return [f"{page}: its blocks take more than {PATIENCE_S} s"]
    faults = []
    for number, block in enumerate(blocks):
        place = f"{page}:{block.line}"
        try:
            printed = (folder / f"out_{number:02}").read_text(errors="replace")
            failed = (folder / f"failed_{number:02}").read_text()
        except OSError:
            faults.append(f"{place}: an earlier block has ended the shell")
            break
        for line in failed.splitlines():
            code, _, command = line.partition("\t")
            if not command.startswith(". ") and f"exit code {code}" not in block.text.lower():
                faults.append(f"{place}: exit code {code}: {command}\n{printed[-1500:]}")
        if block.output is not None and (line := missing_line(block.output, printed)) is not None:
            faults.append(f"{place}: shown, but not printed: {line}\n{printed[-2500:]}")
    return faults


def main(pages):
    faults, ran, compared, left_out = [], 0, 0, []
    with tempfile.TemporaryDirectory() as folder:
        finger = calibrated(folder)
    for page in pages or PAGES:
        blocks, wrong = blocks_of(page)
        faults += wrong
        left_out += [f"{page}:{block.line}: {block.reason}" for block in blocks if block.reason]
        blocks = [block for block in blocks if not block.reason]
        if not blocks:
            continue
        with tempfile.TemporaryDirectory() as folder:
            faults += run_page(page, blocks, pathlib.Path(folder), finger)
        ran += len(blocks)
        compared += sum(block.output is not None for block in blocks)
    print(f"{ran} command blocks ran, {compared} with their output compared; {len(left_out)} are not run:")
    print(*(f"  {line}" for line in left_out), sep="\n")
    print(*faults, sep="\n", end="\n" if faults else "")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
