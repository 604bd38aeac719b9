"""Makes figures of page width with captions and styles, and saves them.

Each structure has one color, the same in every plot of every run. Many are from Okabe and Ito
("Color Universal Design", 2008), whose colors color-blind readers can distinguish; their yellow is
darkened to be visible on white. Variants of one structure share its color and differ in marker and
dashes. Each color has a variant for dark pages (`base.palette`).
"""

import io
import textwrap
from collections.abc import Iterable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from beambench_report.base.files import write_text, write_whole
from beambench_report.base.names import machine_label
from beambench_report.base.palette import GRID, INK, PAPER, SOFT, structure_color
from beambench_report.base.svg import compact

PAGE_WIDTH = 7.2  # inches
DPI = 200
"""The resolution of PNG files; text widths are measured at this resolution."""
_LINE_HEIGHT = 0.16  # inches, of a caption's line
_CAPTION_COLUMNS = 118  # characters that fit the page width
_MOST_WRONG = 6  # the most contenders that a caption names

_STYLE = {
    "font.size": 9,
    "font.sans-serif": ["DejaVu Sans"],  # matplotlib's own list of fonts bloats an SVG
    "text.color": INK,
    "axes.edgecolor": SOFT,
    "axes.labelcolor": INK,
    "axes.titlecolor": INK,
    "grid.color": GRID,
    "xtick.color": SOFT,
    "ytick.color": SOFT,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.axisbelow": True,
    "svg.fonttype": "none",
}


@dataclass(frozen=True)
class Plot:
    """A finished figure, the name of its files and a sentence that describes it."""

    stem: str
    figure: Figure
    summary: str
    view: str = ""
    """The title of the view that the figure shows; empty if it shows several views."""


def house_style() -> AbstractContextManager[None]:
    """Applies the style of our figures to matplotlib within the block."""
    return mpl.rc_context(_STYLE)


def new_figure(
    height: float,
    rows: int = 1,
    columns: int = 1,
    height_ratios: Sequence[float] | None = None,
) -> tuple[Figure, list[Axes]]:
    """Returns a page-wide figure and its panels, row by row."""
    figure = Figure(figsize=(PAGE_WIDTH, height), layout="constrained")
    panels = figure.subplots(rows, columns, squeeze=False, height_ratios=height_ratios)
    return figure, list(panels.flat)


def legend_below(figure: Figure, columns: int, **handles: object) -> None:
    """Draws a legend with several columns below the panels; without handles, for all lines."""
    figure.legend(loc="outside lower center", ncols=columns, frameon=False, fontsize=8, **handles)


def caption(figure: Figure, rows: pd.DataFrame, explanation: str, *, times: bool) -> None:
    """Writes below a figure its description, its data source and the unverified contenders.

    Figures of times omit these contenders; figures of counters and memory show them.
    """
    lines = [explanation, _source(rows)]
    if wrong := untimed(rows):
        start = "Left out, not verified" if times else "Shown, though not verified"
        more = f"; and {len(wrong) - _MOST_WRONG} more" if len(wrong) > _MOST_WRONG else ""
        lines.append(f"{start}: {'; '.join(wrong[:_MOST_WRONG])}{more}.")
    write_below(figure, lines)


def write_below(figure: Figure, paragraphs: Iterable[str]) -> None:
    """Writes small text below a figure, and makes the figure taller to fit the text."""
    wrapped = "\n".join(textwrap.fill(text, _CAPTION_COLUMNS) for text in paragraphs)
    figure.supxlabel(wrapped, x=0.01, ha="left", fontsize=7.5, color=SOFT)
    width, height = figure.get_size_inches()
    figure.set_size_inches(width, height + _LINE_HEIGHT * (wrapped.count("\n") + 1))


def untimed(rows: pd.DataFrame) -> list[str]:
    """Returns the contenders whose times do not count, with the view and the verdict."""
    kept_out = rows[~rows["timed"]]
    verdicts = kept_out["verdict"].replace("", "no verdict")
    return list(dict.fromkeys(kept_out["contender"] + " in " + kept_out["view"] + ": " + verdicts))


def write_plot(plot: Plot, directory: Path) -> list[Path]:
    """Writes the figure as PNG and as SVG; the SVG has the hover titles set by `svg.hover`."""

    return [
        write_whole(
            directory / f"{plot.stem}.png",
            lambda path: plot.figure.savefig(path, format="png", dpi=DPI),
        ),
        write_text(directory / f"{plot.stem}.svg", svg_of(plot)),
    ]


def svg_of(plot: Plot) -> str:
    """Returns the text of the figure's SVG file."""
    drawn = io.StringIO()
    # The salt is derived from the stem, so that no two plots on one page share ids.
    with mpl.rc_context({"svg.hashsalt": f"beambench-{plot.stem}"}):
        plot.figure.savefig(drawn, format="svg", dpi=DPI, metadata={"Date": None})
    return compact(drawn.getvalue())


def _source(rows: pd.DataFrame) -> str:
    first = rows.iloc[0]
    modified = " (modified)" if first["dirty"] == "true" else ""
    machines = ", ".join(machine_label(one) for one in dict.fromkeys(rows["machine_id"]))
    return (
        f"Run {first['run_id']}, commit {first['commit'][:12]}{modified}, "
        f"{machines}, threads {first['threads']:.0f}."
    )


# Colors from Okabe and Ito, for lines that do not represent structures.
LINE_COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
MARKERS = "osD^vP*X<>"
DASHES = ("-", "--", "-.", ":")


@dataclass(frozen=True)
class Look:
    """The appearance of one contender."""

    color: str
    marker: str
    dashes: str

    @property
    def line(self) -> dict[str, object]:
        """Returns the style of a line with markers, for matplotlib."""
        return {
            **{"color": self.color, "linestyle": self.dashes, "linewidth": 1.2},
            **{"marker": self.marker, "markersize": 4.5},
            **{"markeredgecolor": PAPER, "markeredgewidth": 0.4},
        }


def looks(rows: pd.DataFrame) -> dict[str, Look]:
    """Returns the look of every contender of a run."""
    result = {}
    for structure, group in rows.groupby("structure", sort=False):
        for index, contender in enumerate(dict.fromkeys(group["contender"])):
            result[contender] = variant_look(structure, index)
    return result


def variant_look(structure: str, index: int) -> Look:
    """Returns the look of one of several variants of a structure, counted from 0."""
    return Look(
        structure_color(structure),
        MARKERS[index % len(MARKERS)],
        DASHES[index % len(DASHES)],
    )
