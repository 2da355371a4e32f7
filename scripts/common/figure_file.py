"""Figures as files that appear whole or not at all, without version and date: equal numbers give equal bytes."""

import io
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "calib" / "report"))
import whole_file  # noqa: E402

METADATA = {".svg": {"Date": None, "Creator": None}, ".png": {"Software": None}}


def write(figure, path, **how):
    """Writes the figure as the ending of its path says; how: of savefig."""
    ending, image = pathlib.Path(path).suffix, io.BytesIO()
    figure.savefig(image, format=ending[1:], metadata=METADATA[ending], **how)
    whole_file.write(path, image.getvalue())
