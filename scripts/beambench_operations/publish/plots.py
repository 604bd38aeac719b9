"""Draws the plots of results/published again, from the committed rows beside them."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from beambench_operations.publish.reports import BEAT_EMBREE, PENCILS
from beambench_report.base.figure import Plot, house_style, svg_of
from beambench_report.base.files import write_text
from beambench_report.base.records import read_run
from beambench_report.embree_comparison.pairings import pairings
from beambench_report.embree_comparison.plots import plots as comparison_plots
from beambench_report.run.front_plots import front_plots
from beambench_report.run.fronts import fronts
from beambench_report.run.measured import read_measured
from beambench_report.run.plots import KINDS, draw
from beambench_thesis.chapter6.report import report as report_on_cluster
from beambench_thesis.report.drawing import draw as draw_work
from beambench_thesis.report.plan import read_plan
from beambench_thesis.report.report import gather

_SVG = "{http://www.w3.org/2000/svg}"


@dataclass(frozen=True)
class Difference:
    """A published plot that does not agree with its rows."""

    file: Path
    shown: tuple[str, ...]
    """The texts that only the published plot has."""
    computed: tuple[str, ...] | None
    """The texts that only its rows give; None if no rows give such a plot."""

    def __str__(self) -> str:
        """Returns the fault and the remedy."""
        if self.computed is None:
            return f"{self.file}: no rows beside it give this plot; remove it, or commit its rows"
        return (
            f"{self.file}: shows {list(self.shown)[:4]}, but the rows give "
            f"{list(self.computed)[:4]}; draw it again with scripts/publish --plots"
        )


def drawn_again(folder: Path) -> dict[Path, str]:
    """Draws the SVG plots below a published folder again, except those that no rows give."""
    published = set(folder.rglob("*.svg"))
    with house_style():
        plots = {
            plots_folder / f"{plot.stem}.svg": plot
            for plots_folder, own in _plots(folder)
            for plot in own
        }
        return {path: svg_of(plots[path]) for path in sorted(published & set(plots))}


def differences(folder: Path) -> Iterator[Difference]:
    """Yields the plots below a published folder whose texts the committed rows do not give.

    The texts of a plot are its labels, the numbers at its axes, and the values that a browser
    shows under the mouse.
    """
    again = drawn_again(folder)
    for path in sorted(folder.rglob("*.svg")):
        stated = texts(path.read_text("utf-8"))
        if path not in again:
            yield Difference(path, tuple(stated), None)
            continue
        computed = texts(again[path])
        if stated != computed:
            yield Difference(path, _without(stated, computed), _without(computed, stated))


def write_plots(published: Path) -> list[Path]:
    """Draws the plots again whose texts differ from what the rows give; returns them."""
    return [
        write_text(one.file, drawn_again(folder)[one.file])
        for folder in sorted(path for path in published.iterdir() if path.is_dir())
        for one in differences(folder)
        if one.computed is not None
    ]


def texts(svg: str) -> list[str]:
    """Returns all texts of a plot, in alphabetical order."""
    root = ElementTree.fromstring(svg)
    parts = (part for tag in ("text", "title") for part in root.iter(f"{_SVG}{tag}"))
    return sorted(" ".join("".join(part.itertext()).split()) for part in parts)


def _without(some: list[str], others: list[str]) -> tuple[str, ...]:
    return tuple(one for one in some if some.count(one) > others.count(one))


def _plots(folder: Path) -> Iterator[tuple[Path, list[Plot]]]:
    """Yields the plot folders below a published folder, each with plots drawn from its rows."""
    for plots in sorted(path for path in folder.rglob("plots") if path.is_dir()):
        measured = read_measured(plots.parent)
        stems = [path.stem for path in plots.glob("*.svg")]
        # Drawing unpublished plots takes minutes. A stem begins with the first word of its kind.
        kinds = [kind for kind in KINDS if _is_among(kind.name.split()[0], stems)]
        yield plots, list(draw(measured, kinds))
        if _is_among("fronts", stems):
            yield plots, front_plots(measured, fronts(measured.analysis))
    if own := _OTHERS.get(folder.name):
        yield from own(folder)


def _is_among(beginning: str, stems: list[str]) -> bool:
    return any(stem.startswith(beginning) for stem in stems)


def _comparison(names: tuple[str, ...], folder: Path) -> Iterator[tuple[Path, list[Plot]]]:
    runs = [read_run(folder / name) for name in names if (folder / name).is_dir()]
    yield folder, comparison_plots(pairings(runs))


def _thesis(folder: Path) -> Iterator[tuple[Path, list[Plot]]]:
    report = gather(folder, read_plan(folder), None)
    figures = [one.draw() for section in report.sections for one in section.figures]
    yield folder / "figures", [*map(draw_work, report.figures), *figures]


_OTHERS: dict[str, Callable[[Path], Iterator[tuple[Path, list[Plot]]]]] = {
    "beat-embree": lambda folder: _comparison(BEAT_EMBREE, folder),
    "cluster": lambda folder: iter([(folder, report_on_cluster(folder)[1])]),
    "pencils": lambda folder: _comparison(PENCILS, folder),
    "thesis": _thesis,
}
