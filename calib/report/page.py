"""What all pages share: templates, and files that appear whole or not at all."""

import pathlib

import jinja2


def environment(*folders, undefined=jinja2.StrictUndefined):
    """Templates of these folders, and the style sheet beside this file. `undefined`
    says what a value that is missing does."""
    return jinja2.Environment(
        loader=jinja2.FileSystemLoader([*folders, pathlib.Path(__file__).parent]),
        autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=undefined)


def write(path, text):
    temporary = path.with_name(path.name + ".part")
    temporary.write_text(text, "utf-8")
    temporary.rename(path)
