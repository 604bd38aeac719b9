"""Pictures of scenes, rendered by beambench: those of a run, or a contact sheet."""

import json
import math
import subprocess
import sys
import tempfile
import textwrap
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.image import imread

from beambench_report.base.files import Problem, output_of, write_whole
from beambench_report.base.names import file_stems
from beambench_report.base.records import OK, Run, read_run

_RENDERER = "embree"
_HEATMAP_STRUCTURE = "samet"
_HEATMAP_COUNTER = "traversal_steps"


def write_pictures(directory: Path, beambench: Path) -> list[Path]:
    """Fills DIRECTORY/pictures: each scene of the run, and a heat map of one structure's work."""
    run = read_run(directory)
    folder = directory / "pictures"
    folder.mkdir(exist_ok=True)
    paths = []
    for scene, stem in file_stems(dict.fromkeys(run.rows["scene"])).items():
        picture = folder / f"{stem}.png"
        _render(beambench, scene, _RENDERER, picture)
        paths.append(picture)
        structure = _heatmap_structure(run, scene)
        if structure:
            heatmap = folder / f"{stem}-{_HEATMAP_STRUCTURE}-{_HEATMAP_COUNTER}.png"
            _render(beambench, scene, structure, heatmap, "--heatmap", _HEATMAP_COUNTER)
            paths.append(heatmap)
    return paths


def _heatmap_structure(run: Run, scene: str) -> str | None:
    """The first of the structure's variants that was right on this scene, as `--accel` takes it."""
    rows = run.rows[
        (run.rows["scene"] == scene)
        & (run.rows["structure"] == _HEATMAP_STRUCTURE)
        & (run.rows["verdict"] == OK)
    ]
    if rows.empty:
        return None
    parameters = rows["parameters"].iloc[0]
    return f"{_HEATMAP_STRUCTURE}:{parameters}" if parameters else _HEATMAP_STRUCTURE


def _render(beambench: Path, scene: str, structure: str, output: Path, *options: str) -> None:
    command = [str(beambench), "render", scene, "--accel", structure, "-o", str(output), *options]
    try:
        status = subprocess.run(command, check=False).returncode
    except OSError as error:
        raise Problem(f"{beambench} cannot be run: {error.strerror}; build it first") from None
    if status != 0:
        raise Problem(f"`{' '.join(command)}` ended with exit code {status}")


_PAINTER = "sah-bvh"
_SAMPLES = "4"
_SHADING = "whitted"

# All below in pixels of the sheet.
_WIDTH = 1400
_MARGIN = 12
_GAP = 10
_LINE = 20  # of a label
_LABEL_FONT = 15
_LETTER = 8.2  # mean width at that size
_HEADING = 40
_HEADING_FONT = 22

_HIGHEST = 340  # of a picture
_DPI = 100

_LONGEST_ROW = 6  # pictures


@dataclass(frozen=True)
class Group:
    """Scenes that stand together, under a heading where there are several groups."""

    heading: str
    scenes: tuple[str, ...]


DEFAULT_GROUPS = (
    Group(
        "Stand-ins for the fifteen scenes of the thesis",
        tuple(
            "escena1 escena2 delfines maceta habitacion misil bola-espacial tetera stetra "
            "torre-eiffel ajedrez caracol casa-de-campo flamenco gato-bill".split()
        ),
    ),
    Group(
        "Haines's Standard Procedural Databases",
        tuple(
            "balls tetra shells teapot gears mount rings tree jacks lattice sombrero".split(),
        ),
    ),
    Group("Others", ("finishes", "closed-room", "tessellated-balls", "bumpy", "soup")),
)


@dataclass(frozen=True)
class _Picture:
    scene: str
    counts: str
    pixels: np.ndarray

    @property
    def aspect(self) -> float:
        """Width over height."""
        return self.pixels.shape[1] / self.pixels.shape[0]


@dataclass(frozen=True)
class _Row:
    """Pictures of one height, under each its name and its counts."""

    heading: str
    pictures: list[_Picture]
    picture_height: float

    @property
    def height(self) -> float:
        lines = max(len(_label(picture, self.picture_height)) for picture in self.pictures)
        return (_HEADING if self.heading else 0) + self.picture_height + _LINE * lines + 2 * _GAP


