"""The plots of a run: time over rays, build and trace, memory, counters, break-even."""

import json
from pathlib import Path

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, NullFormatter, NullLocator

from beambench_report.base.columns import COUNTER_SUFFIX
from beambench_report.base.figure import (
    Look,
    Plot,
    caption,
    house_style,
    looks,
    new_figure,
    write_plot,
)
from beambench_report.base.files import write_text, write_whole
from beambench_report.base.names import PLOT_INDEX, file_stems
from beambench_report.base.quantities import number, size_in_words
from beambench_report.base.records import Run, read_run
from beambench_report.run.bars import BAR_HEIGHT, PANEL_MARGIN, Bar, draw_bars, panel_per_view
from beambench_report.run.break_even import break_even, break_even_table


def time_over_rays(run: Run) -> list[Plot]:
    """The figures of all views that have times."""
    all_looks = looks(run.rows)
    plots = []
    for title, stem in file_stems(run.views).items():
        rows = run.view(title)
        if not rows["timed"].any():
            continue
        figure, (panel,) = new_figure(4.0)
        for contender, line in rows[rows["timed"]].groupby("contender", sort=False):
            _draw_line(panel, str(contender), line.sort_values("rays"), all_looks[contender])
        panel.set_title(f"{title}: time against number of rays")
        _label_axes(panel, rows)
        figure.legend(loc="outside right center", frameon=False)
        caption(
            figure,
            rows,
            "Median of build and trace together; the bars are the median's 95% interval. "
            "Both axes are logarithmic.",
            times=True,
        )
        summary = f"{title}: time, build included, against number of rays"
        plots.append(Plot(f"time-{stem}", figure, summary, title))
    return plots


def _draw_line(panel: Axes, contender: str, line: pd.DataFrame, look: Look) -> None:
    median = line["total_ms_median"]
    # An interval that was not measured is drawn as none.
    below = (median - line["total_ms_ci_low"]).fillna(0).clip(lower=0)
    above = (line["total_ms_ci_high"] - median).fillna(0).clip(lower=0)
    panel.errorbar(
        line["rays"],
        median,
        yerr=[below, above],
        label=contender,
        color=look.color,
        marker=look.marker,
        linestyle=look.dashes,
        markersize=4.5,
        capsize=2.5,
        linewidth=1.4,
    )


def _label_axes(panel: Axes, rows: pd.DataFrame) -> None:
    panel.set_xscale("log")
    panel.set_yscale("log")
    sizes = rows.drop_duplicates("rays").sort_values("rays")
    panel.set_xticks(
        sizes["rays"],
        [f"{row.width:.0f}x{row.height:.0f}\n{row.rays:,.0f}" for row in sizes.itertuples()],
    )
    panel.xaxis.set_minor_locator(NullLocator())
    panel.xaxis.set_minor_formatter(NullFormatter())
    panel.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,g}"))
    panel.set_xlabel("resolution, number of rays")
    panel.set_ylabel("time in ms (build + trace)")
    panel.grid(axis="y", which="major", color="#dddddd", linewidth=0.6)


def build_and_trace(run: Run) -> list[Plot]:
    """One figure, one panel per view; none when nothing was timed."""
    all_looks = looks(run.rows)
    plots = panel_per_view(
        run,
        stem="build-and-trace",
        select=lambda title: _with_times(run.finest(title)),
        draw=lambda panel, rows: draw_bars(panel, _time_bars(rows), all_looks, "time in ms"),
        explanation="Medians of one build and one image of primary rays at each view's highest "
        "resolution. The medians of the parts need not add up to the median of the whole.",
        summary="build and trace time of each structure at the highest resolution",
        times=True,
    )
    for plot in plots:
        plot.figure.legend(
            handles=[Patch(color="#555555", alpha=0.4), Patch(color="#555555")],
            labels=["build", "trace"],
            loc="outside upper right",
            ncols=2,
            frameon=False,
        )
    return plots


def _with_times(rows: pd.DataFrame) -> pd.DataFrame:
    return rows[rows["timed"]].dropna(subset=["build_ms_median", "trace_ms_median"])


def _time_bars(rows: pd.DataFrame) -> list[Bar]:
    return [
        Bar(
            row.contender,
            (row.build_ms_median, row.trace_ms_median),
            f"{number(row.build_ms_median)} + {number(row.trace_ms_median)}",
        )
        for row in rows.itertuples()
    ]


_MIB = 2.0**20


