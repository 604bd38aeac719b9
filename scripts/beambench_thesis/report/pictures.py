"""Figures 5.4, 5.5 and 5.9: octrees of several scenes and divisions, drawn by beambench."""

import tempfile
from dataclasses import dataclass
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.image import imread

from beambench_report.base.figure import PAGE_WIDTH
from beambench_report.base.files import Problem, output_of, write_whole
from beambench_thesis.paper.printed import scene_title

_SIZE = "480x384"
_ASPECT = 480 / 384
_COLUMNS = 2
_TITLE_HEIGHT = 0.24  # inches
_DPI = 150


@dataclass(frozen=True)
class Division:
    """One octree: leaves are divided down to a level, unless they have few objects."""

    scene: str
    level: int
    objects: int

    @property
    def title(self) -> str:
        """Returns `Maceta, level 6, 10 objects`."""
        return f"{scene_title(self.scene)}, level {self.level}, {self.objects} objects"


def _criteria(scene: str) -> tuple[Division, ...]:
    """Returns the divisions of tables 5.2 and 5.3."""
    return (
        *(Division(scene, level, 0) for level in (4, 5, 6, 7)),
        *(Division(scene, 6, objects) for objects in (10, 20, 40)),
    )


_FIGURES = {
    "5.4": ("Maceta by different criteria of division", _criteria("maceta")),
    "5.5": ("Delfines by different criteria of division", _criteria("delfines")),
    "5.9": (
        "Octrees of four scenes",
        tuple(
            Division(scene, 6, 0)
            for scene in ("bola-espacial", "caracol", "tetera", "torre-eiffel")
        ),
    ),
}
_CAPTION = (
    "The occupied leaves of the octree, drawn over the scene. A leaf is divided down to the level "
    "(the root being 1) while it holds more objects than stated."
)


@dataclass(frozen=True)
class PictureFigure:
    """A figure of pictures, or only a caption that states why it could not be made."""

    number: str
    title: str
    path: Path | None
    caption: str


def octree_figures(
    numbers: tuple[str, ...], directory: Path, beambench: Path
) -> list[PictureFigure]:
    """Renders the figures that are missing in DIRECTORY/figures, each as one sheet."""
    folder = directory / "figures"
    folder.mkdir(exist_ok=True)
    return [
        _figure(number, *_FIGURES[number], folder / f"figure-{number}.png", beambench)
        for number in numbers
        if number in _FIGURES
    ]


def _figure(
    number: str, title: str, divisions: tuple[Division, ...], path: Path, beambench: Path
) -> PictureFigure:
    if path.exists():
        return PictureFigure(number, title, path, _CAPTION)
    with tempfile.TemporaryDirectory() as folder:
        pictures = {
            division: Path(folder) / f"{place}.png" for place, division in enumerate(divisions)
        }
        for division, picture in pictures.items():
            accel = f"samet:max_level={division.level},max_objects={division.objects}"
            command = [str(beambench), "render", division.scene, "--accel", accel]
            command += ["--overlay", "cells", "--resolution", _SIZE, "-o", str(picture)]
            try:
                output_of(command)
            except Problem as problem:
                return PictureFigure(number, title, None, f"{division.title}: {problem}")
        sheet = _sheet(pictures)
        write_whole(
            path,
            lambda pending: sheet.savefig(
                pending, format="png", dpi=_DPI, pil_kwargs={"optimize": True}
            ),
        )
    return PictureFigure(number, title, path, _CAPTION)


def _sheet(pictures: dict[Division, Path]) -> Figure:
    rows = -(-len(pictures) // _COLUMNS)
    height = rows * (PAGE_WIDTH / _COLUMNS / _ASPECT + _TITLE_HEIGHT)
    figure = Figure(figsize=(PAGE_WIDTH, height), layout="constrained")
    panels = list(figure.subplots(rows, _COLUMNS, squeeze=False).flat)
    for panel in panels:
        panel.set_axis_off()
    for panel, (division, path) in zip(panels, pictures.items(), strict=False):
        panel.imshow(imread(path))
        panel.set_title(division.title, loc="left", fontsize=9)
    return figure
