"""The project that a tool in Python belongs to, in the source tree and installed."""

import pathlib
import re

_PROJECT = pathlib.Path(__file__).resolve().parents[2] / "CMakeLists.txt"


def version():
    """FINRAY_VERSION, which executables print too."""
    return re.search(r"FINRAY_VERSION ([^)]+)", _PROJECT.read_text(encoding="utf-8"))[1]
