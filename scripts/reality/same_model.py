"""The control: logs of the same touches from finray's own equations, so that what
differs from CalculiX's logs is physics alone."""

import csv
import json
import tempfile
import pathlib

from make_logs import FORCE_STD_N, OBJECT_STD_MM
from outcome import rows, run
from touch import RADIUS_MM


def make(build, plant, finger, source, out):
    """finger: the drawing as text, its beams and gauges replaced by the plant's.
    Writes {train,holdout}.csv and truth from the places of the circle in `source`."""
    out.mkdir(parents=True, exist_ok=True)
    true = {**finger, "beams": {side: {"bending_stiffness_N_mm2": plant.stiffness(side)} for side in plant.thickness},
            "gauges": [vars(gauge) for gauge in plant.gauges]}
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "finger.yaml").write_text(json.dumps(true))  # JSON is YAML
        (folder / "scene.yaml").write_text(
            f"object: {{shape: circle, radius_mm: {RADIUS_MM + plant.thickness['front'] / 2}}}\n")
        for seed, log in enumerate(("train", "holdout"), 51):
            with open(folder / "frames.csv", "w", newline="", encoding="utf-8") as file:
                writer = csv.writer(file)
                writer.writerow(["time_s", "object_x_mm", "object_y_mm"])
                writer.writerows([row["time_s"], row["object_x_mm"], row["object_y_mm"]]
                                 for row in rows(source / f"{log}_truth.csv"))
            run(build, "finray_simulate", "--finger", folder / "finger.yaml", "--scene", folder / "scene.yaml",
                "--frames", folder / "frames.csv", "--out", out / f"{log}_truth.csv", "--log_out", out / f"{log}.csv",
                "--force_std_N", FORCE_STD_N, "--object_std_mm", OBJECT_STD_MM, "--seed", seed)