def write_contact_sheet(output: Path, beambench: Path, scenes: list[str] | None = None) -> Path:
    """Renders the scenes, those of DEFAULT_GROUPS if none are given, and writes one PNG of them."""
    if output.suffix != ".png":
        raise Problem(f"{output}: a contact sheet is a .png")
    if not output.parent.is_dir():
        raise Problem(f"{output}: there is no folder {output.parent}")
    groups = (Group("", tuple(scenes)),) if scenes else DEFAULT_GROUPS
    counts = {scene: _counts(beambench, scene) for group in groups for scene in group.scenes}
    with tempfile.TemporaryDirectory() as folder:
        pictures = _render_all(beambench, counts, Path(folder))
    figure = _draw([row for group in groups for row in _rows(group, pictures)])
    return write_whole(
        output,
        lambda path: figure.savefig(path, format="png", dpi=_DPI, pil_kwargs={"optimize": True}),
    )


def _counts(beambench: Path, scene: str) -> str:
    """What the scene holds, for its label."""
    about = json.loads(_run(beambench, scene, "scene", scene, "--json"))
    numbers = {kind: about[f"{kind}s"] for kind in ("polygon", "sphere", "cone")}
    # A number and its noun stay on one line.
    return ", ".join(f"{n:,}\N{NO-BREAK SPACE}{k}{'s' * (n > 1)}" for k, n in numbers.items() if n)


def _render_all(beambench: Path, counts: dict[str, str], folder: Path) -> dict[str, _Picture]:
    pictures = {}
    for number, (scene, text) in enumerate(counts.items(), 1):
        print(f"rendering {scene} ({number} of {len(counts)})", file=sys.stderr)
        file = folder / "picture.png"
        options = ("--accel", _PAINTER, "--samples", _SAMPLES, "--shade", _SHADING)
        _run(beambench, scene, "render", scene, *options, "-o", str(file))
        pictures[scene] = _Picture(scene, text, imread(file)[..., :3])
    return pictures


def _run(beambench: Path, scene: str, *arguments: str) -> str:
    """The standard output of beambench."""
    try:
        return output_of([str(beambench), *arguments])
    except Problem as problem:
        why = str(problem).removeprefix("beambench: ")
        raise Problem(f"scene '{scene}' cannot be rendered: {why}") from None


def _rows(group: Group, pictures: dict[str, _Picture]) -> list[_Row]:
    """Rows of as equal lengths as can be, as high as lets the widest fill the sheet."""
    scenes = group.scenes
    length = math.ceil(len(scenes) / math.ceil(len(scenes) / _LONGEST_ROW))
    starts = range(0, len(scenes), length)
    rows = [[pictures[scene] for scene in scenes[start : start + length]] for start in starts]
    height = min(_HIGHEST, *(_space(row) / sum(p.aspect for p in row) for row in rows))
    return [_Row("" if index else group.heading, row, height) for index, row in enumerate(rows)]


def _space(row: list[_Picture]) -> float:
    return _WIDTH - 2 * _MARGIN - _GAP * (len(row) - 1)


def _label(picture: _Picture, height: float) -> list[tuple[str, str]]:
    """The lines under a picture that is so high, each with its weight."""
    letters = max(12, int(height * picture.aspect / _LETTER))
    name = [(line, "bold") for line in textwrap.wrap(picture.scene, letters - 1)]
    return name + [(line, "normal") for line in textwrap.wrap(picture.counts, letters)]


def _draw(rows: list[_Row]) -> Figure:
    height = math.ceil(sum(row.height for row in rows) + 2 * _MARGIN)
    figure = Figure(figsize=(_WIDTH / _DPI, height / _DPI), dpi=_DPI, facecolor="white")
    top = float(_MARGIN)
    for row in rows:
        below = top
        if row.heading:
            _write(figure, _MARGIN, top, row.heading, _HEADING_FONT, "bold")
            below += _HEADING
        left = float(_MARGIN)
        for picture in row.pictures:
            _draw_picture(figure, picture, left, below, row.picture_height)
            left += picture.aspect * row.picture_height + _GAP
        top += row.height
    return figure


def _draw_picture(
    figure: Figure, picture: _Picture, left: float, top: float, height: float
) -> None:
    width, whole = _WIDTH, figure.get_figheight() * _DPI
    place = (left / width, 1 - (top + height) / whole, picture.aspect * height / width)
    axes = figure.add_axes((*place, height / whole))
    axes.set_axis_off()
    axes.imshow(picture.pixels, aspect="auto")
    for number, (line, weight) in enumerate(_label(picture, height)):
        _write(figure, left, top + height + 2 + number * _LINE, line, _LABEL_FONT, weight)


def _write(figure: Figure, left: float, top: float, text: str, size: float, weight: str) -> None:
    """Writes a line below and right of a point, its size in pixels."""
    figure.text(
        left / _WIDTH,
        1 - top / (figure.get_figheight() * _DPI),
        text,
        fontsize=size * 72 / _DPI,
        fontweight=weight,
        verticalalignment="top",
        parse_math=False,
    )
