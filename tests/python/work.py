"""Counts the Python calls of some work, which are the same on every machine, however busy."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable
from types import FrameType

import pytest


def calls_during(work: Callable[[], object]) -> int:
    """Returns how many calls of Python functions the work makes, including those of libraries."""
    count = 0

    def on_event(_frame: FrameType, event: str, _argument: object) -> None:
        nonlocal count
        count += event == "call"

    former = sys.getprofile()
    sys.setprofile(on_event)
    try:
        work()
    finally:
        sys.setprofile(former)
    return count


def count_calls_of(
    monkeypatch: pytest.MonkeyPatch, counts: Counter[str], owner: object, name: str
) -> None:
    """Makes the function `name` of `owner` (a module or class) count its calls in `counts`."""
    original = getattr(owner, name)

    def counting(*arguments: object, **keywords: object) -> object:
        counts[name] += 1
        return original(*arguments, **keywords)

    monkeypatch.setattr(owner, name, counting)
