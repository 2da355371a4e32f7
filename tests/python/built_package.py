"""finray as the build has it, with numpy; ends the test as skipped, with 77, where either is missing."""
import os
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("FINRAY_BINARY_DIR", ROOT / "build/dev")).resolve()
sys.path.insert(0, str(BUILD / "python"))
try:
    import numpy as np

    import finray
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)
