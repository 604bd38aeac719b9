"""Pictures for displays."""

from __future__ import annotations

import base64
import struct
import zlib

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beambench.arrays import reals


def to_srgb(picture: ArrayLike) -> NDArray[np.uint8]:
    """Encodes linear light for displays: for `matplotlib.pyplot.imshow` and image files.

    Args:
        picture: shape (height, width, 3), as `Scene.render` returns it.

    Returns:
        A new array of the same shape, uint8, in sRGB; values above 1 are clipped.

    Raises:
        InputError: the array has another shape.
    """
    light = np.clip(reals("picture", picture, ("height", "width", 3), np.float32), 0.0, 1.0)
    encoded = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    display: NDArray[np.uint8] = np.round(255.0 * encoded).astype(np.uint8)
    return display


def to_png(picture: NDArray[np.uint8]) -> bytes:
    """Returns a PNG file of an sRGB picture of shape (height, width, 3)."""
    height, width, _ = picture.shape

    def chunk(kind: bytes, content: bytes) -> bytes:
        checked = kind + content
        return struct.pack(">I", len(content)) + checked + struct.pack(">I", zlib.crc32(checked))

    # Each row begins with the number of its filter; 0: no filter.
    rows = np.insert(picture.reshape(height, 3 * width), 0, 0, axis=1)
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"".join(
        (
            b"\x89PNG\r\n\x1a\n",
            chunk(b"IHDR", header),
            chunk(b"IDAT", zlib.compress(rows.tobytes())),
            chunk(b"IEND", b""),
        )
    )


def to_img(picture: NDArray[np.uint8], words: str) -> str:
    """Returns an HTML element that contains the picture; `words` are plain text without quotes."""
    data = base64.b64encode(to_png(picture)).decode()
    return f'<img alt="{words}" src="data:image/png;base64,{data}">'
