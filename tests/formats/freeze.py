#!/usr/bin/env python3
"""Writes small files of every format into tests/data/formats/VERSION, once for a release. They never change afterwards.

usage: freeze.py VERSION     (FINRAY_BINARY_DIR: folder of the executables)
"""
import hashlib
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
BINARIES = pathlib.Path(os.environ.get("FINRAY_BINARY_DIR", ROOT / "build/test")).resolve()

SCENE = """# Every key of a scene that does not exclude another.
schema_version: 1
contacts: 1
friction_coefficient: 0.1
force_max_N: 20
search_iteration_limit: 500
object: {shape: circle, radius_mm: 15}
measurements: {object_std_mm: 0.05}
columns:
  U1: gauge_1_V
  U2: {to: gauge_2_V, unit: mV}
  t: {to: time_s, unit: ms}
delimiter: ";"
decimal: "."
not_measured: [OVLD]
"""
MAPPING = """schema_version: 1
columns:
  U1: gauge_1_V
  U2: {to: gauge_2_V, unit: mV}
  t: {to: time_s, unit: ms}
not_measured: [OVLD]
delimiter: ";"
"""
LAB_LOG = "\n".join([
    "# a lab", "t;U1;U2;gauge_3_V;gauge_4_V;object_x_mm;object_y_mm;force_N;note",
    "0;0;0;0;0;-20;70;0;free", "100;-0.00978;13.44;0.0272;0.02307;-12.7;70;2;touch", "200;OVLD;13.44;0.0272;0.02307;-12.7;70;2;"]) + "\n"


def rows(source, count):
    lines = source.read_text().splitlines(keepends=True)
    return "".join(lines[:count + 1])


def run(*command):
    subprocess.run([BINARIES / command[0], *map(str, command[1:])], check=True, stdout=subprocess.DEVNULL, cwd=ROOT,
                   stderr=subprocess.DEVNULL)


def main(version):
    out = ROOT / "tests/data/formats" / version
    if out.exists():
        sys.exit(f"{out} is there; frozen files do not change")
    data = ROOT / "datasets/simulated_r15"
    with tempfile.TemporaryDirectory() as name:
        made = pathlib.Path(name)
        shutil.copy(ROOT / "configs/fingers/paper_140mm_eight_gauges.yaml", made / "drawn_finger.yaml")
        shutil.copy(ROOT / "configs/plans/force_and_circle.yaml", made / "plan.yaml")
        shutil.copy(ROOT / "configs/control/fixed_step.yaml", made / "experiment.yaml")
        (made / "mapping.yaml").write_text(MAPPING)
        (made / "scene.yaml").write_text(SCENE)
        (made / "lab_log.csv").write_text(LAB_LOG)
        (made / "train.csv").write_text(rows(data / "train.csv", 200))
        (made / "log.csv").write_text(rows(data / "holdout.csv", 30))
        (made / "touches.csv").write_text(rows(ROOT / "datasets/touches_square/touches.csv", 40))
        shutil.copy(ROOT / "configs/scenes/pulley.yaml", made / "spring_scene.yaml")
        for trial in ("spring_0.5_1", "spring_0.5_2", "spring_2.0_1", "spring_2.0_2"):
            shutil.copy(ROOT / f"datasets/springs/{trial}.csv", made)
        run("finray_calibrate", "--finger", ROOT / "configs/fingers/paper_140mm.yaml", "--plan", made / "plan.yaml", "--logs",
            made / "train.csv", "--out_dir", made / "calibration", "--leave_one_log_out=false")
        run("finray_estimate", "--finger", made / "calibration/finger.yaml", "--logs", made / "log.csv", "--out_dir",
            made / "estimated", "--digits", "9")
        for folder, kept in (("calibration", {"finger.yaml", "calibration.yaml"}),
                             ("estimated", {"log.frames.csv", "log.summary.yaml", "summary.yaml", "summary.csv"})):
            for path in (made / folder).iterdir():
                if path.name not in kept:
                    path.unlink()
        # No path of this machine in files that stay.
        for path in made.rglob("*.yaml"):
            path.write_text(path.read_text().replace(f"{made}/", "").replace(f"{ROOT}/", ""))
        for path in made.rglob("*.csv"):
            path.write_text(path.read_text().replace(f"{made}/", ""))
        sums = "".join(f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.relative_to(made)}\n"
                       for path in sorted(made.rglob("*")) if path.is_file())
        (made / "SHA256SUMS").write_text(sums)
        shutil.copytree(made, out)
        out.chmod(0o755)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
