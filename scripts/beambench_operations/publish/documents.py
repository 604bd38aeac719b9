"""The texts of results/published, each computed from the rows in its folder.

A template FOLDER/README.md.j2 makes FOLDER/README.md: it contains the sentences, with an expression
for each figure. Its variables are computed by `figures/FOLDER.py`. The template of the page of
findings uses the figures of every folder, under the folder's name with _ instead of -.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, partial
from importlib import import_module
from importlib.util import find_spec
from itertools import islice, zip_longest
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined, TemplateError

from beambench_operations.publish.figures.cells import counted
from beambench_operations.publish.figures.formats import FILTERS, cited, holds
from beambench_operations.publish.figures.origins import made, origins
from beambench_operations.publish.layout import laid_out
from beambench_operations.publish.reports import report, report_names
from beambench_report.base.files import ROOT, Problem, write_text

PUBLISHED = ROOT / "results/published"
SUFFIX = ".j2"


@dataclass(frozen=True)
class Document:
    """A text that a command writes."""

    path: Path
    source: Path
    """Its template, or the folder of the run that it reports on."""
    text: Callable[[], str]


def documents(published: Path = PUBLISHED) -> list[Document]:
    """Returns every computed text of the published runs, in the order of their paths."""
    return sorted((*_rendered(published), *_reports(published)), key=lambda one: one.path)


def write_documents(published: Path = PUBLISHED) -> list[Path]:
    """Writes the texts that changed; returns them."""
    changed = []
    for document in documents(published):
        text = document.text()
        if not document.path.is_file() or document.path.read_text("utf-8") != text:
            changed.append(write_text(document.path, text))
    return changed


@dataclass(frozen=True)
class Difference:
    """A line of a published text that differs from the text computed from its rows."""

    file: Path
    line: int
    stated: str
    computed: str

    def __str__(self) -> str:
        """Returns the fault and the remedy."""
        return (
            f"{self.file}:{self.line}: states '{self.stated}', but the rows give "
            f"'{self.computed}'; edit the template, or run scripts/publish --texts"
        )


def differences(published: Path = PUBLISHED) -> list[Difference]:
    """Returns, for each text that is out of date, its first line that differs."""
    found = []
    for document in documents(published):
        stated = document.path.read_text("utf-8") if document.path.is_file() else ""
        both = (text.split("\n") for text in (stated, document.text()))
        lines = enumerate(zip_longest(*both, fillvalue=""), 1)
        found += [
            Difference(document.path, number, *pair)
            for number, pair in islice((one for one in lines if one[1][0] != one[1][1]), 1)
        ]
    return found


def _reports(published: Path) -> Iterator[Document]:
    for name in report_names():
        path = published / name
        if path.parent.is_dir():
            yield Document(path, path.parent, partial(report, name, path.parent))


def _rendered(published: Path) -> Iterator[Document]:
    environment = Environment(
        loader=FileSystemLoader(published),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
    )
    environment.filters |= FILTERS
    environment.globals |= {"cited": cited, "holds": holds, "plot": _plot}
    known = _Folders(published)
    for template in sorted(published.rglob(f"*.md{SUFFIX}")):
        name = str(template.relative_to(published))
        yield Document(
            template.with_suffix(""),
            template,
            lambda template=template, name=name: _render(environment, template, name, known),
        )


def _plot(folder: Path, stem: str) -> str:
    """Returns the name of a plot: the SVG if there is one, else the PNG of an earlier commit."""
    is_png = (folder / f"{stem}.png").is_file() and not (folder / f"{stem}.svg").is_file()
    return f"{stem}.png" if is_png else f"{stem}.svg"


def _render(environment: Environment, template: Path, name: str, known: _Folders) -> str:
    folder = template.parent
    note = (
        f"<!-- Written by `scripts/publish --texts` from {template.name} and the rows in "
        "this folder; edit the template. -->\n"
    )
    try:
        own = known.all() if folder == known.published else known.of(folder.name)
        text = environment.get_template(name).render(own | {"made": made, "folder": folder})
    except (TemplateError, LookupError, ValueError, TypeError, ZeroDivisionError) as error:
        line = getattr(error, "lineno", None) or _line_of(error, template)
        says_all = isinstance(error, TemplateError | ValueError)
        what = getattr(error, "message", error) if says_all else repr(error)
        raise Problem(f"{template}{f':{line}' if line else ''}: {what}") from None
    title, _, rest = text.partition("\n")
    return f"{title}\n{note}{laid_out(rest)}"


def _line_of(error: BaseException, template: Path) -> int | None:
    """Returns the line of a template at which rendering stopped."""
    trace, line = error.__traceback__, None
    while trace:
        if trace.tb_frame.f_code.co_filename == str(template):
            line = trace.tb_lineno
        trace = trace.tb_next
    return line


class _Folders:
    """The figures of the published folders, each computed once, when needed."""

    def __init__(self, published: Path) -> None:
        self.published = published
        self.of = cache(self._of)

    def _of(self, name: str) -> dict[str, Any]:
        folder = self.published / name
        module = module_of(name)
        computed = import_module(module).figures(folder) if module else {}
        return computed | {"origins": origins(folder)}

    def all(self) -> dict[str, Any]:
        """Returns the variables of the page over all folders."""
        names = sorted(one.name for one in self.published.iterdir() if one.is_dir())
        by_identifier = {_identifier(name): self.of(name) for name in names}
        return {"folders": names, "every": counted(self.published)} | by_identifier


def _identifier(name: str) -> str:
    return re.sub(r"\W", "_", name)


def module_of(name: str) -> str | None:
    """Returns the module that computes a folder's figures; None if there is none."""
    module = f"beambench_operations.publish.figures.{_identifier(name)}"
    return module if find_spec(module) else None
