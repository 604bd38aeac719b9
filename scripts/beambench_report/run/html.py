"""Provides the templates and embedded images of all HTML pages."""

import base64
import io
import re
from collections.abc import Sequence
from functools import cache
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup
from PIL import Image

from beambench_report.base.files import ROOT, Problem
from beambench_report.base.quantities import duration_in_words, number

TEMPLATES = Path(__file__).with_name("templates")
_INSTALLED = Path(__file__).with_name("library")
LIBRARY = _INSTALLED if _INSTALLED.is_dir() else ROOT / "build/viewer"
"""Where scripts/viewer put DataTables; in an installed package it is beside this file."""
_SCRIPTS = ("dataTables.min.js", "dataTables.columnControl.min.js")
_STYLE = ("columnControl.dataTables.min.css",)
_WITHOUT_LIBRARY = (
    "The tables of this page cannot be sorted or filtered, because DataTables was not found when "
    "the page was written; fetch it with scripts/viewer, and write the page again."
)
_TYPES = {".png": "image/png", ".svg": "image/svg+xml"}


@cache  # a template is compiled once for many pages
def environment(*own: Path) -> Environment:
    """Returns an environment that finds templates in `own`, then among the shared templates."""
    folders = [*own, TEMPLATES]
    made = Environment(
        loader=FileSystemLoader(folders),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )

    # Style and scripts are not templates: their braces are literal.
    def raw(name: str) -> Markup:
        path = next(folder / name for folder in folders if (folder / name).exists())
        return Markup(path.read_text("utf-8"))

    scripts, style = _library(_SCRIPTS), _library(_STYLE)
    made.globals["raw"] = raw
    made.globals["library_scripts"], made.globals["library_style"] = scripts, style
    made.globals["without_library"] = "" if scripts else _WITHOUT_LIBRARY
    made.filters["duration"] = duration_in_words
    made.filters["number"] = number
    made.filters["order"] = _order
    made.filters["slug"] = lambda text: "-".join(re.findall(r"[a-z0-9]+", str(text).lower()))
    made.filters["as_script_data"] = Markup  # `pack` has escaped anything that would end a script
    return made


def _order(value: float | str | None) -> str:
    """Returns the sort key of a table's field; empty if the field was not measured."""
    if value is None or value != value:
        return ""
    return value if isinstance(value, str) else f"{value:.6g}"


def _library(names: Sequence[str]) -> Markup:
    """Returns files of DataTables, joined; empty if DataTables was not fetched."""
    paths = [LIBRARY / name for name in names]
    if not all(path.is_file() for path in paths):
        return Markup()
    return Markup("\n".join(path.read_text("utf-8") for path in paths))


_THUMBNAIL = (640, 480)  # pixels, at most; a page shows pictures at half this size


def thumbnail_uri(path: Path) -> str:
    """Returns a reduced copy of a picture as a data URI; the file itself is unchanged."""
    try:
        small = Image.open(path).convert("RGB")
    except OSError as error:
        raise Problem(f"{path}: cannot be read as a picture ({error}); render it again") from None
    small.thumbnail(_THUMBNAIL)
    coded = io.BytesIO()
    small.save(coded, "WEBP", quality=85)
    return f"data:image/webp;base64,{base64.b64encode(coded.getvalue()).decode('ascii')}"


def data_uri(path: Path) -> str:
    """Returns the bytes of an image as a data URI."""
    coded = base64.b64encode(path.read_bytes()).decode("ascii")
    return f"data:{_TYPES[path.suffix]};base64,{coded}"
