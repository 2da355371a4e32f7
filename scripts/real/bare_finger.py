"""The finger without gauges: pins and forces of an object, predicted by the finger that
another object calibrates."""

import math

import yaml

import data
from sums import rms
from tools import number, write_yaml

# As finray_simulate takes them. A calibration takes circles: near the end of its short
# axis the ellipse is the circle of its curvature, to 0.001 mm within 6 deg of the axis.
SHAPE = {"circle_r20": {"shape": "circle", "radius_mm": 20}, "circle_r30": {"shape": "circle", "radius_mm": 30},
         "ellipse_a20_b30": {"shape": "ellipse", "semi_axis_x_mm": 20, "semi_axis_y_mm": 30}}
FITTED_RADIUS = {"circle_r20": 20, "circle_r30": 30, "ellipse_a20_b30": 45}
FORCE_STD, PIN_STD, PLACE_STD = 0.3, 0.6, 0.2
# Predicted by the finger of which object; the larger series where both would do.
TRAINED_BY = {"circle_r20": "circle_r30", "circle_r30": "circle_r20", "ellipse_a20_b30": "circle_r20"}
ALWAYS = {"front_stiffness": {"prior_std_percent": 30}, "back_stiffness": {"prior_std_percent": 30},
          "object_origin": {"prior_std_mm": 2, "per_log": True}, "camera_origin": {"prior_std_mm": 3}}
TRIALS = {
    "stiffness, places": {},
    "rib lengths": {"rib_length": {"prior_std_mm": 0.5}},
    "places of hinges": {"hinge_place": {"prior_std_mm": 0.5}},
    "rib lengths, places of hinges": {"rib_length": {"prior_std_mm": 1}, "hinge_place": {"prior_std_mm": 1}},
    "these and the back angle": {"rib_length": {"prior_std_mm": 1}, "hinge_place": {"prior_std_mm": 1},
                                 "back_angle": {"prior_std_deg": 1}},
    "springs at hinges": {"hinge_stiffness": {"prior_std_N_mm_per_rad": 20}},
    "friction": {"friction": {"prior_std": 0.3}},
    "clamps that turn": {"clamp_compliance": {"prior_std_rad_per_N_mm": 1e-4}},
    "back angle": {"back_angle": {"prior_std_deg": 1}},
    "pieces of the beams": {"stiffness_pieces": {"prior_std_percent": 20, "count": 3}},
    "radius of the object": {"object_radius": {"prior_std_mm": 0.5}},
    "turned stage": {"object_rotation": {"prior_std_deg": 1}},
    "scale of the force": {"force_scale": {"prior_std_percent": 3}},
    "offset of the force": {"force_offset": {"prior_std_N": 0.2}},
}


def finger():
    """As drawn for the finger with gauges, without them."""
    content = yaml.safe_load((data.FOLDER / "steel_finger.yaml").read_text("utf-8"))
    del content["schema_version"], content["gauges"]
    return {**content, "name": "steel_2021_without_gauges"}


def all_series():
    """Name -> (object, ribs, rows). The first ellipse was pressed 5 mm further than its
    author's uncertain header says: moved so, it agrees with the second."""
    found = {}
    for (name, ribs, day, trial), table in data.bare_forces().items():
        if (name, trial) == ("ellipse_a20_b30", 1):
            table = [{**row, "object_x_mm": row["object_x_mm"] + 5, "advance_mm": row["advance_mm"] + 5} for row in table]
        found[f"{name}_{ribs}_ribs_{day}_{trial}"] = name, ribs, table
    for name, table in data.bare_pins().items():
        found[f"{name}_pins"] = name, 4, table
    return found


def is_pins(row):
    return "rib_1_front_x_mm" in row


def superseded(name):
    return name == "circle_r20_4_ribs_2021-05-20_1"


def for_fit(name, table):
    """The columns of a log of a calibration."""
    shift = FITTED_RADIUS[name] - data.RADIUS[name]
    return [{key: cell - shift if key == "object_x_mm" else cell for key, cell in row.items()
             if key.startswith(("object_", "rib_")) or key == "force_N"} for row in table]


