"""Pages that show in 3D how structures trace a scene, ray by ray."""

from __future__ import annotations

import html
import os
from dataclasses import dataclass
from pathlib import Path

from beambench import _beambench
from beambench.arrays import text
from beambench.scene import Camera, Scene


@dataclass(frozen=True)
class Page:
    """A self-contained page, which a notebook displays inline."""

    html: str
    """The whole document; it needs no network."""
    height: int = 1100
    """The height in a notebook, in pixels."""

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Writes the page to a file.

        Args:
            path: the file, which is replaced if it exists.

        Returns:
            The path of the file.
        """
        file = Path(path)
        file.write_text(self.html, encoding="utf-8")
        return file

    def _repr_html_(self) -> str:
        document = html.escape(self.html, quote=True)
        style = f"width: 100%; height: {self.height}px; border: 0"
        return f'<iframe srcdoc="{document}" style="{style}"></iframe>'

    def __repr__(self) -> str:
        """Returns the size of the document."""
        return f"<beambench.Page of {len(self.html) / 1e6:.1f} MB; save it to open it in a browser>"


def explain(
    scene: Scene,
    structure: str,
    second: str | None = None,
    *,
    camera: Camera | str | None = None,
    resolution: tuple[int, int] | None = None,
) -> Page:
    """Makes a page that shows how one structure, or two side by side, trace a scene.

    Args:
        scene: the scene.
        structure: a name with or without parameters, such as `"samet:max_level=5"`.
        second: another structure, shown beside the first.
        camera: the camera of the image; None: the scene's first.
        resolution: width and height of the image whose rays are followed, up to 65,536 pixels;
            None: 96 pixels along the longer side.

    Returns:
        The page. A notebook displays it as the last value of a cell; `save` writes it to a file.

    Raises:
        InputError: an unknown name or parameter, or an invalid image.
    """
    if not isinstance(scene, Scene):
        raise TypeError(f"scene is a {type(scene).__name__}; expected a beambench.Scene")
    names = [text("structure", structure)]
    if second is not None:
        names.append(text("second", second))
    image = scene._image(camera, resolution, 1)
    return Page(_beambench.explain_html(scene._compiled, ",".join(names), image))
