"""Runs the sweeps of a plan one after the other, each in a separate folder."""

import json
from dataclasses import dataclass
from pathlib import Path

from beambench_report.base.files import INTERRUPTED, load_json, run_in_foreground, say, write_text
from beambench_report.base.quantities import duration_in_words
from beambench_report.base.records import TIMED_VERDICTS
from beambench_report.base.run_log import has_log, logged_cells
from beambench_thesis.report.plan import Plan, Sweep

_NOT_RIGHT = 1


@dataclass(frozen=True)
class Outcome:
    """The outcome of the runs."""

    not_right: tuple[str, ...]
    """Sweeps in which a structure had wrong hits."""
    not_made: tuple[str, ...]
    """Sweeps that could not be run."""
    interrupted: bool = False

    @property
    def exit_code(self) -> int:
        """Returns the exit code: 2 if something could not be run, 1 if a hit was wrong."""
        if self.interrupted:
            return 130
        return 2 if self.not_made else 1 if self.not_right else 0


def run_sweeps(plan: Plan, directory: Path, beambench: Path) -> Outcome:
    """Runs the unfinished sweeps. If one cannot be run, the others still are."""
    not_right, not_made = [], []
    for number, sweep in enumerate(plan.every_sweep, 1):
        where = f"run {number} of {len(plan.every_sweep)}: {sweep.name}"
        state = state_of(directory / sweep.name)
        if state == "finished":
            say(f"== {where}: already finished")
            code = _NOT_RIGHT if _has_wrong_cells(directory / sweep.name) else 0
        else:
            time = duration_in_words(sweep.budget_seconds)
            say(f"== {where}: {len(sweep.cells())} cells, {time}")
            code = _run(sweep, directory, beambench, resume=state == "begun")
        if code in INTERRUPTED:
            return Outcome(tuple(not_right), tuple(not_made), interrupted=True)
        if code == _NOT_RIGHT:
            not_right.append(sweep.name)
        elif code != 0:
            not_made.append(sweep.name)
    return Outcome(tuple(not_right), tuple(not_made))


def state_of(folder: Path) -> str:
    """Returns the state of a sweep's run by its folder: `finished`, `begun` or `waiting`."""
    try:
        manifest = load_json(folder / "manifest.json")
    except (FileNotFoundError, ValueError):
        manifest = None
    if isinstance(manifest, dict) and manifest.get("finished_utc"):
        return "finished"
    return "begun" if manifest or has_log(folder) else "waiting"


def describe(plan: Plan, directory: Path | None = None) -> str:
    """Returns a line for each sweep: its cells, its time budget, and its state."""
    lines, cells, seconds = [], 0, 0.0
    for sweep in plan.every_sweep:
        count, state = len(sweep.cells()), "waiting"
        if directory is not None:
            state = state_of(directory / sweep.name)
        progress = "finished" if state == "finished" else ""
        left = 0.0 if state == "finished" else sweep.budget_seconds
        if directory is not None and state == "begun":
            done = sum(cell.is_finished for cell in logged_cells(directory / sweep.name))
            progress = f"{done} done"
            left *= max(0.0, 1 - done / count)
        lines.append(
            f"{sweep.name:<24} {count:>4} cells {duration_in_words(left):>12}  {progress}".rstrip()
        )
        cells += count
        seconds += left
    lines.append(f"{'in all':<24} {cells:>4} cells {duration_in_words(seconds):>12}")
    return "\n".join(lines) + "\n"


def _run(sweep: Sweep, directory: Path, beambench: Path, *, resume: bool) -> int:
    folder = directory / sweep.name
    if resume:
        arguments = ["--resume", str(folder)]
    else:
        (directory / "sweeps").mkdir(exist_ok=True)
        config = directory / "sweeps" / f"{sweep.name}.json"
        write_text(config, json.dumps(sweep.source, indent=2) + "\n")
        arguments = [str(config), "-o", str(folder)]
    return run_in_foreground([str(beambench), "run", *arguments])


def _has_wrong_cells(folder: Path) -> bool:
    return any(cell.verdict not in TIMED_VERDICTS for cell in logged_cells(folder))