def plan(name, parameters, with_pins):
    measured = {"force_std_N": FORCE_STD, "object_std_mm": PLACE_STD, **({"pin_std_mm": PIN_STD} if with_pins else {})}
    return {"scene": {"contacts": "auto", "object": {"shape": "circle", "radius_mm": FITTED_RADIUS[name]}},
            "parameters": parameters, "measurements": measured, "robust_loss": {"type": "huber", "scale": 3.0}}


def train(tools, folder, name, effects, series):
    logs = {log: for_fit(name, table) for log, (of, ribs, table) in series.items()
            if of == name and ribs == 4 and not superseded(log)}
    return tools.calibrate(folder, finger(), plan(name, {**ALWAYS, **effects}, True), logs)


class Place:
    """Where an object stands beside what is written, and the camera beside frame S."""

    def __init__(self, object_mm, camera_mm, radius_mm=0.0, turn_deg=0.0):
        self.object_mm, self.camera_mm, self.radius_mm = object_mm, camera_mm, radius_mm
        self.turn = math.radians(turn_deg)

    def of(self, row):
        x, y = row["object_x_mm"], row["object_y_mm"]
        c, s = math.cos(self.turn), math.sin(self.turn)
        return {"object_x_mm": self.object_mm[0] + c * x - s * y, "object_y_mm": self.object_mm[1] + s * x + c * y}


def written(calibration, name):
    """The place that the series of the training have on average."""
    values = calibration.values
    origins = [[value for key, value in values.items() if key.startswith(f"object_origin_{axis}_mm")] for axis in "xy"]
    radius = values.get("object_radius_mm")
    trained = next(r for r in FITTED_RADIUS.values() if radius is None or abs(r - radius) < 4)
    return Place([sum(origin) / len(origin) for origin in origins],
                 [values[f"camera_origin_{axis}_mm"] for axis in "xy"],
                 0.0 if radius is None else radius - trained, values.get("object_rotation_deg", 0.0))


def located(tools, folder, finger_path, name, table, start):
    """The place by some rows of the series itself; the finger is as calibrated."""
    with_pins = is_pins(table[0])
    rows = [{**row, **start.of(row)} for row in table]
    for row in rows:
        for key in row:
            if key.startswith("rib_"):
                row[key] += start.camera_mm["xy".index(key[-4])]
    parameters = {"object_origin": {"prior_std_mm": 2}}
    if with_pins:
        parameters["camera_origin"] = {"prior_std_mm": 1}
    found = tools.calibrate(folder, finger_path, plan(name, parameters, with_pins),
                            {"some": for_fit(name, rows)}).values
    moved = [[start.object_mm, start.camera_mm][kind][k] + found.get(f"{word}_origin_{axis}_mm", 0.0)
             for kind, word in enumerate(("object", "camera")) for k, axis in enumerate("xy")]
    return Place(moved[:2], moved[2:], start.radius_mm, math.degrees(start.turn))


def predict(tools, folder, finger_path, name, friction, pairs):
    """pairs: (row, place). Returns force in N and the place of each pin, by row."""
    shape = {key: cell + pairs[0][1].radius_mm if key.endswith("_mm") else cell for key, cell in SHAPE[name].items()}
    simulated = tools.simulate(folder, finger_path, {"object": shape, "friction_coefficient": friction},
                               [place.of(row) for row, place in pairs])
    found = []
    for (row, place), at in zip(pairs, simulated):
        force = [0.0, 0.0]
        for c in range(1, 9):
            normal = number(at.get(f"normal_{c}_N", ""))
            if normal > 0:
                angle = number(at[f"contact_{c}_angle_rad"])
                force[0] += normal * (math.sin(angle) + friction * math.cos(angle))
                force[1] += normal * (friction * math.sin(angle) - math.cos(angle))
        pins = {key: number(at[key]) - place.camera_mm["xy".index(key[-4])]
                for key in row if key.startswith("rib_") and key in at}
        found.append((math.hypot(*force), pins))
    return found


def without_ribs(tools, folder, path):
    content = yaml.safe_load(path.read_text("utf-8"))
    del content["ribs"], content["schema_version"]
    content.pop("calibration", None)
    return write_yaml(tools.folder(folder) / "finger_without_ribs.yaml", content)


