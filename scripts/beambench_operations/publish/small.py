"""Chooses the files of a run to commit: small ones from which every figure can be recomputed."""

import gzip
import shutil
from collections.abc import Sequence
from pathlib import Path

from PIL import Image

from beambench_operations.publish.layout import with_small_images
from beambench_report.base.files import write_text
from beambench_report.base.run_log import LOG, PACKED_LOG

_COLORS = 256
_NOT_COMMITTED = (
    "analysis.json",
    "google-benchmark.json",
    "report.html",
    "*answers.jsonl",
    "tasks",
)
"""Files that are not committed. Simulations of the cluster start from `tasks`, which has the cost
of each beam, and continue from `answers` if they were interrupted.
"""


def make_small(folder: Path) -> None:
    """Removes everything from a finished folder that is not committed.

    Logs are compressed by gzip; plots are kept as SVG, and pictures get a palette.
    """
    for log in sorted(folder.rglob(LOG)):
        _pack(log)
    leave_out(folder, [f"**/{name}" for name in _NOT_COMMITTED])
    make_images_small(folder)


def _pack(log: Path) -> None:
    """Replaces a log by its compressed form; equal logs give equal bytes."""
    with (
        log.with_name(PACKED_LOG).open("wb") as file,
        gzip.GzipFile("", "wb", fileobj=file, mtime=0) as packed,
    ):
        packed.write(log.read_bytes())
    log.unlink()


def leave_out(folder: Path, patterns: Sequence[str]) -> None:
    """Removes the files and folders in a finished folder that match a pattern."""
    for pattern in patterns:
        for path in sorted(folder.glob(pattern)):
            if path.is_dir():
                shutil.rmtree(path)
            else:
                path.unlink()


def make_images_small(folder: Path) -> None:
    """Keeps plots only as SVG, gives pictures a palette, and updates links in texts."""
    for picture in sorted(folder.rglob("*.png")):
        if picture.with_suffix(".svg").is_file():
            picture.unlink()
        else:
            with_palette(picture)
    for text in folder.rglob("*.md"):
        write_text(text, with_small_images(text.read_text("utf-8"), text.parent))


def with_palette(picture: Path) -> None:
    """Writes a PNG with a small palette, if that is smaller."""
    with Image.open(picture) as image:
        if image.mode == "P":
            return
        has_alpha = image.mode in ("RGBA", "LA")
        opaque = Image.new("RGB", image.size, "white")
        opaque.paste(image.convert("RGB"), mask=image.getchannel("A") if has_alpha else None)
    pending = picture.with_name(f".pending-{picture.name}")
    palette = opaque.quantize(_COLORS)
    # Dithered; otherwise curved surfaces show steps.
    small = opaque.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG)
    small.save(pending, "PNG", optimize=True)
    if pending.stat().st_size < picture.stat().st_size:
        pending.replace(picture)
    else:
        pending.unlink()


def size(folder: Path) -> int:
    """Returns the bytes of all files."""
    return sum(file.stat().st_size for file in folder.rglob("*") if file.is_file())
