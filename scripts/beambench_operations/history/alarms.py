"""Alarms of a night: slower times, more work, wrong hits."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import expm1

import numpy as np
import pandas as pd

from beambench_operations.history.nights import Nights, read_nights
from beambench_operations.history.steps import Rule, find_steps
from beambench_operations.history.store import Alarm, History
from beambench_report.base.records import FAULTLESS_VERDICTS

SHARE = 0.001
"""The relative increase of a counter above which it is a regression."""


@dataclass(frozen=True)
class Increase:
    """An increase of one counter of one cell."""

    cell: int
    counter: str
    before: float
    after: float

    @property
    def share(self) -> float:
        """Returns the relative increase; infinite if the counter was 0 before."""
        return self.after / self.before - 1 if self.before > 0 else float("inf")


def find_increases(nights: Nights) -> list[Increase]:
    """Returns the counters above their minimum over the earlier nights since their last report."""
    if len(nights.nights) < 2:
        return []
    found = []
    counters = pd.DataFrame.from_dict(nights.counters, orient="index", dtype=float)
    for name in sorted(counters):
        # NaN where nothing was counted: -1 is not the number of a set of counters.
        *earlier, after = (
            counters[name].reindex(nights.works.ravel()).to_numpy().reshape(nights.works.shape)
        )
        least = np.full(len(after), np.nan)
        with np.errstate(invalid="ignore"):
            for night in earlier:
                reported = night > least * (1 + SHARE)
                least = np.where(reported, night, np.fmin(least, night))
            more = after > least * (1 + SHARE)
        found += [
            Increase(int(cell), name, float(least[cell]), float(after[cell]))
            for cell in np.flatnonzero(more)
        ]
    return sorted(found, key=lambda one: -one.share)


NIGHTS = 120
"""The number of nights in which a counter's minimum and a step are searched."""

_ROOM = 3
_MANY = 5


def find_alarms(history: History, night: int) -> list[Alarm]:
    """Returns the alarms of a night of the history, compared with the nights before it."""
    nights = read_nights(history, night, NIGHTS, compared=True)
    before = set(nights.nights["number"][:-1])
    earlier = [one for one in history.alarms() if one.kind == "time" and one.night in before]
    found = [*_wrong(nights), *_more_work(nights), *_slower(nights, earlier)]
    return [Alarm(night, kind, series, details) for kind, series, details in found]


def _wrong(nights: Nights) -> Iterator[tuple[str, str, dict]]:
    for _, cell in nights.cells.iterrows():
        if cell["verdict"] not in FAULTLESS_VERDICTS:
            title = cell_title(cell)
            yield "verdict", title, {"title": title, "verdict": cell["verdict"] or "no verdict"}


def _more_work(nights: Nights) -> Iterator[tuple[str, str, dict]]:
    for one in find_increases(nights):
        title = cell_title(nights.cells.iloc[one.cell])
        name = one.counter.removesuffix("_per_ray").replace("_", " ")
        details = {"title": title, "counter": name, "before": one.before, "after": one.after}
        yield "counter", f"{title}: {name}", details


def _slower(nights: Nights, earlier: list[Alarm]) -> Iterator[tuple[str, str, dict]]:
    pools = nights.pools
    starts = reported_starts(nights, earlier)
    for step in find_steps(nights.pooled(), starts, Rule()):
        pool = pools.iloc[step.series]
        first = nights.nights.iloc[step.change]
        details = {
            "title": pool["title"],
            "scene": pool["scene"],
            "structure": pool["structure"],
            "shift": expm1(step.shift),
            "low": expm1(step.low),
            "high": expm1(step.high),
            "p_value": step.p_value,
            "nights_before": step.before,
            "nights_after": step.after,
            "since_run": first["run_id"],
            # Noise shifts the detected place of a step by some nights, so the range of commits is
            # widened.
            "since_commit": _commit(nights, step.change + _ROOM - 1),
            "last_good_commit": _commit(nights, step.change - _ROOM),
        }
        yield "time", series_key(pool), details


def _commit(nights: Nights, place: int) -> str:
    return nights.nights.iloc[min(max(place, 0), len(nights.nights) - 1)]["commit"]


def series_key(pool: pd.Series) -> str:
    """Returns the key that identifies a pool in any night."""
    names = "scene camera structure parameters samples ray_kind".split()
    return " | ".join(str(pool[name]) for name in names)


def reported_starts(nights: Nights, earlier: list[Alarm]) -> np.ndarray:
    """Returns the night from which each pool is tested: the night of its last reported step."""
    place = {run_id: place for place, run_id in enumerate(nights.nights["run_id"])}
    starts: dict[str, int] = {}
    for alarm in earlier:
        if (change := place.get(alarm.details["since_run"])) is not None:
            starts[alarm.series] = max(change, starts.get(alarm.series, 0))
    keys = [series_key(pool) for _, pool in nights.pools.iterrows()]
    return np.array([starts.get(key, 0) for key in keys], int)


def doubt(alarms: Iterable[Alarm], series: int) -> str:
    """Returns a caveat if most series got slower at once: their reference probably got faster."""
    slower = sum(alarm.kind == "time" for alarm in alarms)
    if slower < _MANY or slower * 2 < series:
        return ""
    return (
        f"{slower} of {series} series got slower at once: more likely, Embree, to which they are "
        "compared, got faster, or the machine changed"
    )


def cell_title(cell: pd.Series) -> str:
    """Returns the title of a cell."""
    title = f"{cell['contender']} in {cell['scene']} at {cell['width']}x{cell['height']}"
    if cell["samples"] > 1:
        title += f" with {cell['samples']} samples"
    return title if cell["ray_kind"] == "primary" else f"{title}, {cell['ray_kind']} rays"


def sentence(alarm: Alarm) -> str:
    """Returns an alarm in words."""
    d = alarm.details
    if alarm.kind == "verdict":
        return f"{d['title']}: wrong hits ({d['verdict']})"
    if alarm.kind == "counter":
        before, after = d["before"], d["after"]
        part = f" ({after / before - 1:+.2%})" if before > 0 else ""
        return f"{d['title']}: {d['counter']} per ray from {before:.6g} to {after:.6g}{part}"
    return (
        f"{d['title']}: {d['shift']:+.1%} slower ({d['low']:+.1%} to {d['high']:+.1%}) "
        f"since about {d['since_run']}, between the commits {d['last_good_commit'][:12]} and "
        f"{d['since_commit'][:12]}"
    )
