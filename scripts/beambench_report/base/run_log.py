"""Reads run.jsonl, the log of a run, to which `beambench run` adds a line for each event.

The events are described in harness/measure/record/run_log.hpp. Anything after the last complete
line is ignored: the run was cut off there.
"""

import gzip
import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from beambench_report.base.files import Problem

LOG = "run.jsonl"
PACKED_LOG = "run.jsonl.gz"

Event = dict[str, object]
Repetition = dict[str, float]
"""One repetition, with a member for each figure in the log; `round` numbers its turn."""


@dataclass
class LoggedCell:
    """One cell of a log."""

    facts: Event
    """The facts of the cell; the members that identify it have the names of the columns."""
    repetitions: list[Repetition] = field(default_factory=list)
    verdict: str = ""
    message: str = ""
    examples: tuple[str, ...] = ()
    is_finished: bool = False


def has_log(run: Path) -> bool:
    """Returns whether this folder contains the log of a run, compressed or not."""
    return _log_in(run).is_file()


def _log_in(run: Path) -> Path:
    return run / (LOG if (run / LOG).is_file() else PACKED_LOG)


def logged_cells(run: Path) -> list[LoggedCell]:
    """Returns the cells of RUN/run.jsonl in the order of the plan; empty without a log.

    Raises Problem naming a line that is malformed.
    """
    cells: dict[int, LoggedCell] = {}
    for place, event in _events(run):
        try:
            _take(event, cells)
        except (KeyError, TypeError, ValueError) as error:
            raise Problem(
                f"{place}: not an event of a run ({type(error).__name__}: {error}); measure it anew"
            ) from None
    return [cells[index] for index in sorted(cells)]


def _events(run: Path) -> Iterator[tuple[str, Event]]:
    """Yields each event with its position."""
    path = _log_in(run)
    if not path.is_file():
        return
    with (gzip.open if path.name == PACKED_LOG else open)(path, "rt", encoding="utf-8") as file:
        for number, line in enumerate(file, 1):
            if not line.endswith("\n"):
                return
            try:
                yield f"{path}, line {number}", json.loads(line)
            except (ValueError, RecursionError) as error:
                raise Problem(f"{path}, line {number}: is not JSON ({error})") from None


def _take(event: Event, cells: dict[int, LoggedCell]) -> None:
    kind = event["event"]
    if kind == "cell":
        cells.setdefault(event["index"], LoggedCell(event)).facts = event
    elif kind == "repetition":
        cells[event["index"]].repetitions.append(event)
    elif kind == "verification":
        cells[event["index"]].verdict = event["verdict"]
    elif kind == "finished":
        cell = cells[event["index"]]
        cell.verdict, cell.is_finished = event["verdict"], True
        cell.message = event.get("message", "")
        cell.examples = tuple(event.get("examples", ()))
