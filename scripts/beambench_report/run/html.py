"""What all HTML pages share: templates, and images that bring their own bytes."""

import base64
from functools import cache
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from beambench_report.base.quantities import duration_in_words, number

TEMPLATES = Path(__file__).with_name("templates")
_TYPES = {".png": "image/png", ".svg": "image/svg+xml"}


@cache  # a template is compiled once for many pages
def environment(*own: Path) -> Environment:
    """Templates of the folders `own`, before those that all pages share."""
    folders = [*own, TEMPLATES]
    made = Environment(
        loader=FileSystemLoader(folders),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )

    # Style and scripts are not templates: their braces are their own.
    def raw(name: str) -> Markup:
        path = next(folder / name for folder in folders if (folder / name).exists())
        return Markup(path.read_text("utf-8"))

    made.globals["raw"] = raw
    made.filters["duration"] = duration_in_words
    made.filters["number"] = number
    made.filters["as_script_data"] = Markup  # `pack` has escaped what would end a script
    return made


def data_uri(path: Path) -> str:
    """The bytes of an image as an address."""
    coded = base64.b64encode(path.read_bytes()).decode("ascii")
    return f"data:{_TYPES[path.suffix]};base64,{coded}"
