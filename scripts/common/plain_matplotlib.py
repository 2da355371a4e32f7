"""matplotlib as it comes: a matplotlibrc of the working folder or of the user changes no report.

Import this before matplotlib. What it keeps on disk, its fonts, is in a folder that ends with the script.
"""

import atexit
import os
import shutil
import tempfile

_folder = tempfile.mkdtemp(prefix="finray_mpl_")
atexit.register(shutil.rmtree, _folder, ignore_errors=True)
os.environ["MPLCONFIGDIR"] = _folder
os.environ.pop("MATPLOTLIBRC", None)
_here = os.open(".", os.O_RDONLY | os.O_DIRECTORY)
os.chdir(_folder)  # matplotlib reads a matplotlibrc of the folder in which it is imported
try:
    import matplotlib  # noqa: F401
finally:
    os.fchdir(_here)
    os.close(_here)
