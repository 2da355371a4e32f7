"""The real measurements as frame tables: reads them where they are, copies nothing.

They lie in ../shared/data, beside the repository."""

import csv
import math
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = ROOT.parent / "shared" / "data"
# The circles' and the ellipse's half width along the advance, mm.
RADIUS = {"circle_r20": 20, "circle_r30": 30, "ellipse_a20_b30": 20}
# Where the centre of every object stood along the front beam, mm (steel finger's log).
OBJECT_Y = 66.5


def there():
    return (FOLDER / "steel_finger.yaml").is_file()


def read(name):
    with open(FOLDER / name, newline="", encoding="utf-8") as table:
        return list(csv.DictReader(table))


def place(name, advance):
    """Columns of an object that touches at advance 0, once the base has advanced."""
    return {"object_x_mm": advance - RADIUS[name], "object_y_mm": OBJECT_Y}


def bare_forces():
    """Series of the finger without gauges, (object, ribs, day, trial) -> rows of a log.

    The column force_N is the norm; sensor_x_N and sensor_y_N are kept as read."""
    series = {}
    for row in read("finger_without_gauges_contact_force.csv"):
        x, y = float(row["Fx_sensor_N"]), float(row["Fy_sensor_N"])
        key = row["object"], int(row["n_ribs"]), row["session"], int(row["trial"])
        series.setdefault(key, []).append({
            **place(row["object"], float(row["base_advance_mm"])), "advance_mm": float(row["base_advance_mm"]),
            "force_N": math.hypot(x, y), "sensor_deg": math.degrees(math.atan2(y, x)) + float(row["sensor_axis_angle_deg"])})
    return series


def pins(name):
    """Rows of a log with the pins that a camera saw: object -> rows."""
    series = {}
    for row in read(name):
        rows = series.setdefault(row["object"], {})
        advance = float(row["base_advance_mm"])
        frame = rows.setdefault(advance, {**place(row["object"], advance), "advance_mm": advance})
        for axis in "xy":
            frame[f"rib_{row['rib']}_{row['beam']}_{axis}_mm"] = float(row[f"{axis}_mm"])
    return {name: list(rows.values()) for name, rows in series.items()}


def bare_pins():
    return pins("finger_without_gauges_rib_pins.csv")


def gauged():
    """The log of the finger with gauges, on a circle of 20 mm."""
    return [{name: cell for name, cell in row.items() if name != "note"}
            for row in read("steel_finger_contact_circle_r20.csv")]


def gauged_pins():
    return pins("steel_finger_rib_pins_circle_r20.csv")["circle_r20"]


def cylinders():
    """Gauges bent round cylinders: (gauge, day, trial) -> rows of a bench log, those that
    their author took."""
    series = {}
    for row in read("gauge_cylinder_calibration.csv"):
        if row["excluded_by_author"] == "0":
            series.setdefault((row["sensor"], row["session"], int(row["trial"])), []).append(
                {"cylinder_radius_mm": row["cylinder_radius_mm"], "gauge_1_V": row["voltage_V"]})
    return series


def touches(name):
    return [{key: cell for key, cell in row.items() if key != "note"} for row in read(f"rotating_{name}.csv")]
