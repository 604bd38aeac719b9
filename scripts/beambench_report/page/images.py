"""Pictures and plots of a run as parts of its page."""

from __future__ import annotations

import base64
import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from beambench_report.names import PLOT_INDEX, file_stems

_TYPES = {".png": "image/png", ".svg": "image/svg+xml"}


@dataclass(frozen=True)
class Image:
    """An image that brings its own bytes."""

    uri: str
    caption: str
    subject: str
    """The scene (of a picture) or the view (of a plot) it belongs to; empty: the whole run."""


def read_pictures(directory: Path, scenes: Iterable[str]) -> list[Image]:
    """The pictures of DIRECTORY/pictures: `<scene>.png` and `<scene>-<what it shows>.png`."""
    stems = {stem: scene for scene, stem in file_stems(dict.fromkeys(scenes)).items()}
    images = []
    for path in sorted(directory.glob("pictures/*.png"), key=lambda path: path.stem):
        # The longest stem that fits: `tetra-n-6` is not the scene `tetra`.
        fitting = [s for s in stems if path.stem == s or path.stem.startswith(f"{s}-")]
        stem = max(fitting, key=len, default="")
        what = path.stem.removeprefix(stem).strip("-").replace("-", ", ").replace("_", " ")
        images.append(Image(_data_uri(path), what or "the scene", stems.get(stem, "")))
    return images


def read_plots(directory: Path) -> list[Image]:
    """The plots of DIRECTORY/plots, by the index that was written with them."""
    index = directory / "plots" / PLOT_INDEX
    if not index.exists():
        return []
    return [
        Image(_data_uri(path), entry["summary"], entry["view"])
        for entry in json.loads(index.read_text("utf-8"))
        if (path := index.with_name(f"{entry['stem']}.svg")).exists()
    ]


def _data_uri(path: Path) -> str:
    coded = base64.b64encode(path.read_bytes()).decode("ascii")
    return f"data:{_TYPES[path.suffix]};base64,{coded}"
