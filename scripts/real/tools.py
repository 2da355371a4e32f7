"""Runs the command line tools in folders of their own."""

import csv
import pathlib
import sys

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "scripts" / "reality"))

from outcome import Failed, number, rows, run  # noqa: E402,F401


def write_table(path, table):
    names = list(dict.fromkeys(name for row in table for name in row))
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, names, restval="")
        writer.writeheader()
        writer.writerows(table)
    return path


def write_yaml(path, content):
    path.write_text(yaml.safe_dump({"schema_version": 1, **content}, sort_keys=False), "utf-8")
    return path


class Calibration:
    """What finray_calibrate made of some logs."""

    def __init__(self, folder, content):
        self.finger, self.content = folder / "finger.yaml", content
        self.values = {p["name"]: p["value"] for p in content["parameters"]}
        self.std = {p["name"]: p["std"] for p in content["parameters"]}


class Tools:
    def __init__(self, build, out):
        self.build, self.out = build, out

    def folder(self, name):
        path = self.out / name
        path.mkdir(parents=True, exist_ok=True)
        return path

    def calibrate(self, name, finger, plan, logs, *flags):
        """finger, plan: contents or paths; logs: name -> rows."""
        folder = self.folder(name)
        paths = [write_table(folder / f"{log}.csv", table) for log, table in logs.items()]
        given = finger if isinstance(finger, pathlib.Path) else write_yaml(folder / "given.yaml", finger)
        run(self.build, "finray_calibrate", "--finger", given, "--plan", write_yaml(folder / "plan_given.yaml", plan),
            "--logs", ",".join(map(str, paths)), "--out_dir", folder, "--noreport", "--leave_one_log_out=false", *flags,
            allowed=(0, 4))
        return Calibration(folder, yaml.safe_load((folder / "calibration.yaml").read_text("utf-8")))

    def explored(self, name, finger, plan, logs):
        """What --explore says of the logs, in a line."""
        folder = self.folder(name)
        paths = [write_table(folder / f"{log}.csv", table) for log, table in logs.items()]
        ended = run(self.build, "finray_calibrate", "--explore", "--finger", finger, "--plan",
                    write_yaml(folder / "plan_given.yaml", plan), "--logs", ",".join(map(str, paths)), "--out_dir", folder,
                    "--noreport", allowed=(0, 4))
        return "; ".join(line.removeprefix("explored").strip() for line in ended.stdout.splitlines() if line.startswith("explored"))

    def simulate(self, name, finger, scene, table):
        folder = self.folder(name)
        run(self.build, "finray_simulate", "--finger", finger, "--scene", write_yaml(folder / "scene.yaml", scene),
            "--frames", write_table(folder / "frames.csv", table), "--out", folder / "simulated.csv", "--strict=false",
            allowed=(0, 3))
        return rows(folder / "simulated.csv")

    def estimate(self, name, finger, scene, table, *flags):
        folder = self.folder(name)
        run(self.build, "finray_estimate", "--finger", finger, "--scene", write_yaml(folder / "scene.yaml", scene),
            "--logs", write_table(folder / "log.csv", table), "--out_dir", folder, *flags)
        return rows(folder / "log.frames.csv")
