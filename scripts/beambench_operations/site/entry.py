"""The site's record of a run: its line in the index, and its cells for comparisons.

It is JSON within a script, `runs/<name>/data.js`, so that a page opened as a file can load it. A
run whose files have not changed since is not read again.
"""

import json
from collections import Counter
from collections.abc import Mapping
from dataclasses import asdict, astuple, dataclass
from functools import cache
from hashlib import sha256
from pathlib import Path

from beambench.analysis import Median, Ratio
from beambench_operations.history.night import comparable, counters_of, inputs_of
from beambench_report.base.analysis import Analysis, has_analysis, read_analysis
from beambench_report.base.cell_files import (
    CellFile,
    Identity,
    identity,
    median_of,
    ratio_of,
    read_cell_files,
)
from beambench_report.base.machine import Machine, Manifest, machine_of, read_manifest
from beambench_report.base.records import (
    FAULTLESS_VERDICTS,
    NO_RAYS,
    Run,
    contenders_with_times,
    in_blocks,
    size_of,
)
from beambench_report.run.html import LIBRARY

_BAR = " | "
_BEGIN, _END = "beambench.add(", ");\n"


Ends = tuple[float, float | None, float | None]
"""A figure and its 95% confidence interval."""


@dataclass(frozen=True)
class Cell:
    """One cell in compact form: figures have five digits."""

    key: str
    """The key that identifies it in every run: the columns of `IDENTITY`."""
    view: str
    size: str
    contender: str
    verdict: str
    inputs: str
    """A hash of scene and rays; cells with different hashes are not compared."""
    work: str
    """A hash of its counters."""
    ms: Ends | None
    """Build and trace together, with their interval; None if no time counts."""
    ratio: Ends | None
    """The ratio of this time to the reference of the same run, paired if the repetitions are known.
    """

    @property
    def who(self) -> str:
        """Structure and parameters, as `Entry.reference` has them."""
        return " ".join(self.key.split(_BAR)[2:4])

    @property
    def rays(self) -> str:
        """The key of the rays: cells with the same rays have one reference."""
        parts = self.key.split(_BAR)
        return _BAR.join(parts[:2] + parts[4:])


@dataclass(frozen=True)
class Entry:
    """A run in the index."""

    run_id: str
    time: str
    commit: str
    dirty: bool
    machine_ids: tuple[str, ...]
    processor: str
    sweep: str
    in_blocks: bool
    """Whether the run was measured in blocks. Other runs are not compared with such runs."""
    cut_off: bool
    wrong: int
    without_rays: int
    doubts: tuple[str, ...] | None
    """Reasons to distrust the times; None if they were not recorded."""
    timed: int
    fastest: tuple[str, ...]
    """The winner for each ray kind."""
    reference: str
    """The reference of the ratios; empty if no contender has times."""
    cells: tuple[Cell, ...]

    @property
    def machine(self) -> Machine:
        """The machine on which the run was measured."""
        return Machine(self.machine_ids, self.processor)

    @property
    def machine_title(self) -> str:
        """Returns the processor or, if it is unknown, the machine's number."""
        return self.processor or " and ".join(self.machine_ids)

    @property
    def date(self) -> str:
        """Returns the date and time as tables show them."""
        return self.time.replace("T", " ").replace("Z", "")[:16] or "no date"


def entry_of(run: Run) -> Entry:
    """Reads the parts of a run that the site needs."""
    rows = run.rows
    manifest = read_manifest(run.directory) or Manifest()
    files = read_cell_files(run.directory)
    newest = rows.iloc[-1]
    analysis = read_analysis(run.directory) if has_analysis(run.directory) else None
    machine = machine_of(rows, run.directory)
    reference = _reference(run)
    return Entry(
        run_id=newest["run_id"],
        time=manifest.begun or str(newest.get("time_utc", "")),
        commit=newest["commit"],
        dirty=bool((rows["dirty"] == "true").any()),
        machine_ids=machine.ids,
        processor=machine.processor,
        sweep=manifest.sweep,
        in_blocks=in_blocks(rows),
        cut_off=manifest.cut_off,
        wrong=int((~rows["verdict"].isin(FAULTLESS_VERDICTS)).sum()),
        without_rays=int((rows["verdict"] == NO_RAYS).sum()),
        doubts=analysis.reasons_for_care if analysis else None,
        timed=int(rows["timed"].sum()),
        fastest=_fastest(analysis) if analysis else (),
        reference=" ".join(reference) if reference else "",
        cells=_cells(run, files, reference),
    )


