"""An interpreter that has imported the packages of finray's tools in Python, and forks for each run.

Each line of stdin is a run, {"script", "arguments", "folder", "bytes"}; the answer is a line with the process and, once
it ended, a line [status, seconds of CPU, kB]. The script runs as __main__. Its process ends as that of an interpreter
would, but deletes no objects first, which would take a second.
"""

import atexit
import gc
import importlib
import json
import os
import pathlib
import resource
import sys

sys.dont_write_bytecode = True
SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
PACKAGES = ("h5py", "openpyxl", "pandas", "scipy.io", "sqlite3", "yaml", "zstandard", "lz4.frame")


def served():
    """The next run, in a new process of its own; None at the end of stdin."""
    for line in sys.stdin:
        run = json.loads(line)
        process = os.fork()
        if process == 0:
            return run
        print(process, flush=True)
        _, status, usage = os.wait4(process, 0)
        print(json.dumps([status, usage.ru_utime + usage.ru_stime, usage.ru_maxrss]), flush=True)
    return None


def main():
    own = sys.path[:]
    sys.path[:0] = [str(SCRIPTS / folder) for folder in ("convert", "import", "common")]
    modules = (path.stem for folder in ("import", "convert") for path in sorted((SCRIPTS / folder).glob("*.py")))
    for name in (*PACKAGES, *modules):
        try:
            importlib.import_module(name)
        except ImportError:
            pass
    sys.path[:] = own
    gc.freeze()  # the packages' objects, so that no process copies their pages
    run = served()
    if run is None:
        return
    os.chdir(run["folder"])
    for name, descriptor, flags in (("/dev/null", 0, os.O_RDONLY), (".stdout", 1, os.O_WRONLY | os.O_CREAT),
                                    (".stderr", 2, os.O_WRONLY | os.O_CREAT)):
        os.dup2(os.open(name, flags, 0o644), descriptor)
    resource.setrlimit(resource.RLIMIT_AS, (run["bytes"], run["bytes"]))
    sys.argv = [run["script"], *run["arguments"]]
    code = 0
    try:
        exec(compile(pathlib.Path(run["script"]).read_text("utf-8"), run["script"], "exec"),
             {"__name__": "__main__", "__file__": run["script"]})
    except SystemExit as end:
        code = end.code
    except BaseException:
        code = 1
        sys.excepthook(*sys.exc_info())
    atexit._run_exitfuncs()
    sys.stdout.flush()
    os._exit(code or 0)


if __name__ == "__main__":
    main()
