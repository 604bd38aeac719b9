"""Makes pictures of scenes with beambench: one for each scene of a run, or a contact sheet."""

import json
import math
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.image import imread

from beambench_report.base.files import Problem, output_of, write_whole
from beambench_report.base.names import file_stems, path_of_name
from beambench_report.base.records import OK, Run, read_run
from beambench_report.run.sheet_layout import (
    HEADING,
    HEADING_FONT,
    LABEL_FONT,
    LINE,
    MARGIN,
    WIDTH,
    Picture,
    Row,
    even_rows,
    label,
)

# Clips at most 1% of the pixels and brightens dark pictures.
_EXPOSURE = ("--exposure", "auto")

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
        _run(beambench, scene, *_render(scene, _RENDERER, picture), *_EXPOSURE)
        paths.append(picture)
        structure = _heatmap_structure(run, scene)
        if structure:
            heatmap = folder / f"{stem}-{_HEATMAP_STRUCTURE}-{_HEATMAP_COUNTER}.png"
            _run(
                *(beambench, scene, *_render(scene, structure, heatmap)),
                *("--heatmap", _HEATMAP_COUNTER),
            )
            paths.append(heatmap)
    return paths


def _heatmap_structure(run: Run, scene: str) -> str | None:
    """Returns the structure's first correct variant on this scene, in the form of `--accel`."""
    rows = run.rows[
        (run.rows["scene"] == scene)
        & (run.rows["structure"] == _HEATMAP_STRUCTURE)
        & (run.rows["verdict"] == OK)
    ]
    if rows.empty:
        return None
    parameters = rows["parameters"].iloc[0]
    return f"{_HEATMAP_STRUCTURE}:{parameters}" if parameters else _HEATMAP_STRUCTURE


def _render(scene: str, structure: str, output: Path) -> tuple[str, ...]:
    return ("render", path_of_name(scene), "--accel", structure, "-o", str(output))


_PAINTER = "sah-bvh"
_SAMPLES = "4"
_SHADING = "whitted"
_DPI = 100


_VIEWS = {
    "misil": (("--depth", "1"), ""),  # its surfaces are pale mirrors of the sky otherwise
    "soup": (("--angle", "12"), "close up"),  # its triangles are smaller than pixels otherwise
}
"""Options for scenes whose own camera or mirrors show little, and notes for their labels."""


@dataclass(frozen=True)
class Group:
    """Scenes of one group, under a heading if there are several groups."""

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
    Group(
        "Scenes that move, in their first frames",
        tuple(
            "waving-sheet turning-solids twisting-body exploding-mesh falling-spheres".split(),
        ),
    ),
    Group(
        "Others",
        ("finishes", "closed-room", "prism", "aquarium", "tessellated-balls", "bumpy", "soup"),
    ),
)


def write_contact_sheet(output: Path, beambench: Path, scenes: list[str] | None = None) -> Path:
    """Renders the scenes (by default of DEFAULT_GROUPS) and writes them as one PNG."""
    if output.suffix != ".png":
        raise Problem(f"{output}: a contact sheet must be a .png file")
    if not output.parent.is_dir():
        raise Problem(f"{output}: there is no folder {output.parent}")
    groups = (Group("", tuple(scenes)),) if scenes else DEFAULT_GROUPS
    counts = {scene: _counts(beambench, scene) for group in groups for scene in group.scenes}
    with tempfile.TemporaryDirectory() as folder:
        pictures = _render_all(beambench, counts, Path(folder))
    rows = [even_rows(g.heading, [pictures[scene] for scene in g.scenes]) for g in groups]
    figure = _draw([row for group in rows for row in group])
    return write_whole(
        output,
        lambda path: figure.savefig(path, format="png", dpi=_DPI, pil_kwargs={"optimize": True}),
    )


def registered_meshes(beambench: Path) -> list[str]:
    """Returns the names of the meshes that scripts/meshes, or a user, registered."""
    meshes = json.loads(output_of([str(beambench), "list", "--json"]))["meshes"]
    if not meshes:
        raise Problem("no mesh is registered; run scripts/meshes first")
    return [mesh["name"] for mesh in meshes]


def _counts(beambench: Path, scene: str) -> str:
    """Returns the numbers of primitives in the scene, for its label."""
    about = json.loads(_run(beambench, scene, "scene", scene, "--json"))
    numbers = {kind: about[f"{kind}s"] for kind in ("polygon", "sphere", "cone")}
    # A number and its noun stay on one line.
    return ", ".join(f"{n:,}\N{NO-BREAK SPACE}{k}{'s' * (n > 1)}" for k, n in numbers.items() if n)


def _render_all(beambench: Path, counts: dict[str, str], folder: Path) -> dict[str, Picture]:
    pictures = {}
    for number, (scene, text) in enumerate(counts.items(), 1):
        print(f"rendering {scene} ({number} of {len(counts)})", file=sys.stderr)
        file = folder / "picture.png"
        own, note = _VIEWS.get(scene, ((), ""))
        options = ("--accel", _PAINTER, "--samples", _SAMPLES, "--shade", _SHADING, *_EXPOSURE)
        _run(beambench, scene, "render", scene, *options, *own, "-o", str(file))
        about = ", ".join(filter(None, (text, note)))
        pictures[scene] = Picture(scene, about, imread(file)[..., :3])
    return pictures


def _run(beambench: Path, scene: str, *arguments: str) -> str:
    """Returns the standard output of beambench."""
    try:
        return output_of([str(beambench), *arguments])
    except Problem as problem:
        why = str(problem).removeprefix("beambench: ")
        raise Problem(f"scene '{scene}' cannot be rendered: {why}") from None


def _draw(rows: list[Row]) -> Figure:
    height = math.ceil(sum(row.height for row in rows) + 2 * MARGIN)
    figure = Figure(figsize=(WIDTH / _DPI, height / _DPI), dpi=_DPI, facecolor="white")
    top = float(MARGIN)
    for row in rows:
        below = top
        if row.heading:
            _write(figure, MARGIN, top, row.heading, HEADING_FONT, "bold")
            below += HEADING
        bottom = round(below + row.picture_height)
        for picture, (left, right) in zip(row.pictures, row.edges(), strict=True):
            _draw_picture(figure, picture, (left, right), (round(below), bottom))
            for number, (line, weight) in enumerate(label(picture, row.picture_height)):
                _write(figure, left, bottom + 2 + number * LINE, line, LABEL_FONT, weight)
        top += row.height
    return figure


def _draw_picture(
    figure: Figure, picture: Picture, across: tuple[int, int], down: tuple[int, int]
) -> None:
    """Draws between the edges left and right, top and bottom, in pixels."""
    whole = figure.get_figheight() * _DPI
    (left, right), (top, bottom) = across, down
    place = (left / WIDTH, 1 - bottom / whole, (right - left) / WIDTH, (bottom - top) / whole)
    axes = figure.add_axes(place)
    axes.set_axis_off()
    axes.imshow(picture.pixels, aspect="auto")


def _write(figure: Figure, left: float, top: float, text: str, size: float, weight: str) -> None:
    """Writes a line below and to the right of a point; all lengths are in pixels."""
    figure.text(
        left / WIDTH,
        1 - top / (figure.get_figheight() * _DPI),
        text,
        fontsize=size * 72 / _DPI,
        fontweight=weight,
        verticalalignment="top",
        parse_math=False,
    )
