"""Gauges bent round cylinders: each cylinder's reading by what the others calibrate."""

import yaml

import data
from sums import rms

LENGTH_MM = 38
PLAIN = {"gauge_gain": {}, "gauge_offset": {}}
CURVED = {**PLAIN, "gauge_curvature": {"prior_std_per_rad": 3}}


def finger():
    content = yaml.safe_load((data.FOLDER / "steel_finger.yaml").read_text("utf-8"))
    del content["schema_version"]
    return {**content, "gauges": [{**content["gauges"][0], "length_mm": LENGTH_MM, "gain_V_per_rad": 1.0}]}


def calibrated(tools, folder, parameters, rows):
    plan = {"scene": {}, "parameters": parameters, "measurements": {"gauge_std_V": 0.01}}
    values = tools.calibrate(folder, finger(), plan, {"bench": rows}).values
    return (values["gauge_1_gain_V_per_rad"], values.get("gauge_1_curvature_per_rad", 0.0), values["gauge_1_offset_V"])


def angle(row):
    return LENGTH_MM / float(row["cylinder_radius_mm"])


def bent(gauge, row):
    gain, curvature, _ = gauge
    a = angle(row)
    return gain * (a + curvature * a * a)


def leave_one_out(tools, folder, parameters, rows):
    """Errors of the readings in V."""
    found = []
    for k, row in enumerate(rows):
        gauge = calibrated(tools, folder, parameters, rows[:k] + rows[k + 1:])
        found.append(gauge[2] + bent(gauge, row) - float(row["gauge_1_V"]))
    return found


def transferred(tools, folder, parameters, rows, others):
    """Errors on another day's or trial's readings, which give the offset by their flat row."""
    gauge = calibrated(tools, folder, parameters, rows)
    flat = next(float(row["gauge_1_V"]) for row in others if row["cylinder_radius_mm"] == "inf")
    return [flat + bent(gauge, row) - float(row["gauge_1_V"]) for row in others if row["cylinder_radius_mm"] != "inf"]


def judged(tools, folder, key, series):
    """One series: its gauge with a curve, errors of the plain and of the curved one."""
    rows = series[key]
    gauge = calibrated(tools, folder, CURVED, rows)
    others = [k for k in series if k[0] == key[0] and k != key and any(r["cylinder_radius_mm"] == "inf" for r in series[k])]
    found = {"key": key, "rows": len(rows), "gauge": gauge, "plain_gain": calibrated(tools, folder, PLAIN, rows)[0]}
    for name, parameters in (("plain", PLAIN), ("curved", CURVED)):
        found[name] = leave_one_out(tools, folder, parameters, rows)
        for when, same in (("same_day", True), ("other_day", False)):
            found[f"{name}_{when}"] = [e for k in others if (k[1] == key[1]) == same
                                       for e in transferred(tools, folder, parameters, rows, series[k])]
    return found


def totals(entries):
    """rms in V of all series together, by how the rows were held out."""
    return {name: (rms([e for entry in entries for e in entry[name]]), sum(len(entry[name]) for entry in entries))
            for name in (kind + how for kind in ("plain", "curved") for how in ("", "_same_day", "_other_day"))}
