"""A section of the page for each view: pictures, plots, and a table for each resolution."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import pandas as pd

from beambench_report.names import file_stems
from beambench_report.page.images import Image
from beambench_report.page.ratios import Compared
from beambench_report.page.table import Table
from beambench_report.page.view_table import view_table


@dataclass(frozen=True)
class View:
    """What is told of one view; the first table is that of the finest resolution."""

    title: str
    anchor: str
    primitives: int
    pictures: tuple[Image, ...]
    plots: tuple[Image, ...]
    tables: tuple[Table, ...]


def make_views(
    resolutions: Mapping[str, list[Compared]],
    counters: list[str],
    pictures: list[Image],
    plots: list[Image],
) -> list[View]:
    """A section for each view; `resolutions` has its rows, the finest first."""
    stems = file_stems(resolutions)
    views = []
    for title, groups in resolutions.items():
        first = groups[0].rows.iloc[0]
        views.append(
            View(
                title,
                f"view-{stems[title]}",
                0 if pd.isna(first["primitives"]) else int(first["primitives"]),
                tuple(image for image in pictures if image.subject == first["scene"]),
                tuple(image for image in plots if image.subject == title),
                tuple(
                    view_table(_caption(group.rows), group.rows, counters, group.ratios)
                    for group in groups
                ),
            )
        )
    return views


def _caption(rows: pd.DataFrame) -> str:
    first = rows.iloc[0]
    samples = f", {first['samples']:.0f} samples a pixel" if first["samples"] > 1 else ""
    return f"{first['width']:.0f}x{first['height']:.0f}{samples}, {first['rays']:,.0f} rays"
