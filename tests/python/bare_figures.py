"""Figures that a template states without computing them."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

# Not measurements: expressions, code, targets of links, comments, and confidence levels of
# intervals.
_COMPUTED = re.compile(
    r"\{\{.*?\}\}|\{%.*?%\}|\{#.*?#\}|```.*?```|``.*?``|`[^`\n]*`|\]\([^)]*\)|<!--.*?-->"
    r"|95%\s(?:prediction\s|confidence\s)?intervals?"
    r"|(?:section|tables?|figures?) \d[\d.]*(?: and \d[\d.]*)?",
    re.DOTALL,
)
_UNITS = "times|ms|ns|s|min|h|MB|GB|KB|bytes|cells|rays|percent|points"
_FIGURE = re.compile(
    rf"(?<![\w.,-])(?:\d+(?:,\d{{3}})+(?:\.\d+)?|\d+\.\d+|\d+\s?%|\d+ (?:{_UNITS})\b)"
)


@dataclass(frozen=True)
class BareFigure:
    """A figure in the sentences of a template."""

    file: Path
    line: int
    figure: str

    def __str__(self) -> str:
        """Returns the fault and the remedy."""
        return (
            f"{self.file}:{self.line}: states {self.figure} without computing it; name it in an "
            "expression, or with cited() where another work states it"
        )


def bare_figures(template: Path) -> Iterator[BareFigure]:
    """Yields decimal fractions, percentages, counts of thousands, and numbers with a unit."""
    text = template.read_text("utf-8")
    left = _COMPUTED.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), text)
    for found in _FIGURE.finditer(left):
        yield BareFigure(template, left.count("\n", 0, found.start()) + 1, found[0])
