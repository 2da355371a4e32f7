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

# "  --flag   what it does", or with a short form and the word for its value before that.
FLAG = re.compile(r"^ {2}(?:-\w(?:, | \w+, ))?--(?:\[no\])?([\w-]+)(?:[ =](?:\S+))?(?:\s{2,}(.*))?$")


def pages_of(executable):
    """What an executable is, how it is called, and (section, flag, words) of its flags."""
    run = subprocess.run([executable, "--help"], capture_output=True, text=True, check=False)
    if run.returncode:
        sys.exit(f"{executable} --help ends with {run.returncode}: {run.stderr}")
    lines = run.stdout.splitlines()
    name = pathlib.Path(executable).name
    flags, words, usage, section = [], [], [], "Options"
    for line in lines:
        found = FLAG.match(line)
        if found:
            flags.append([section, found[1], found[2] or ""])
        elif flags and line.startswith(" " * 8):
            flags[-1][2] += " " + line.strip()
        elif re.fullmatch(r"\w+:?", line.strip()) and not line.startswith(" "):
            section = line.strip().rstrip(":").capitalize()
        elif name in line and not flags:
            usage.append(re.sub(r"^usage:\s*", "", line.strip()))
        elif line.strip():
            words.append(line.strip())
    return name, words[0] if words else name, usage or [name], flags, words[1:]


def roff(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text[:1] in (".", "'") else text


def man_page(version, name, what, usage, flags, more):
    yield f'.TH {name.upper()} 1 "" "finray {version}" "finray"'
    yield f".SH NAME\n{name} \\- {roff(what.rstrip('.'))}"
    yield ".SH SYNOPSIS\n" + "\n.br\n".join(roff(line) for line in usage)
    last = None
    for section, flag, words in flags:
        if section != last:
            yield f".SH {section.upper()}"
            last = section
        yield ".TP\n\\fB\\-\\-" + roff(flag) + "\\fR\n" + (roff(words) or "\\&")
    if more:
        yield ".SH NOTES"
        yield from ("\n.PP\n" + roff(line) for line in more)
    yield ".SH SEE ALSO\nThe documentation of finray: formats, commands and guides."


def completion(name, flags):
    words = " ".join("--" + flag for _, flag, _ in flags)
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
    version, out, executables = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3:]
    for folder in ("man1", "completions"):
        (out / folder).mkdir(parents=True, exist_ok=True)
    for executable in executables:
        name, what, usage, flags, more = pages_of(executable)
        text = "\n".join(man_page(version, name, what, usage, flags, more)) + "\n"
        (out / "man1" / f"{name}.1.gz").write_bytes(gzip.compress(text.encode(), mtime=0))
        (out / "completions" / name).write_text(completion(name, flags), encoding="utf-8")


if __name__ == "__main__":
    main()