def _reference(run: Run) -> tuple[str, str] | None:
    """Returns structure and parameters: Embree's single rays, or else the contender with times in
    the most cells.
    """
    timed = contenders_with_times(run.rows)
    counts = Counter(zip(timed["structure"], timed["parameters"], strict=True))

    def preference(who: tuple[str, str]) -> tuple[bool, bool, int, tuple[str, str]]:
        is_embree = who[0] == "embree"
        return (is_embree and "mode=single" in who[1], is_embree, counts[who], who)

    return max(counts, key=preference, default=None)


def _fastest(analysis: Analysis) -> tuple[str, ...]:
    """Returns the contender with the least mean trace time, and its number of wins."""
    several = len(analysis.means) > 1
    return tuple(
        f"{f'{one.ray_kind}: ' if several else ''}{first.contender} ({first.wins} of {one.views})"
        for one in analysis.means
        for first in one.means[:1]
    )


def _cells(
    run: Run, files: Mapping[Identity, CellFile], reference: tuple[str, str] | None
) -> tuple[Cell, ...]:
    rows = run.rows.to_dict("records")
    views, work, inputs = (of(run.rows) for of in (comparable, counters_of, inputs_of))
    bases = {
        view: row
        for view, row in zip(views, rows, strict=True)
        if (row["structure"], row["parameters"]) == reference
        and row["timed"]
        and row["total_ms_median"] > 0
    }
    cells = []
    for row, view, counters, hashes in zip(rows, views, work, inputs, strict=True):
        timed = row["timed"] and row["total_ms_median"] > 0
        ratio = ratio_of("total", row, bases[view], files) if timed and view in bases else None
        cells.append(
            Cell(
                _BAR.join(identity(row)),
                row["view"],
                size_of(row),
                row["contender"],
                row["verdict"],
                _digest(hashes),
                _digest(counters),
                _small(median_of(row, "total")) if timed else None,
                _small(ratio) if ratio else None,
            )
        )
    return tuple(cells)


def _digest(text: str) -> str:
    return sha256(text.encode()).hexdigest()[:8]


def _small(figure: Median | Ratio) -> Ends:
    ends = (figure.value, figure.low, figure.high)
    return tuple(None if end is None else float(f"{end:.5g}") for end in ends)


def as_script(name: str, entry: Entry, stamp: str) -> str:
    """Returns the text of data.js."""
    source = asdict(entry) | {
        "name": name,
        "stamp": stamp,
        "cells": [astuple(cell) for cell in entry.cells],
    }
    return _BEGIN + json.dumps(source, separators=(",", ":")) + _END


def read_script(path: Path, name: str, stamp: str) -> Entry | None:
    """Returns the entry of a file written under this name and stamp; None otherwise."""
    try:
        text = path.read_text("utf-8")
        source = json.loads(text.removeprefix(_BEGIN).removesuffix(_END))
        if (source.pop("name"), source.pop("stamp")) != (name, stamp):
            return None
        cells = tuple(Cell(*map(_frozen, cell)) for cell in source.pop("cells"))
        return Entry(cells=cells, **{key: _frozen(value) for key, value in source.items()})
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return None  # missing or of another version: it is rewritten


def _frozen(value: object) -> object:
    return tuple(value) if isinstance(value, list) else value


def stamp_of(directory: Path) -> str:
    """Returns a stamp that changes with the files of a run and the code that makes its pages."""
    return sha256(f"{_state(directory)}{_code()}".encode()).hexdigest()


@cache
def _code() -> str:
    scripts = Path(__file__).parents[2]
    folders = (scripts / "beambench_report", scripts / "beambench_operations", LIBRARY)
    return "\n".join(map(_state, folders))


def _state(folder: Path) -> str:
    states = []
    for path in sorted(folder.resolve().rglob("*")):
        if path.is_file() and path.suffix != ".pyc":
            status = path.stat()
            states.append(f"{path} {status.st_size} {status.st_mtime_ns}")
    return "\n".join(states)
