"""Draws the plots of a run: speeds, their price, break-even ray counts, and precision."""

import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from beambench_report.base.csv_texts import csv_of
from beambench_report.base.figure import Plot, house_style, write_plot
from beambench_report.base.files import load_json, write_text
from beambench_report.base.names import PLOT_INDEX
from beambench_report.base.records import Run
from beambench_report.run.counters import counters
from beambench_report.run.crossings import break_even_table, crossings
from beambench_report.run.distributions import distributions
from beambench_report.run.frames import frames
from beambench_report.run.measured import Measured, read_measured
from beambench_report.run.overall_plot import overalls
from beambench_report.run.resolutions import resolutions
from beambench_report.run.swept import swept
from beambench_report.run.trade_offs import trade_offs


@dataclass(frozen=True)
class Kind:
    """One kind of figure: the function that draws it, its name, and the data it needs."""

    draw: Callable[[Measured], list[Plot]]
    name: str
    needs: str


KINDS = (
    Kind(overalls, "overall", "two contenders whose hits are correct, with times"),
    Kind(trade_offs, "trade-offs", "two contenders with times in one view"),
    Kind(resolutions, "resolutions", "times of a contender at two resolutions"),
    Kind(swept, "by a parameter", "a parameter that two structures sweep"),
    Kind(crossings, "break-even", "two contenders with times in one view"),
    Kind(distributions, "distributions", "repetitions, which are in the log, run.jsonl"),
    Kind(frames, "frames", "times in two frames of a scene that moves"),
    Kind(counters, "counters", "a counter that two contenders have"),
)


def draw(measured: Measured, kinds: Sequence[Kind] = KINDS) -> Iterator[Plot]:
    """Yields the figures of these kinds; draw and save them within `house_style`."""
    for kind in kinds:
        yield from kind.draw(measured)


def without_figure(stems: Iterable[str], kinds: Sequence[Kind] = KINDS) -> list[Kind]:
    """Returns the kinds that have no figure among `stems`."""
    known = tuple(stems)
    return [kind for kind in kinds if not any(stem.startswith(kind.name) for stem in known)]


def write_plots(directory: Path, kinds: Sequence[Kind] = KINDS) -> list[Path]:
    """Fills DIRECTORY/plots from DIRECTORY/results.csv: PNG, SVG, a table, README and index.

    Only `kinds` are drawn. Plots of an earlier call that are not drawn again are removed.
    """
    measured = read_measured(directory)
    folder = directory / "plots"
    folder.mkdir(exist_ok=True)
    plots, paths = [], []
    with house_style():
        for plot in draw(measured, kinds):
            paths += write_plot(plot, folder)
            plots.append(plot)
    _remove_former(folder, {plot.stem for plot in plots})
    table = break_even_table(measured.run)
    paths.append(write_text(folder / "break-even.csv", csv_of(table)))
    readme = _readme(measured.run, plots, kinds)
    entries = [{"stem": plot.stem, "summary": plot.summary, "view": plot.view} for plot in plots]
    index = json.dumps(entries, indent=2) + "\n"
    for name, text in (("README.md", readme), (PLOT_INDEX, index)):
        paths.append(write_text(folder / name, text))
    return paths


def _remove_former(folder: Path, stems: set[str]) -> None:
    """Removes the figures in the existing index that were not drawn again."""
    try:
        former = {entry["stem"] for entry in load_json(folder / PLOT_INDEX)}
    except (OSError, ValueError, TypeError, KeyError):
        return
    for stem in former - stems:
        for ending in ("png", "svg"):
            (folder / f"{Path(stem).name}.{ending}").unlink(missing_ok=True)


def _readme(run: Run, plots: list[Plot], kinds: Sequence[Kind]) -> str:
    lines = [
        f"# Plots of run {run.rows['run_id'].iloc[0]}",
        "",
        "Drawn by `scripts/run` from `../results.csv`, each as PNG and as SVG. In a browser, SVG",
        "plots show the values under the mouse.",
        "",
        "| file | shows |",
        "|---|---|",
        *(f"| [{plot.stem}.png]({plot.stem}.png) | {plot.summary} |" for plot in plots),
        "| [break-even.csv](break-even.csv) | break-even ray count of every pair |",
        "",
    ]
    if missing := without_figure((plot.stem for plot in plots), kinds):
        lines += ["Not drawn, because the run does not have the data they need:", ""]
        lines += [f"- {kind.name}: {kind.needs}" for kind in missing]
        lines += [""]
    return "\n".join(lines)
