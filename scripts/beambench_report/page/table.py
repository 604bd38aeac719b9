"""Tables of the page: what a heading and a field hold."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Heading:
    """The head of a column; `column` names its entry in the data dictionary."""

    title: str
    unit: str = ""
    column: str = ""
    is_number: bool = True


@dataclass(frozen=True)
class Field:
    """A field: what is read, what it sorts by, and smaller words behind it."""

    text: str
    value: float | str | None
    note: str = ""


@dataclass(frozen=True)
class Line:
    """A contender's line; the shares are those of its bar, 1 being the whole width."""

    contender: str
    colour: str
    verdict: str
    fields: tuple[Field, ...]
    build_share: float = 0.0
    trace_share: float = 0.0
    off_the_scale: bool = False


@dataclass(frozen=True)
class Table:
    """Headings and lines; lines beyond what a page can show are counted only."""

    caption: str
    headings: tuple[Heading, ...]
    lines: tuple[Line, ...]
    unshown: int = 0
