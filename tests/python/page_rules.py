"""Rules for pages of results: rankings have intervals, and linked pages state the same figures."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

_NUMBER = r"\d[\d,]*(?:\.\d+)?"
_INTERVAL = rf"\((?:{_NUMBER} to {_NUMBER}|no interval)\)"
_SPEED = r"(?:as (?:fast|long|slow)|faster|slower)\b"
# A factor or percentage, the parentheses before and after `times`, and the words of a ranking.
_RANKING = re.compile(
    rf"(?P<takes>\btakes? |\btook )?(?P<figure>{_NUMBER}%?)(?P<before> \([^()]*\))?"
    rf"(?: times(?P<behind> \([^()]*\))? {_SPEED}| (?:percent )?(?:faster|slower)\b"
    r"|(?P<share> of the time (?:of|that)\b))"
)
_HEADED = re.compile(rf"times {_SPEED}", re.IGNORECASE)
_UNRANKED = re.compile(r"without (?:an |their )?intervals?|unranked", re.IGNORECASE)
"""Words that mark figures as unranked."""
_BARE_RATIO = re.compile(rf"[*_†\s]*({_NUMBER})[*_†\s]*")
_STATED = re.compile(rf"{_NUMBER} \({_NUMBER} to {_NUMBER}\)")
_LINK = re.compile(r"\]\(([^()#]+)(?:#[^()]*)?\)")
_NOT_READ = re.compile(r"```.*?```|<!--.*?-->", re.DOTALL)


@dataclass(frozen=True)
class Fault:
    """A place in a page that breaks a rule."""

    file: Path
    line: int
    words: str

    def __str__(self) -> str:
        """Returns the place and the fault."""
        return f"{self.file}:{self.line}: {self.words}"


@dataclass(frozen=True)
class Block:
    """A paragraph, an item of a list, or a table."""

    line: int
    lines: list[str]
    lead: str
    """The paragraphs between the last heading and this block."""

    @property
    def is_table(self) -> bool:
        """Returns whether the block consists of rows with cells."""
        return self.lines[0].startswith("|")

    @property
    def text(self) -> str:
        """The words of the block on one line."""
        return " ".join(line.strip() for line in self.lines)


def blocks(text: str) -> Iterator[Block]:
    """Yields the parts of a page in their order; code and comments are left out."""
    text = _NOT_READ.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), text)
    lead: list[str] = []
    own: list[str] = []
    for number, line in enumerate([*text.split("\n"), ""], 1):
        is_row = line.startswith("|")
        is_heading = line.startswith("#")
        is_item = re.match(r"\s*(?:-|\d+\.) ", line) is not None
        ends = not line.strip() or is_heading or is_item
        if own and (ends or is_row != own[0].startswith("|")):
            block = Block(number - len(own), own, " ".join(lead))
            yield block
            if not block.is_table and not re.match(r"\s*(?:-|\d+\.) ", own[0]):
                lead.append(block.text)
            own = []
        if is_heading:
            lead = []
        elif line.strip():
            own.append(line)


def bare_rankings(page: Path) -> Iterator[Fault]:
    """Yields each "N times as fast as" without an interval, in a sentence or a table.

    Figures that a section calls unranked, or without intervals, are not rankings.
    """
    for block in blocks(page.read_text("utf-8")):
        if _UNRANKED.search(block.lead + " " + block.text):
            continue
        if not block.is_table:
            for found in _RANKING.finditer(block.text):
                if found["share"] and not found["takes"]:
                    continue
                beside = f"{found['before'] or ''}{found['behind'] or ''}"
                if not re.search(_INTERVAL, beside):
                    yield Fault(page, block.line, f"'{found[0]}' has no interval")
        elif _HEADED.search(block.lead):
            names = _cells(block.lines[0])
            for line, row in enumerate(block.lines[2:], block.line + 2):
                for name, cell in zip(names[1:], _cells(row)[1:], strict=False):
                    found = _BARE_RATIO.fullmatch(cell)
                    if found and "." in found[1]:
                        yield Fault(page, line, f"'{found[1]}' ({name}) has no interval")


def stated_otherwise(page: Path) -> Iterator[Fault]:
    """Yields each ratio with an interval that no linked page states with the same digits.

    A table is checked against the links in the paragraphs above it, a sentence against the links in
    its own paragraph. A linked README includes the reports beside it.
    """
    for block in blocks(page.read_text("utf-8")):
        where = block.lead if block.is_table else block.text
        linked = [page.parent / target for target in _LINK.findall(where)]
        texts = [_every_text(one) for one in linked if one.suffix == ".md" and one.is_file()]
        if not texts:
            continue
        for line, row in enumerate(block.lines if block.is_table else [block.text], block.line):
            for figure in _STATED.findall(row):
                if not any(figure in text for text in texts):
                    yield Fault(page, line, f"'{figure}' is in none of the linked pages")


def _cells(row: str) -> list[str]:
    return [cell.strip() for cell in row.strip().strip("|").split("|")]


def _every_text(page: Path) -> str:
    """Returns a page and the reports beside it, each text on one line."""
    pages = [page, *page.parent.glob("*.md")] if page.name == "README.md" else [page]
    return " ".join(" ".join(one.read_text("utf-8").split()) for one in pages)
