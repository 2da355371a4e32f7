#!/usr/bin/env python3
"""No room includes one that is not below it, and the picture of the layers is that
of today's includes (scripts/draw_layers.py)."""
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PICTURE = ROOT / "docs/pictures/layers.svg"

with tempfile.TemporaryDirectory() as folder:
    drawn = pathlib.Path(folder) / "layers.svg"
    if subprocess.run([sys.executable, ROOT / "scripts/draw_layers.py", drawn]).returncode:
        sys.exit(1)
    if drawn.read_bytes() != PICTURE.read_bytes():
        sys.exit("docs/pictures/layers.svg is not of these sources: run scripts/draw_layers.py")
