"""The finger of CalculiX in finray's equations."""

import json
import pathlib

import yaml

from outcome import rows, run

DATA = pathlib.Path(__file__).resolve().parents[2] / "datasets" / "reality"


def beam_model(build, plant, name, scene, header, table, folder, one_piece=None):
    """Rows of finray_simulate for the plant's finger. one_piece: the share of its joints
    that is rigid, if it is a one-piece finger whose ribs bend."""
    drawing = yaml.safe_load((DATA / name / "finger.yaml").read_text("utf-8"))
    drawing["beams"] = {side: {"bending_stiffness_N_mm2": plant.stiffness(side)} for side in plant.thickness}
    if one_piece is not None:
        drawing.update(plant.one_piece(one_piece))
    (folder / "finger.yaml").write_text(json.dumps(drawing))  # JSON is YAML
    (folder / "scene.yaml").write_text(json.dumps(scene))
    (folder / "in.csv").write_text("\n".join([header, *(",".join(f"{x:.12g}" for x in row) for row in table), ""]))
    run(build, "finray_simulate", "--finger", folder / "finger.yaml", "--scene", folder / "scene.yaml",
        "--frames", folder / "in.csv", "--out", folder / "out.csv")
    return rows(folder / "out.csv")


def readings(row, plant):
    return [float(row[f"gauge_{j}_rad"]) for j in range(1, len(plant.gauges) + 1)]


def difference(found, expected):
    """The largest difference over the largest expected value, in percent."""
    return 100 * max(abs(a - b) for a, b in zip(found, expected)) / max(map(abs, expected))


def bundled(build, plant, logs, folder, rigid_share):
    """Of each touch in datasets/reality/printed: load in N, and by how much the gauges differ from
    finray_simulate's under the same contact, in percent of the largest. logs: their truths."""
    found = []
    for path in logs:
        truth = [row for row in rows(path) if row["normal_1_N"]]
        keys = ("contact_1_mm", "normal_1_N", "friction_1")
        simulated = beam_model(build, plant, "printed", {"contacts": 1}, ",".join(keys),
                               [[float(row[key]) for key in keys] for row in truth], folder, rigid_share)
        found += [(float(true["normal_1_N"]), difference(readings(row, plant), readings(true, plant)))
                  for row, true in zip(simulated, truth, strict=True)]
    return found
