"""The data dictionary: what every column of results.csv means (columns.json is its source)."""

import json
import re
import textwrap
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import Literal

from beambench import structures
from beambench_report.base.quantities import markdown_table

_SOURCE = Path(__file__).parents[1] / "columns.json"
COUNTER_SUFFIX = "_per_ray"
RENAMED_COLUMNS = {  # name in older records: name today
    "neighbour_searches_per_ray": "neighbor_searches_per_ray",
    "neighbour_steps_per_ray": "neighbor_steps_per_ray",
    "engine_error": "structure_error",
    "eye_rays": "camera_rays",
    "total_mcycles_repeat_low": "total_mcycles_pi_low",
    "total_mcycles_repeat_high": "total_mcycles_pi_high",
    **{
        f"eye_{counter}_per_ray": f"camera_{counter}_per_ray"
        for counter in "traversal_steps leaves empty_leaves box_tests primitive_tests".split()
    },
}
_KINDS = "(camera|reflected|refracted|shadow)"  # of the rays of a whole picture


@dataclass(frozen=True)
class Column:
    """One column: its contents, its unit, and how it is measured."""

    name: str
    group: str
    type: Literal["text", "flag", "integer", "number"]
    unit: str
    meaning: str
    measured: str

    @property
    def is_number(self) -> bool:
        """Whether the values are numbers."""
        return self.type in ("integer", "number")

    @property
    def is_pattern(self) -> bool:
        """Whether the name is a pattern for many columns, such as the columns of counters."""
        return "<" in self.name

    @property
    def is_of_a_kind(self) -> bool:
        """Whether the column describes one kind of rays of a whole picture."""
        return "<kind>" in self.name

    def is_that(self, name: str) -> bool:
        """Returns whether this is the entry for the column `name` of a file."""
        if not self.is_pattern:
            return name == self.name
        pattern = self.name.replace("<kind>", _KINDS).replace("<counter>", "[a-z_]+")
        return re.fullmatch(pattern, name) is not None


@dataclass(frozen=True)
class Group:
    """Related columns, in their order."""

    name: str
    title: str
    columns: tuple[Column, ...]


@dataclass(frozen=True)
class Dictionary:
    """All columns of one version of results.csv."""

    schema_version: int
    groups: tuple[Group, ...]

    @cached_property
    def columns(self) -> tuple[Column, ...]:
        """Returns every column in the order of the file."""
        return tuple(column for group in self.groups for column in group.columns)

    def find(self, name: str) -> Column | None:
        """Returns the entry for a file's column: the one with its name or the narrowest pattern."""
        if name not in self._found:
            found = [column for column in self.columns if column.is_that(name)]
            # A pattern with `<kind>` is narrower than the pattern of all counters.
            narrowest = min(
                found, key=lambda one: (one.is_pattern, not one.is_of_a_kind), default=None
            )
            self._found[name] = narrowest
        return self._found[name]

    @cached_property
    def _found(self) -> dict[str, Column | None]:
        """Caches the results of `find`, because every reader needs the same columns."""
        return {}


@cache
def dictionary() -> Dictionary:
    """Returns the dictionary of the records that this version reads."""
    source = json.loads(_SOURCE.read_text("utf-8"))
    columns = [Column(**entry) for entry in source["columns"]]
    groups = tuple(
        Group(**entry, columns=tuple(column for column in columns if column.group == entry["name"]))
        for entry in source["groups"]
    )
    return Dictionary(source["schema_version"], groups)


_READING = (
    "In pandas (a reader that takes `null` for a missing value loses the rows of that structure):",
    "",
    "```python",
    "import matplotlib.pyplot as plt",
    "import pandas as pd",
    "",
    'rows = pd.read_csv("results.csv", keep_default_na=False, na_values=[""])',
    'rows = rows[rows["trace_ms_median"].notna()]  # the cells whose hits are correct',
    'rows["ns_per_ray"] = 1e6 * rows["trace_ms_median"] / rows["rays"]',
    'by_structure = rows.groupby("structure")["ns_per_ray"].median().sort_values()',
    "print(by_structure)",
    'by_structure.plot.barh(logx=True, xlabel="median ns per ray (lower is better)")',
    'plt.savefig("structures.png", bbox_inches="tight")',
    "```",
)
"""A test runs this code."""


def as_markdown(known: Dictionary) -> str:
    """Returns the dictionary as the text of results/README.md."""
    introduction = (
        f"Schema version {known.schema_version}. A row is a cell of a sweep: one structure with "
        "one set of parameters, tracing one set of rays. The file is UTF-8 with one header row "
        "and quotes as in RFC 4180. An empty field means not measured; `null` is the name of a "
        "structure. A string that begins with `=`, `+`, `-` or `@`, which a spreadsheet would take "
        "for a formula, or with an apostrophe is preceded by an apostrophe. In file names, a code "
        "such as `\\x1b` stands for an unprintable byte, and two backslashes stand for one."
    )
    lines = [
        "# The columns of results.csv",
        "",
        "<!-- Written by `python -m beambench_report columns` from columns.json: edit that. -->",
        "",
        textwrap.fill(introduction, 100),
        "",
        *_READING,
    ]
    for group in known.groups:
        rows = ((f"`{c.name}`", c.type, c.unit, c.meaning, c.measured) for c in group.columns)
        heads = ("column", "type", "unit", "meaning", "how it is measured")
        lines += ["", f"## {group.title}", "", *markdown_table(heads, rows)]
    every = structures()
    common = set.intersection(*(set(one.counters) for one in every))
    counters = (
        (f"`{one.name}`", f"`{name}`", meaning)
        for one in every
        for name, meaning in one.counters.items()
        if name not in common
    )
    lines += [
        "",
        "## Counters of single structures",
        "",
        "`beambench list --counters` prints these counters. Each has a column,",
        "`<counter>_per_ray`; its value times `rays` is the count.",
        "[accel/beam](../accel/beam/README.md) explains the counters of the beams.",
        "",
        *markdown_table(("structure", "counter", "meaning"), counters),
    ]
    return "\n".join(lines) + "\n"
