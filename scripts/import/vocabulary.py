"""The names of the columns of a log, and what a header probably means.

The patterns are those of libfinray/finray/io/frame_vocabulary.cc; '#' is an index from 1.
"""

import re

import units
from errors import did_you_mean

PATTERNS = """
time_s gauge_#_V gauge_#_rad contact_#_mm contact_#_std_mm contact_#_noise_mm
normal_#_N normal_#_std_N normal_#_noise_N
contact_#_low_mm contact_#_high_mm normal_#_low_N normal_#_high_N friction_#
alternative_contact_#_mm alternative_normal_#_N contact_#_x_mm contact_#_y_mm
contact_#_angle_rad object_x_mm object_y_mm object_angle_deg object_displacement_mm
force_N force_x_N force_y_N rib_#_N rib_#_front_x_mm rib_#_front_y_mm rib_#_back_x_mm
rib_#_back_y_mm cylinder_radius_mm tip_x_mm tip_y_mm tip_angle_rad chi2 chi2_p_value
alternative_chi2 iterations search_ended temperature_C gauge_#_scatter_V
force_scatter_N force_x_scatter_N force_y_scatter_N gauge_readings force_readings
""".split()
# Along the sensor's own axes; force_frame.py turns them into force_x_N, force_y_N.
SENSOR_AXES = ["force_sensor_x_N", "force_sensor_y_N"]
TIME_HEADERS = {"t", "time", "zeit", "timestamp", "time_stamp", "header.stamp"}

# plateaus.py finds scatter and counts; no column of a recording becomes them.
_TARGETS = [p for p in PATTERNS + SENSOR_AXES
            if "_scatter_" not in p and not p.endswith("_readings")]
_MATCH = [re.compile(re.escape(p).replace(r"\#", "#").replace("#", r"[1-9]\d{0,3}"))
          for p in _TARGETS]


def is_column(name):
    return any(pattern.fullmatch(name) for pattern in _MATCH)


def nearest(name):
    index = re.search(r"[1-9]\d*", name)
    index = index.group() if index else "1"
    return did_you_mean(name, [p.replace("#", index) for p in _TARGETS])


def order(name):
    """Sorts the columns of a log: time, gauges, force, object, then the rest."""
    stem = re.sub(r"\d+", "#", name)
    first = ["time_s", "gauge_#_V", "gauge_#_rad", "force_N", "force_x_N", "force_y_N",
             "object_x_mm", "object_y_mm", "object_angle_deg"]
    index = re.search(r"\d+", name)
    return (first.index(stem) if stem in first else len(first),
            "" if stem in first else stem, int(index.group()) if index else 0)


def split_unit(header):
    """('Fz', 'N') of 'Fz [N]', 'Fz (N)' or 'Fz/N'; the unit is '' if there is none."""
    found = re.fullmatch(r"(.*?)\s*(?:\[(.*)\]|\((.*)\)|/\s*(\S+))", header)
    if found:
        unit = next((u for u in found.groups()[1:] if u is not None), "")
        if units.is_word_of_file(unit):
            return found.group(1), unit
    return header, ""


def guess(header, unit):
    """(column, Unit or None) that a header certainly means, or None: a name of the
    vocabulary, one with another unit at its end, or a usual word for time."""
    if is_column(header):
        return header, None
    bare, own = split_unit(header)
    if bare.lower() in TIME_HEADERS:
        return "time_s", units.find_in_file(own or unit)
    stem, _, last = bare.rpartition("_")
    found = units.find_in_file(last)
    if not found or not stem:
        stem, found = bare, units.find_in_file(own or unit)
    if found:
        for suffix in units.SUFFIX:
            target = f"{stem}_{suffix}"
            if is_column(target) and units.conversion(found, target):
                return target, found
    return None