def judge(tools, folder, calibration, series, log):
    """Rows of a series: measured, predicted with the place as written, and with the place
    from the other rows of the series."""
    name, ribs, table = series[log]
    friction = calibration.values.get("friction_coefficient", 0.0)
    path = calibration.finger if ribs else without_ribs(tools, folder, calibration.finger)
    start = written(calibration, name)
    scale = calibration.values.get("force_scale", 1.0), calibration.values.get("force_offset_N", 0.0)
    places = []
    for k in range(len(table)):
        rest = table[:k] + table[k + 1:]
        places.append(located(tools, folder, path, name, rest, start))
    as_written = predict(tools, folder, path, name, friction, [(row, start) for row in table])
    by_others = predict(tools, folder, path, name, friction, list(zip(table, places)))
    found = []
    for row, first, second, place in zip(table, as_written, by_others, places):
        entry = {"log": log, "object": name, "ribs": ribs, "advance_mm": row["advance_mm"], "place": place}
        if is_pins(row):
            entry["pins"] = [(key, row[key], first[1].get(key, math.nan), second[1].get(key, math.nan))
                             for key in row if key.startswith("rib_")]
        else:
            entry["force"] = row["force_N"], *(scale[0] * at[0] + scale[1] for at in (first, second))
        found.append(entry)
    return found


def trial(tools, folder, effects, series, objects):
    """Every series of the objects by the finger of another object."""
    fingers = {name: train(tools, f"{folder}/{name}", name, effects, series) for name in ("circle_r20", "circle_r30")}
    return fingers, [entry for log, (name, _, _) in series.items() if name in objects
                     for entry in judge(tools, f"{folder}/{log}", fingers[TRAINED_BY[name]], series, log)]


def force_errors(entries, which):
    return [e["force"][which] - e["force"][0] for e in entries if "force" in e]


def pin_errors(entries, which):
    return [pin[1 + which] - pin[1] for e in entries if "pins" in e for pin in e["pins"]]


def about_the_image(entries, which):
    """Pin errors less the mean of their image and axis: what is left of the shape."""
    found = []
    for entry in entries:
        for axis in "xy":
            off = [pin[1 + which] - pin[1] for pin in entry.get("pins", ()) if pin[0][-4] == axis]
            found += [error - sum(off) / len(off) for error in off]
    return found


def score(entries):
    """Minus twice the logarithm of the likelihood of unseen rows, but for a constant."""
    return (sum((e / FORCE_STD) ** 2 for e in force_errors(entries, 2)) +
            sum((e / PIN_STD) ** 2 for e in pin_errors(entries, 2)))


def line(entries):
    return rms(force_errors(entries, 1)), rms(force_errors(entries, 2)), rms(pin_errors(entries, 1)), rms(
        pin_errors(entries, 2)), rms(about_the_image(entries, 2))


def leave_advance_out(tools, folder, effects, series, name):
    """Rows of an object with ribs, each advance by what its other advances calibrate:
    finger, camera and the place of each series. Entries as those of judge(), the
    prediction twice."""
    logs = {log: table for log, (of, ribs, table) in series.items() if of == name and ribs and not superseded(log)}
    found = []
    for advance in sorted({row["advance_mm"] for table in logs.values() for row in table}):
        rest = {log: for_fit(name, [row for row in table if row["advance_mm"] != advance]) for log, table in logs.items()}
        calibration = tools.calibrate(folder, finger(), plan(name, {**ALWAYS, **effects}, True), rest)
        values = calibration.values
        for log, table in logs.items():
            place = Place([values[f"object_origin_{axis}_mm[{log}.csv]"] for axis in "xy"],
                          [values[f"camera_origin_{axis}_mm"] for axis in "xy"])
            for row in (row for row in table if row["advance_mm"] == advance):
                force, pins = predict(tools, folder, calibration.finger, name, 0.0, [(row, place)])[0]
                entry = {"log": log, "object": name, "ribs": 4, "advance_mm": advance, "place": place}
                if is_pins(row):
                    entry["pins"] = [(key, row[key], pin, pin) for key, pin in pins.items()]
                else:
                    entry["force"] = row["force_N"], force, force
                found.append(entry)
    return found