def memory(run: Run) -> list[Plot]:
    """One figure, one panel per view; none when no structure reported its memory."""
    all_looks = looks(run.rows)
    return panel_per_view(
        run,
        stem="memory",
        select=lambda title: run.finest(title).dropna(subset=["memory_bytes"]),
        draw=lambda panel, rows: draw_bars(panel, _memory_bars(rows), all_looks, "memory in MiB"),
        explanation="What the structure holds beside the scene, as it reports it.",
        summary="memory of each structure",
        times=False,
    )


def _memory_bars(rows: pd.DataFrame) -> list[Bar]:
    return [
        Bar(row.contender, (row.memory_bytes / _MIB,), size_in_words(row.memory_bytes))
        for row in rows.itertuples()
    ]


_COLUMNS = 2


def counters(run: Run) -> list[Plot]:
    """The figures of all views for which anything was counted; whole pictures have two."""
    plots = []
    for title, stem in file_stems(run.views).items():
        finest = run.finest(title)
        for names, words, prefix in (
            (run.counters, "work per ray", "counters"),
            (run.counters_by_kind, "work per ray by kind of rays", "counters-by-kind"),
        ):
            shown = _worth_showing(finest, names)
            if not shown:
                continue
            figure = _draw_counters(run, finest, shown, f"{title}: {words}")
            plots.append(Plot(f"{prefix}-{stem}", figure, f"{title}: {words}", title))
    return plots


def _worth_showing(finest: pd.DataFrame, names: list[str]) -> dict[str, pd.DataFrame]:
    """The rows that have a counter, by its name."""
    having = {name: finest.dropna(subset=[name]) for name in names}
    return {name: rows for name, rows in having.items() if (rows[name] != 0).any()}


def _draw_counters(
    run: Run, finest: pd.DataFrame, shown: dict[str, pd.DataFrame], heading: str
) -> Figure:
    all_looks = looks(run.rows)
    lines = -(-len(shown) // _COLUMNS)
    bars = max(len(rows) for rows in shown.values())
    figure, panels = new_figure(lines * (PANEL_MARGIN + BAR_HEIGHT * bars), lines, _COLUMNS)
    for panel in panels[len(shown) :]:
        panel.set_axis_off()
    for panel, (name, rows) in zip(panels, shown.items(), strict=False):
        panel.set_title(name.removesuffix(COUNTER_SUFFIX).replace("_", " "))
        draw_bars(panel, _counter_bars(rows, name), all_looks, "per ray")
    first = finest.iloc[0]
    size = f"{first['width']:.0f}x{first['height']:.0f}"
    figure.suptitle(f"{heading} at {size}", x=0.01, ha="left", weight="bold")
    caption(
        figure,
        finest,
        "Counted in a pass of its own, not in the timed code. A structure that does not count "
        "its work is left out.",
        times=False,
    )
    return figure


def _counter_bars(rows: pd.DataFrame, name: str) -> list[Bar]:
    return [
        Bar(contender, (value,), number(value))
        for contender, value in zip(rows["contender"], rows[name], strict=True)
    ]


FIGURES = (time_over_rays, build_and_trace, break_even, memory, counters)


def write_plots(directory: Path) -> list[Path]:
    """Fills DIRECTORY/plots from DIRECTORY/results.csv: PNG, SVG, a table, README and index."""
    run = read_run(directory)
    folder = directory / "plots"
    folder.mkdir(exist_ok=True)
    with house_style():
        plots = [plot for make in FIGURES for plot in make(run)]
        paths = [path for plot in plots for path in write_plot(plot, folder)]
    table = break_even_table(run)
    paths.append(
        write_whole(folder / "break-even.csv", lambda path: table.to_csv(path, index=False))
    )
    for name, text in (("README.md", _readme(run, plots)), (PLOT_INDEX, _index(plots))):
        paths.append(write_text(folder / name, text))
    return paths


def _readme(run: Run, plots: list[Plot]) -> str:
    lines = [
        f"# Plots of run {run.rows['run_id'].iloc[0]}",
        "",
        "Drawn by `scripts/run` from `../results.csv`; each is there as PNG and as SVG.",
        "",
        "| file | shows |",
        "|---|---|",
        *(f"| [{plot.stem}.png]({plot.stem}.png) | {plot.summary} |" for plot in plots),
        "| [break-even.csv](break-even.csv) | break-even ray count of every pair |",
        "",
    ]
    return "\n".join(lines)


def _index(plots: list[Plot]) -> str:
    entries = [{"stem": plot.stem, "summary": plot.summary, "view": plot.view} for plot in plots]
    return json.dumps(entries, indent=2) + "\n"
