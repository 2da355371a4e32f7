#!/usr/bin/python3
"""Writes the man page and the bash completion of executables, from their --help.

make_pages.py VERSION OUT_DIR EXECUTABLE...

Writes OUT_DIR/man1/<name>.1.gz and OUT_DIR/completions/<name>.
"""

import gzip
import pathlib
import re
import subprocess
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "common"))
import guard  # noqa: E402

guard.protect("make_pages.py", __name__)

FLAG = re.compile(r"^ {2}--(\w+)\s+(.*)$")


def pages_of(executable):
    """What an executable is, how it is called, and (section, flag, words) of its flags."""
    run = subprocess.run([executable, "--help"], capture_output=True, text=True, check=False)
    if run.returncode:
        sys.exit(f"{executable} --help ends with {run.returncode}: {run.stderr}")
    lines = run.stdout.splitlines()
    name = pathlib.Path(executable).name
    flags, words, usage, section = [], [], [], ""
    for line in lines:
        found = FLAG.match(line)
        if found:
            flags.append((section, found[1], found[2]))
        elif re.fullmatch(r"\w+", line):
            section = line
        elif name in line and not flags:
            usage.append(line.strip())
        elif line.strip():
            words.append(line.strip())
    return name, words[0], usage, flags, words[1:]


def roff(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text[:1] in (".", "'") else text


def man_page(version, name, what, usage, flags, more, others):
    yield f'.TH {name.upper()} 1 "" "finray {version}" "finray"'
    yield f".SH NAME\n{name} \\- {roff(what.rstrip('.'))}"
    yield ".SH SYNOPSIS\n" + "\n.br\n".join(roff(line) for line in usage)
    last = None
    for section, flag, words in flags:
        if section != last:
            yield f".SH {section.upper()}"
            last = section
        yield ".TP\n\\fB\\-\\-" + roff(flag) + "\\fR\n" + roff(words)
    for line in more:
        title, colon, rest = line.partition(": ")
        yield (".SH EXIT STATUS\n" + roff(rest) if colon and title == "Exit code" else ".SH NOTES\n" + roff(line))
    yield ".SH SEE ALSO\n" + ",\n".join(f".BR {other} (1)" for other in others)


def completion(name, flags):
    words = " ".join("--" + flag for flag in [*(flag for _, flag, _ in flags), "help"])
    return f"""# Flags of {name}; anything else is a file.
_{name}() {{
  COMPREPLY=()
  if [[ ${{COMP_WORDS[COMP_CWORD]}} == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "{words}" -- "${{COMP_WORDS[COMP_CWORD]}}")
  fi
}}
complete -o default -F _{name} {name}
"""


def main():
    version, out, *executables = guard.words(__doc__, 3)
    out = pathlib.Path(out)
    for folder in ("man1", "completions"):
        (out / folder).mkdir(parents=True, exist_ok=True)
    names = sorted(pathlib.Path(executable).name for executable in executables)
    for executable in executables:
        name, what, usage, flags, more = pages_of(executable)
        others = [other for other in names if other != name]
        text = "\n".join(man_page(version, name, what, usage, flags, more, others)) + "\n"
        (out / "man1" / f"{name}.1.gz").write_bytes(gzip.compress(text.encode(), mtime=0))
        (out / "completions" / name).write_text(completion(name, flags), encoding="utf-8")


if __name__ == "__main__":
    main()
