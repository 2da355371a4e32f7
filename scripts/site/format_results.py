"""The keys and columns of results, from results that the executables of a build write, and from the sources that write them.

A key that no run here happens to write, because it stands in some results only, is found in the sources.
"""

import csv
import pathlib
import re
import subprocess

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
FROZEN, NOMINAL = ROOT / "tests/data/formats/1.0", ROOT / "configs/fingers/paper_140mm.yaml"
CALIB, LIBFINRAY = ROOT / "calib/finray/calib", ROOT / "libfinray/finray"
# Files of a run, by the sources that write their keys.
WRITTEN = {
    "calibration": (["calibrated/calibration.yaml"], [CALIB / "report/calibration_yaml.cc", CALIB / "analysis/error_table.cc"]),
    "validation": (["validated/validation.yaml"], [CALIB / "report/validation_files.cc"]),
    "comparison": (["compared/comparison.yaml"], [CALIB / "report/comparison_files.cc"]),
    "summary": (["estimated/summary.yaml"], [LIBFINRAY / "batch/estimation_summary.cc", LIBFINRAY / "batch/log_job.cc"]),
    "log_summary": (["estimated/log.summary.yaml"], [LIBFINRAY / "batch/estimation_summary.cc", LIBFINRAY / "batch/log_job.cc"]),
    "control": (["control/summary.yaml"], [LIBFINRAY / "control/run_experiment.cc", ROOT / "apps/finray_control.cc"]),
    "reconstruction": (["outline/reconstruction.yaml"], []),  # its file also writes that of compliance; neither leaves out keys
    "compliance": (["springs/compliance.yaml"], []),
}
TABLES = {
    "calibration_tables": ["calibrated/calibration.frames.csv", "calibrated/calibration.shape.csv"],
    "validation_tables": ["validated/validation.frames.csv"], "comparison_tables": ["compared/comparison.csv"],
    "summary_tables": ["estimated/summary.csv"],
    "reconstruction_tables": ["outline/outline.csv", "outline/touches.csv", "outline/beams.csv"],
    "compliance_tables": ["springs/stiffness.csv", "springs/points.csv", "springs/laws.csv"],
}
# Mappings whose keys are names of parameters, files or the like.
NAMES = {"components": "parameter", "std_enlarged_by": "parameter", "status": "status", "noise": "kind"}
ERROR_TABLE = "an error table"
# Where the keys stand among the arguments behind the emitter.
KEYS_AT = {"YamlPair": lambda i: i % 2 == 0, "YamlPairs": lambda i: i % 2 == 0, "YamlLine": lambda i: i % 2 == 0,
           "EmitLine": lambda i: i == 0 or i % 2 == 1, "EmitSeq": lambda i: i == 0, "BeginMap": lambda i: i == 0,
           "BeginLine": lambda i: i == 0, "EmitErrorTable": lambda i: i == 0, "EmitForceErrors": lambda i: i == 0}


