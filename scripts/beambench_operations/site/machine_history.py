"""The runs of one sweep on one machine in chronological order, and their alarms."""

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from beambench_operations.history.alarms import find_alarms
from beambench_operations.history.night import Night, night_of
from beambench_operations.history.nights import Nights, read_nights
from beambench_operations.history.store import Alarm, History
from beambench_report.base.files import Problem, say
from beambench_report.base.records import read_run


@dataclass(frozen=True)
class MachineHistory:
    """The runs and their alarms."""

    nights: Nights
    alarms: list[Alarm]
    left_out: list[str]
    """Runs that are not in the history, each with the reason."""

    @property
    def newest(self) -> int:
        """Returns the number of the last run."""
        return int(self.nights.nights.iloc[-1]["number"])

    @property
    def tonight(self) -> list[Alarm]:
        """Returns the alarms of the last run."""
        return [one for one in self.alarms if one.night == self.newest]


def history_of(runs: Sequence[tuple[str, Path]], known: Sequence[Path]) -> MachineHistory | None:
    """Returns the history of runs (oldest first, with ids), from a known history or rebuilt.

    Returns None if it has fewer than two runs.
    """
    if len(runs) < 2:
        return None
    with ExitStack() as stack:
        best, most = None, 0
        for path in known:
            try:
                history = stack.enter_context(History(path))
                shared = sum(history.number_of(run_id) is not None for run_id, _ in runs)
            except Problem as problem:  # it is rebuilt here
                say(str(problem))
                continue
            if 2 * shared >= len(runs) and shared > most:
                best, most = history, shared
        left_out = []
        if best is None:
            best = stack.enter_context(History(Path(":memory:")))
            left_out = _fill(best, [folder for _, folder in runs])
        ids = list(dict.fromkeys(one for one, _ in runs if best.number_of(one) is not None))
        if len(ids) < 2:
            return None
        nights = read_nights(best, best.number_of(ids[-1]))
        numbers = set(nights.nights["number"])
        alarms = [alarm for alarm in best.alarms() if alarm.night in numbers]
    return MachineHistory(nights, alarms, left_out)


def _fill(history: History, folders: Sequence[Path]) -> list[str]:
    nights: list[tuple[Night, Path]] = []
    left_out = []
    for folder in folders:
        try:
            nights.append((night_of(read_run(folder)), folder))
        except Problem as problem:
            left_out.append(str(problem))
    for night, folder in sorted(nights, key=lambda one: (one[0].time_utc, one[0].run_id)):
        if history.add(night, folder, find_alarms) is None:
            left_out.append(f"{folder}: the run {night.run_id} is in another folder, too")
    return left_out
