"""Pictures for displays."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beambench.arrays import reals


def to_srgb(picture: ArrayLike) -> NDArray[np.uint8]:
    """Encodes linear light for a display, as `matplotlib.pyplot.imshow` and image files expect.

    Args:
        picture: shape (height, width, 3), as `Scene.render` returns it.

    Returns:
        A new array of the same shape, uint8, in sRGB; what is brighter than 1 is clipped.

    Raises:
        InputError: the array has another shape.
    """
    light = np.clip(reals("picture", picture, ("height", "width", 3), np.float32), 0.0, 1.0)
    encoded = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    display: NDArray[np.uint8] = np.round(255.0 * encoded).astype(np.uint8)
    return display
