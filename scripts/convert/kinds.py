"""The kinds of YAML files that finray reads, their versions, and the steps from one version to the next.

A change of a format that today's readers would not take adds a version here: TODAY grows by one, and STEPS gets the
function that brings the text of the version before to it. Texts are changed in place, so comments stay.
"""

import yaml

TODAY = {"finger": 1, "scene": 1, "plan": 1, "experiment": 1, "mapping": 1, "calibration": 1}

# A file is of the first kind that has one of these keys at its top.
_MARKS = [("finger", {"geometry", "beams", "gauges"}),
          ("experiment", {"set_point", "actuation", "object_start", "paper"}),
          ("calibration", {"weak_directions", "noise", "verdict", "inputs"}),
          ("plan", {"parameters", "scene", "holdout", "robust_loss"}),
          ("mapping", {"tables", "join", "plateaus", "force", "time_origin"}),
          ("scene", {"contacts", "contact_beams", "friction_coefficient", "force_max_N", "object", "measurements",
                     "smoothing", "gauge_offset_walk", "search_iteration_limit", "presliding_mm"}),
          ("mapping", {"columns", "delimiter", "decimal", "header_line", "units_row", "not_measured"})]


def kind_of(keys):
    """The kind of a file with these keys at its top, or None."""
    return next((kind for kind, marks in _MARKS if marks & set(keys)), None)


def _state_version(text, node):
    """0 to 1: files state their version. Scenes and mappings did not have to."""
    lines = text.splitlines(keepends=True)
    at = node.start_mark.line
    if isinstance(node, yaml.MappingNode) and node.flow_style:  # {contacts: 1}
        line, column = lines[at], node.start_mark.column + 1
        lines[at] = line[:column] + "schema_version: 1" + (", " if node.value else "") + line[column:]
    else:
        lines.insert(at, " " * node.start_mark.column + "schema_version: 1\n")
    return "".join(lines)


# By the version that a step starts from: (text, root node) -> text. A kind without a step of its own takes the one of "".
STEPS = {0: {"": _state_version}}


def step(kind, version):
    steps = STEPS[version]
    return steps.get(kind, steps.get(""))
