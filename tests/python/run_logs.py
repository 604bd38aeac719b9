"""Reads and changes run.jsonl, the log of a run, like a person with an editor."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

Event = dict[str, Any]


def events(run: Path) -> list[Event]:
    """Returns all events of a log."""
    return [json.loads(line) for line in (run / "run.jsonl").read_text().splitlines()]


def write_events(run: Path, changed: list[Event]) -> None:
    """Writes a log."""
    lines = [json.dumps(event, separators=(",", ":")) + "\n" for event in changed]
    (run / "run.jsonl").write_text("".join(lines))


def change_events(run: Path, change: Callable[[Event], Event | None]) -> None:
    """Changes each event of a log; None leaves it out."""
    write_events(run, [new for event in events(run) if (new := change(event)) is not None])


def begun_cells(run: Path) -> list[Event]:
    """Returns the event with which each cell begins."""
    return [event for event in events(run) if event["event"] == "cell"]


def change_manifest(run: Path, changes: dict[str, Any]) -> None:
    """Sets members of the manifest, each given as `machine/id`."""

    def changed(event: Event) -> Event:
        for place, value in changes.items() if "manifest" in event else ():
            *inner, last = place.split("/")
            at = event["manifest"]
            for name in inner:
                at = at[int(name) if isinstance(at, list) else name]
            at[last] = value
        return event

    change_events(run, changed)


def cut_off(run: Path) -> None:
    """Truncates a log and removes the results made from it."""
    change_events(run, lambda event: None if event["event"] == "end" else event)
    for name in ("results.csv", "manifest.json", "analysis.json", "summary.txt"):
        (run / name).unlink(missing_ok=True)


def forget_cell(run: Path, index: int) -> None:
    """Removes the events of a cell, and the end of the log."""
    change_events(run, lambda event: None if event.get("index") == index else event)
    cut_off(run)
