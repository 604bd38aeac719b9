"""Memory that each structure holds, for each view."""

from __future__ import annotations

import pandas as pd

from beambench_report.bars import Bar, draw_bars
from beambench_report.figure import Plot
from beambench_report.panels import panel_per_view
from beambench_report.quantities import size_in_words
from beambench_report.records import Run
from beambench_report.style import looks

_MIB = 2.0**20


def memory(run: Run) -> list[Plot]:
    """One figure, a panel a view; none when no structure reported its memory."""
    all_looks = looks(run.rows)
    return panel_per_view(
        run,
        stem="memory",
        select=lambda title: run.finest(title).dropna(subset=["memory_bytes"]),
        draw=lambda panel, rows: draw_bars(panel, _bars(rows), all_looks, "memory in MiB"),
        explanation="What the structure holds beside the scene, by its own account.",
        summary="memory of each structure",
        times=False,
    )


def _bars(rows: pd.DataFrame) -> list[Bar]:
    return [
        Bar(row.contender, (row.memory_bytes / _MIB,), size_in_words(row.memory_bytes))
        for row in rows.itertuples()
    ]
