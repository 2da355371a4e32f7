#!/usr/bin/python3
"""The paper's figures beside ours in one page: report.py OUT_DIR

Reads the results of simulate.py in OUT_DIR. Writes report.html, which needs nothing
else, and table.md, the table at its top.
"""

import datetime
import pathlib
import statistics
import sys

sys.dont_write_bytecode = True

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import guard  # noqa: E402

guard.protect("paper_experiments", __name__)

import contact_frames
import force_control
import force_sensing
import outlines
import stiffness
import structural
from comparison import BEATS, Comparison, DIFFERS
from inputs import BadInput
import look  # finds the modules of the calibration's report
import page
import whole_file

# In the paper's order; each module has sections(folder).
EXPERIMENTS = (contact_frames, outlines, stiffness, force_sensing, force_control, structural)
NOT_IN_IT = ("hysteresis and creep of beams and joints", "friction at the contact and in the drive", "clamps that give",
             "out-of-plane loads", "errors of the camera or force sensor that the result is compared with",
             "drift and temperature",
             "and, the largest of all, whatever a real finger has beyond the beam model, which simulator and estimator "
             "share (in Figs. 11 to 17 and 22 on the same mesh too; elsewhere the simulator's is finer): friction, "
             "contact of finite length, hysteresis are in none of these figures, as the angle of the sensed contact "
             "suggests, 0.05 against 1.24 deg")


def tally(sections):
    """Rows with a number to beat, without and with a preview, and findings."""
    every = [row for section in sections for row in section.rows]
    rows = [row for row in every if isinstance(row, Comparison)]
    findings = [row for row in every if not isinstance(row, Comparison)]
    own = [row for row in rows if not row.preview]
    repeated = [row.structural_verdict for row in rows if row.structural_verdict]
    return {"rows": len(every), "findings": len(findings),
            "differs": sum(row.verdict == DIFFERS for row in findings),
            "figures": len(own), "beaten": sum(row.beats for row in own),
            "structural_figures": len(repeated), "structural_beaten": repeated.count(BEATS),
            "worse": [row for row in own if not row.beats],
            "preview_figures": sum(row.preview for row in rows),
            "preview_beaten": sum(row.preview and row.beats for row in rows)}


def fields(row):
    """The cells of a row of the table, for either kind."""
    if isinstance(row, Comparison):
        return {"paper": row.paper_text, "ours": row.ours_text, "why": "" if row.beats else row.why, "words": False,
                "kind": "good" if row.beats else "bad", "structural": row.structural_text,
                "structural_verdict": row.structural_verdict or "",
                "structural_kind": "good" if row.structural_verdict == BEATS else "bad"}
    return {"paper": row.paper, "ours": row.ours, "why": "" if row.agrees else row.why, "words": True,
            "kind": "good" if row.agrees else "warn", "structural": "", "structural_verdict": ""}


def markdown(sections):
    lines = ["| experiment | where | paper | ours, simulated | verdict | ours, plant with structural errors | verdict |",
             "|---|---|---|---|---|---|---|"]
    for section in sections:
        for row in section.rows:
            cells = fields(row)
            lines.append(f"| {row.what} | {row.source} | {cells['paper']} | {cells['ours']} | {row.verdict} | "
                         f"{cells['structural']} | {cells['structural_verdict']} |")
    return "\n".join(lines) + "\n"


def rendered(sections):
    environment = page.environment(pathlib.Path(__file__).parent)
    environment.globals.update(fields=fields)
    environment.filters.update(minus=lambda text: text.replace(" -", " \u2212"))
    return environment.get_template("paper.html.jinja").render(
        sections=sections, tally=tally(sections), not_in_it=NOT_IN_IT, date=datetime.date.today().isoformat())


def tally_text(sections):
    """Every row in one of these."""
    found = tally(sections)
    return (f"{found['rows']} rows. Without a preview {found['beaten']} of {found['figures']} beat the paper, with one "
            f"{found['preview_beaten']} of {found['preview_figures']}; of {found['findings']} without a number to beat "
            f"{found['findings'] - found['differs']} are the same and {found['differs']} "
            f"{'differs' if found['differs'] == 1 else 'differ'}. With a plant of structural errors "
            f"{found['structural_beaten']} of {found['structural_figures']} beat the paper.")


def sections_of(experiment, folder):
    """The sections of an experiment, or one line that says why there are none."""
    of = folder / experiment.__name__
    try:
        return experiment.sections(folder)
    except KeyError as error:
        raise BadInput(f"{of}: no value {error}") from None
    except statistics.StatisticsError as error:
        raise BadInput(f"{of}: no mean: {error}") from None
    except ZeroDivisionError as error:
        raise BadInput(f"{of}: {error}") from None
    except (AttributeError, IndexError, StopIteration, TypeError, ValueError) as error:
        raise BadInput(f"{of}: values not as expected: {' '.join(str(error).split())}") from None


def main():
    folder = pathlib.Path(*guard.words(__doc__, 1, 1))
    sections = [section for experiment in EXPERIMENTS for section in sections_of(experiment, folder)]
    table = f"{markdown(sections)}\n{tally_text(sections)}\n"
    whole_file.write(folder / "report.html", rendered(sections))
    whole_file.write(folder / "table.md", table)
    print(table, end="")
    print(folder / "report.html")


if __name__ == "__main__":
    main()
