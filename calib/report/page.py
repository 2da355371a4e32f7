"""What all pages share: templates and YAML."""

import pathlib
import re

import jinja2
import yaml


class _Loader(yaml.SafeLoader):
    """Takes 1e+07 for a number, as YAML 1.2 and finray do; PyYAML alone takes it for text."""


_Loader.add_implicit_resolver("tag:yaml.org,2002:float", re.compile(r"[-+]?(\d+(\.\d*)?|\.\d+)[eE][-+]?\d+$"),
                              list("-+.0123456789"))


def load_yaml(text):
    return yaml.load(text, _Loader)


def environment(*folders, undefined=jinja2.StrictUndefined):
    """Templates of these folders, and the style sheet beside this file. `undefined`
    says what a value that is missing does."""
    return jinja2.Environment(
        loader=jinja2.FileSystemLoader([*folders, pathlib.Path(__file__).parent]),
        autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=undefined)
