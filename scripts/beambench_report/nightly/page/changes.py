"""What is different from another night: ratios, work, verdicts, cells that came or went."""

from __future__ import annotations

from dataclasses import dataclass, field

import pandas as pd

from beambench_report.nightly.night import Night

NOTEWORTHY = 0.02
_MOST = 25


@dataclass(frozen=True)
class Change:
    """One cell's ratio, then and now."""

    contender: str
    view: str
    size: str
    before: float
    after: float

    @property
    def share(self) -> float:
        """0.05: slower by 5%."""
        return self.after / self.before - 1


@dataclass(frozen=True)
class Changes:
    """A night beside another one."""

    name: str
    run_id: str
    commit: str
    changes: list[Change] = field(default_factory=list)
    """The largest ones, slower or faster."""
    slower: int = 0
    faster: int = 0
    compared: int = 0
    sentences: list[str] = field(default_factory=list)


def compare_nights(name: str, tonight: Night, other: Night, rows: pd.DataFrame) -> Changes:
    """Tonight beside another night; `rows` are tonight's, in the order of its figures."""
    known = {figure.key: figure for figure in other.figures}
    changes, verdicts, other_inputs, more = [], [], 0, 0
    for place, now in enumerate(tonight.figures):
        then = known.pop(now.key, None)
        if then is None:
            continue
        row = rows.iloc[place]
        if then.inputs != now.inputs:
            other_inputs += 1
            continue
        if then.verdict != now.verdict:
            verdicts.append(
                f"{row['contender']} in {row['view']} at {size_of(row)}: {then.verdict} before, "
                f"{now.verdict} now."
            )
        if then.counters != now.counters:
            more += 1
        noise_only = now.verdict == "baseline" or now.reference == now.key
        if now.ratio and then.ratio and then.reference == now.reference and not noise_only:
            changes.append(
                Change(row["contender"], row["view"], size_of(row), then.ratio, now.ratio)
            )
    new = len(tonight.figures) - (len(other.figures) - len(known))
    told = []
    if other.machine_id != tonight.machine_id:
        told.append(
            f"Of another machine: tonight {tonight.machine_id}, then {other.machine_id}. Ratios "
            "depend on the processor, so these changes are not the program's alone."
        )
    told += verdicts[:_MOST]
    told += _counted(more, "cells counted other work than then.", "cell counted other work.")
    told += _counted(other_inputs, "cells asked other rays or scenes; they are not compared.")
    told += _counted(new, "cells are new.", "cell is new.")
    told += _counted(len(known), "cells are gone.", "cell is gone.")
    changes.sort(key=lambda change: -abs(change.share))
    return Changes(
        name,
        other.run_id,
        other.commit,
        changes[:_MOST],
        sum(change.share > NOTEWORTHY for change in changes),
        sum(change.share < -NOTEWORTHY for change in changes),
        len(changes),
        told,
    )


def size_of(row: pd.Series) -> str:
    """The resolution of a row."""
    return f"{row['width']:.0f}x{row['height']:.0f}"


def shares(tonight: Night, other: Night | None) -> list[float]:
    """Each figure's change in percent; NaN where it cannot be compared."""
    known = {figure.key: figure for figure in other.figures} if other else {}
    result = []
    for now in tonight.figures:
        then = known.get(now.key)
        comparable = then and then.inputs == now.inputs and then.reference == now.reference
        if comparable and then.ratio and now.ratio:
            result.append(100 * (now.ratio / then.ratio - 1))
        else:
            result.append(float("nan"))
    return result


def _counted(count: int, many: str, one: str | None = None) -> list[str]:
    if count == 0:
        return []
    return [f"{count:,} {one if count == 1 and one else many}"]
