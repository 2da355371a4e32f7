#!/usr/bin/python3
"""Renders recording.html, to print: recording_page.py FOLDER FINGER VERDICT TARGET FORCE_MAX_N HAS_PICTURE.

Reads recording.csv and, if HAS_PICTURE is 1, finger.svg of the folder.
"""

import csv
import pathlib
import sys

sys.dont_write_bytecode = True

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "scripts/common"))
import guard  # noqa: E402

guard.protect("recording_page.py", __name__)

import markupsafe

import page
import whole_file


def main():
    folder = pathlib.Path(sys.argv[1])
    finger, verdict, target, force_max, has_picture = sys.argv[2:7]
    with open(folder / "recording.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    gauges = [name for name in (rows[0] if rows else {}) if name.startswith("gauge_")]
    picture = (folder / "finger.svg").read_text("utf-8") if has_picture == "1" else ""
    text = page.environment().get_template("recording.html.jinja").render(
        finger=finger, verdict=verdict, target=target, force_max=force_max, rows=rows, gauges=gauges,
        picture=markupsafe.Markup(picture))
    whole_file.write(folder / "recording.html", text)


if __name__ == "__main__":
    main()