def run_all(build, out):
    """A run of each tool that writes results, on the frozen files of this version."""
    def run(tool, *arguments, codes=(0,)):
        ended = subprocess.run([build / tool, *map(str, arguments)], capture_output=True, text=True, cwd=ROOT)
        if ended.returncode not in codes:
            raise RuntimeError(f"{tool}: {ended.stderr}")

    plan = yaml.safe_load((FROZEN / "plan.yaml").read_text(encoding="utf-8"))
    (out / "plan.yaml").write_text(yaml.safe_dump({**plan, "holdout": {"by": "block", "fraction": 0.2}}))
    run("finray_calibrate", "--finger", NOMINAL, "--plan", out / "plan.yaml", "--logs", f"{FROZEN}/train.csv,{FROZEN}/log.csv",
        "--report=false", "--out_dir", out / "calibrated", codes=(0, 4))
    finger = out / "calibrated/finger.yaml"
    run("finray_validate", "--finger", finger, "--plan", FROZEN / "plan.yaml", "--logs", FROZEN / "log.csv", "--baseline", NOMINAL,
        "--most_force_rms_N", 1, "--least_coverage_95_percent", 10, "--out_dir", out / "validated", codes=(0, 4))
    run("finray_compare", FROZEN / "calibration", out / "calibrated", "--most_force_difference_N", 1, "--out_dir", out / "compared",
        codes=(0, 4))
    run("finray_estimate", "--finger", finger, "--logs", FROZEN / "log.csv", "--out_dir", out / "estimated")
    run("finray_reconstruct", "--finger", NOMINAL, "--logs", FROZEN / "touches.csv", "--truth", ROOT / "datasets/touches_square/outline.csv",
        "--out_dir", out / "outline", "--plots=false", codes=(0, 4))
    run("finray_compliance", "--finger", NOMINAL, "--scene", FROZEN / "spring_scene.yaml", "--logs",
        ",".join(map(str, sorted(FROZEN.glob("spring_*_*.csv")))), "--out_dir", out / "springs", "--plots=false")
    run("finray_control", "--finger", NOMINAL, "--experiment", FROZEN / "experiment.yaml", "--draws", 1, "--out_dir", out / "control")


def _collect(value, path, found):
    if isinstance(value, list):
        for element in value:
            _collect(element, path + "[]" * (path[-2:] != "[]"), found)
    if not isinstance(value, dict):
        return
    if "regions" in value:
        path = ERROR_TABLE
    keys = found.setdefault(path, {})
    stem = path.replace("[]", "").rpartition(".")[2]
    for key, inner in value.items():
        name = f"<{NAMES[stem]}>" if stem in NAMES else "<path>" if "/" in key else key
        keys[name] = None
        _collect(inner, f"{path}.{name}".lstrip("."), found)


def _arguments(text, start):
    """The arguments of a call whose bracket opens before `start`."""
    arguments, depth, quoted, current, i = [], 0, False, "", start
    while True:
        c = text[i]
        if quoted:
            quoted = c != '"' or text[i - 1] == "\\"
        elif c == '"':
            quoted = True
        elif c in "([{":
            depth += 1
        elif c in ")]}":
            if depth == 0:
                return [*arguments, current.strip()]
            depth -= 1
        elif c == "," and depth == 0:
            arguments, current, i = [*arguments, current.strip()], "", i + 1
            continue
        current += c
        i += 1


def keys_of_sources(sources):
    keys = []
    for source in sources:
        text = source.read_text(encoding="utf-8")
        keys += re.findall(r'YAML::Key << "(\w+)"', text)
        for call in re.finditer(rf"\b({'|'.join(KEYS_AT)})\(", text):
            arguments = [a for a in _arguments(text, call.end()) if not re.fullmatch(r"&?yaml|&yaml_", a)]
            for i, argument in enumerate(arguments):
                if KEYS_AT[call[1]](i) and re.fullmatch(r'"\w+"', argument):
                    keys.append(argument.strip('"'))
    return list(dict.fromkeys(keys))


def _keys_of_results(name, out):
    found = {}
    for file in WRITTEN[name][0]:
        _collect(yaml.safe_load((out / file).read_text(encoding="utf-8")), "", found)
    found.pop("residual_correlation.std_enlarged_by", None)  # names of parameters, or nothing
    return found


def yaml_keys(name, out):
    """({path of a mapping: keys}, keys of the sources that no file of theirs has here)."""
    sources = WRITTEN[name][1]
    alike = [other for other in WRITTEN if other == name or set(sources) & set(WRITTEN[other][1])]
    there = {key for other in alike for keys in _keys_of_results(other, out).values() for key in keys}
    return _keys_of_results(name, out), [key for key in keys_of_sources(sources) if key not in there]


def columns(name, out):
    """[(file, columns)]"""
    tables = []
    for file in TABLES[name]:
        with open(out / file, newline="", encoding="utf-8") as table:
            tables.append((pathlib.Path(file).name, next(csv.reader(table))))
    return tables
