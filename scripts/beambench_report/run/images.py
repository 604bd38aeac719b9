"""The images of a page: the pictures and the plots in a run's folder."""

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from beambench_report.base.figure import house_style, svg_of
from beambench_report.base.names import PLOT_INDEX, file_stems
from beambench_report.run.html import thumbnail_uri
from beambench_report.run.inline_svg import inline_svg
from beambench_report.run.measured import Measured
from beambench_report.run.plots import KINDS, Kind, draw, without_figure


@dataclass(frozen=True)
class Image:
    """An image embedded in the page: a picture as a data URI, or a plot as an SVG element."""

    caption: str
    subject: str
    """The scene of a picture or the view of a plot; empty for the whole run."""
    uri: str = ""
    svg: str = ""


def read_pictures(directory: Path, scenes: Iterable[str]) -> list[Image]:
    """Returns the pictures of DIRECTORY/pictures: `<scene>.png` and `<scene>-<content>.png`."""
    stems = {stem: scene for scene, stem in file_stems(dict.fromkeys(scenes)).items()}
    images = []
    for path in sorted(directory.glob("pictures/*.png"), key=lambda path: path.stem):
        # The longest stem that fits: `tetra-n-6` is not the scene `tetra`.
        fitting = [s for s in stems if path.stem == s or path.stem.startswith(f"{s}-")]
        stem = max(fitting, key=len, default="")
        what = path.stem.removeprefix(stem).strip("-").replace("-", ", ").replace("_", " ")
        images.append(Image(what or "the scene", stems.get(stem, ""), thumbnail_uri(path)))
    return images


@dataclass(frozen=True)
class Figures:
    """The plots of a page."""

    images: tuple[Image, ...]
    missing: tuple[Kind, ...]
    """The kinds for which the record has no data."""
    undrawn: tuple[Kind, ...] = ()
    """The kinds that were not requested on this page."""


def figures_of(measured: Measured, kinds: Sequence[Kind] = KINDS) -> Figures:
    """Returns the plots in the run's folder; if there are none, draws plots of `kinds`."""
    found = read_plots(measured.run.directory)
    if found is not None:
        return Figures(tuple(found.values()), tuple(without_figure(found)))
    with house_style():
        drawn = {
            plot.stem: Image(plot.summary, plot.view, svg=inline_svg(svg_of(plot), plot.stem))
            for plot in draw(measured, kinds)
        }
    undrawn = tuple(kind for kind in KINDS if kind not in kinds)
    return Figures(tuple(drawn.values()), tuple(without_figure(drawn, kinds)), undrawn)


def read_plots(directory: Path) -> dict[str, Image] | None:
    """Returns the plots of DIRECTORY/plots by stem; None unless all in the index exist."""
    folder = directory / "plots"
    try:
        return {
            stem: Image(
                entry["summary"],
                entry["view"],
                svg=inline_svg((folder / f"{stem}.svg").read_text("utf-8"), stem),
            )
            for entry in json.loads((folder / PLOT_INDEX).read_text("utf-8"))
            for stem in [Path(entry["stem"]).name]
        }
    except (OSError, ValueError, KeyError, TypeError):
        return None  # missing, incomplete, or of another version
