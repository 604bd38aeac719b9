"""The images of a page: the pictures and the plots of a run's folder."""

import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from beambench_report.base.names import PLOT_INDEX, file_stems
from beambench_report.run.html import thumbnail_uri
from beambench_report.run.inline_svg import inline_svg


@dataclass(frozen=True)
class Image:
    """An image that is part of the page: a picture by its address, or a plot by its element."""

    caption: str
    subject: str
    """The scene (of a picture) or the view (of a plot) it belongs to; empty: the whole run."""
    uri: str = ""
    svg: str = ""


def read_pictures(directory: Path, scenes: Iterable[str]) -> list[Image]:
    """The pictures of DIRECTORY/pictures: `<scene>.png` and `<scene>-<what it shows>.png`."""
    stems = {stem: scene for scene, stem in file_stems(dict.fromkeys(scenes)).items()}
    images = []
    for path in sorted(directory.glob("pictures/*.png"), key=lambda path: path.stem):
        # The longest stem that fits: `tetra-n-6` is not the scene `tetra`.
        fitting = [s for s in stems if path.stem == s or path.stem.startswith(f"{s}-")]
        stem = max(fitting, key=len, default="")
        what = path.stem.removeprefix(stem).strip("-").replace("-", ", ").replace("_", " ")
        images.append(Image(what or "the scene", stems.get(stem, ""), thumbnail_uri(path)))
    return images


def read_plots(directory: Path) -> list[Image]:
    """The plots of DIRECTORY/plots, by the index that was written with them."""
    index = directory / "plots" / PLOT_INDEX
    if not index.exists():
        return []
    return [
        Image(entry["summary"], entry["view"], svg=inline_svg(path))
        for entry in json.loads(index.read_text("utf-8"))
        if (path := index.with_name(f"{entry['stem']}.svg")).exists()
    ]
