"""The results of a sweep, which notebooks show as tables with bars."""

from __future__ import annotations

from html import escape

import pandas as pd

_VIEW = ["scene", "camera", "width", "height", "samples", "ray_kind"]
_BAR = '<div style="display:inline-block;height:0.8em;width:{:.0f}px;background:{}"></div>'
_WIDTH = 240


class Results(pd.DataFrame):
    """The rows of results.csv. Selections of rows or columns are plain DataFrames."""

    @property
    def _constructor(self) -> type[pd.DataFrame]:
        return pd.DataFrame

    def _repr_html_(self) -> str:
        present = [name for name in _VIEW if name in self.columns]
        views = self.groupby(present, sort=False, dropna=False)
        tables = "".join(_table(rows) for _, rows in views)
        summary = escape(str(self.attrs.get("summary", "")))
        return f"{tables}<pre>{summary}</pre>"


def _table(rows: pd.DataFrame) -> str:
    """Returns the table of one view, shortest trace first, with bars for build and trace."""
    first = rows.iloc[0]
    title = (
        f"{first['scene']}, {first['width']:.0f}x{first['height']:.0f}, {first['ray_kind']} rays"
    )
    total = rows["build_ms_median"].fillna(0) + rows["trace_ms_median"]
    longest = total.max()
    lines = []
    for _, row in rows.sort_values("trace_ms_median").iterrows():
        name = f"{row['structure']}:{row['parameters']}" if row["parameters"] else row["structure"]
        lines.append(
            f'<tr><th title="{escape(str(name))}">{escape(str(row["structure"]))}</th>'
            f"{_times(row, longest)}<td>{escape(str(row['verdict']))}</td></tr>"
        )
    head = "<tr><th></th><th>build ms</th><th>trace ms</th><th>build, trace</th><th>hits</th></tr>"
    return f"<table><caption>{escape(title)}</caption>{head}{''.join(lines)}</table>"


def _times(row: pd.Series, longest: float) -> str:
    """Returns three table cells: two figures and the bars; empty cells if nothing was timed."""
    build, trace = row["build_ms_median"], row["trace_ms_median"]
    if pd.isna(trace):
        return "<td></td><td></td><td></td>"
    build = 0.0 if pd.isna(build) else build
    bars = _BAR.format(_WIDTH * build / longest, "#b9c4d0")
    bars += _BAR.format(_WIDTH * trace / longest, "#2f6fb0")
    cells = f"<td>{build:.4g}</td><td>{trace:.4g}</td>"
    return f'{cells}<td style="text-align:left;white-space:nowrap">{bars}</td>'
