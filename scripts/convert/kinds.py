"""The kinds of YAML files that finray reads, their versions, and the steps from one version to the next.

A change of a format that today's readers would not take adds a version here: TODAY grows by one, and STEPS gets the
function that brings the text of the version before to it. Texts are changed in place, so comments stay.
"""

# 0: results that state no version.
TODAY = {"finger": 1, "scene": 1, "plan": 1, "experiment": 1, "mapping": 1, "calibration": 1, "validation": 1, "comparison": 1,
         "summary": 0, "control summary": 0, "reconstruction": 0, "compliance": 0}

# A file is of the first kind that has one of these keys at its top.
_MARKS = [("finger", {"geometry", "beams", "gauges"}),
          ("experiment", {"set_point", "actuation", "object_start", "paper"}),
          ("calibration", {"weak_directions", "noise", "effective_rows"}),
          ("comparison", {"shared_logs", "only_in_a", "only_in_b"}),
          ("validation", {"gates", "baseline"}),
          ("summary", {"logs", "hidden_forces", "result_bytes"}),
          ("control summary", {"experiments"}),
          ("reconstruction", {"descriptors", "envelope_descriptors"}),
          ("compliance", {"order_confidence", "compared_between_N"}),
          ("plan", {"parameters", "scene", "holdout", "robust_loss"}),
          ("mapping", {"tables", "join", "plateaus", "force", "time_origin"}),
          ("scene", {"contacts", "most_contacts", "contact_beams", "friction_coefficient", "friction_std", "force_max_N",
                     "object", "measurements", "smoothing", "gauge_offset_walk", "search_iteration_limit", "presliding_mm"}),
          ("mapping", {"columns", "delimiter", "decimal", "header_line", "units_row", "not_measured"})]


def kind_of(keys):
    """The kind of a file with these keys at its top, or None."""
    return next((kind for kind, marks in _MARKS if marks & set(keys)), None)


def _state_version(text, node):
    """0 to 1: files state their version. Scenes and mappings did not have to."""
    # The node itself may begin with a tag or an anchor, in the line of "---".
    if node.flow_style:  # {contacts: 1}
        at = text.index("{", node.start_mark.index) + 1
        return text[:at] + "schema_version: 1" + (", " if node.value else "") + text[at:]
    key = node.value[0][0].start_mark
    at = key.index - key.column
    before = text[at:key.index]  # spaces, and "? " of a key that is marked as one
    return text[:at] + " " * (len(before) - len(before.lstrip(" "))) + "schema_version: 1\n" + text[at:]


# By the version that a step starts from: (text, root node) -> text. A kind without a step of its own takes the one of "".
STEPS = {0: {"": _state_version}}


def step(kind, version):
    steps = STEPS[version]
    return steps.get(kind, steps.get(""))
