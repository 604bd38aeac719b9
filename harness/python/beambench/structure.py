"""Structures: building them over a scene, and tracing."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beambench import _beambench
from beambench._beambench import NO_PRIMITIVE, InputError
from beambench.arrays import rays_in_place, text, whole_number
from beambench.scene import Camera, Scene


@dataclass(frozen=True, eq=False)
class Hits:
    """The closest hits of rays, in arrays with the shape of the rays or of the image."""

    t: NDArray[np.float32]
    """The hit is at origin + t * direction; infinity: a miss."""
    primitive: NDArray[np.uint32]
    """The id of the primitive; NO_PRIMITIVE: a miss."""
    counters: dict[str, int] | None = None
    """The amounts of work for all rays, by name, if the work was counted."""

    @property
    def hit(self) -> NDArray[np.bool_]:
        """Whether each ray hits anything."""
        hit: NDArray[np.bool_] = self.primitive != NO_PRIMITIVE
        return hit


def require_threads(threads: int) -> int:
    """Returns a valid number of threads."""
    if not 0 <= whole_number("threads", threads) <= 1024:
        raise InputError(f"threads is {threads}; expected 1 to 1024, or 0 for one per core")
    return int(threads)


def _shown(value: float | str) -> str:
    return value if isinstance(value, str) else f"{value:,.6g}" if value % 1 else f"{value:,.0f}"


def _text(value: object) -> str:
    return str(value).lower() if isinstance(value, bool | np.bool_) else str(value)


class Structure:
    """An acceleration structure over a scene. Its methods may be called from several threads."""

    def __init__(
        self, scene: Scene, spec: str, *, threads: int = 1, **parameters: float | bool | str
    ) -> None:
        """Builds a structure.

        Args:
            scene: the scene over which the structure is built; the structure keeps it alive.
            spec: a name, with or without parameters: `"sah-bvh"`, `"samet:max_level=6"`; see
                `structures`.
            threads: number of threads that trace images, unless `trace_image` overrides it; 0: one
                per core, within the CPU quota.
            parameters: further parameters: `max_level=6`.

        Raises:
            InputError: an unknown name or parameter, or a value out of range; the message lists
                the valid names or values.
        """
        if not isinstance(scene, Scene):
            raise TypeError(f"scene is a {type(scene).__name__}; expected a beambench.Scene")
        threads = require_threads(threads)
        spec = text("spec", spec)
        if parameters:
            given = ",".join(f"{name}={_text(value)}" for name, value in parameters.items())
            spec = f"{spec}{',' if ':' in spec else ':'}{given}"
        self.scene = scene
        self._compiled = _beambench.build_structure(scene._compiled, spec, threads)

    @property
    def name(self) -> str:
        """The name with all parameters: `samet:max_level=6,max_objects=0,...`."""
        return self._compiled.label

    @property
    def statistics(self) -> dict[str, int | float | str]:
        """Sizes: nodes, leaves, references, depth, bytes, and the structure's own statistics."""
        return self._compiled.statistics

    def closest_hits(self, rays: ArrayLike, *, counters: bool = False) -> Hits:
        """Returns the closest hit of each ray in [t_min, t_max]; at equal t, the lowest id.

        Args:
            rays: shape (N, 8), float32: origin, t_min, direction, t_max. Such an array in one
                block of memory is used without a copy; anything else is converted first. The
                array must not be changed during the call.
            counters: count the work, which takes longer.

        Returns:
            Arrays of shape (N,) in the memory to which the structure wrote.

        Raises:
            InputError: another shape, or an invalid ray; the message states its index.
            TypeError: another dtype.
        """
        t, primitive, counts = self._compiled.closest_hits(rays_in_place(rays), bool(counters))
        return Hits(t, primitive, counts)

    def any_hits(self, rays: ArrayLike) -> NDArray[np.bool_]:
        """Returns whether each ray hits anything in [t_min, t_max].

        Args:
            rays: see `closest_hits`.

        Returns:
            Shape (N,), bool, in the memory to which the structure wrote.

        Raises:
            InputError, TypeError: see `closest_hits`.
        """
        hits, _ = self._compiled.any_hits(rays_in_place(rays), False)
        return hits.view(np.bool_)

    def any_hit_counters(self, rays: ArrayLike) -> dict[str, int]:
        """Returns the amounts of work of `any_hits`, by name.

        Args:
            rays: see `closest_hits`.

        Raises:
            InputError, TypeError: see `closest_hits`.
        """
        _, counts = self._compiled.any_hits(rays_in_place(rays), True)
        return counts or {}

    def trace_image(
        self,
        *,
        resolution: tuple[int, int] | None = None,
        camera: Camera | str | None = None,
        samples: int = 1,
        threads: int | None = None,
        counters: bool = False,
    ) -> Hits:
        """Returns the closest hits of an image's rays, using the structure's query for images.

        Args:
            resolution: width and height; None: the camera's own.
            camera: None: the scene's first.
            samples: rays per pixel: 1, 4, 5, 9, 16, ...
            threads: None: the number for which the structure was built; 0: one per core,
                within the CPU quota.
            counters: count the work, which takes longer.

        Returns:
            Arrays of shape (height, width), the top row first; (height, width, samples) for
            several samples. They are in the memory to which the structure wrote.

        Raises:
            InputError: an unknown camera, or an invalid image.
        """
        count = None if threads is None else require_threads(threads)
        image = self.scene._image(camera, resolution, samples)
        return Hits(*self._compiled.trace_image(image, count, bool(counters)))

    def render(
        self,
        *,
        resolution: tuple[int, int] | None = None,
        camera: Camera | str | None = None,
        samples: int = 1,
        shading: str = "preview",
        threads: int = 0,
    ) -> NDArray[np.float32]:
        """Draws a picture through this structure.

        The arguments are those of `Scene.render`.
        """
        return self.scene.render(
            resolution=resolution,
            camera=camera,
            samples=samples,
            shading=shading,
            structure=self,
            threads=threads,
        )

    def __repr__(self) -> str:
        """Returns the name, the parameters and the scene in one line."""
        return f"<beambench.Structure '{self.name}' over '{self.scene.name}'>"

    def _repr_html_(self) -> str:
        name, _, parameters = self.name.partition(":")
        rows = "".join(
            f"<tr><th>{escape(key)}</th><td>{escape(_shown(value))}</td></tr>"
            for key, value in self.statistics.items()
            if value not in (0, "")
        )
        return (
            f"<p><b>{escape(name)}</b> over {escape(self.scene.name)}<br>"
            f"<small>{escape(parameters.replace(',', ', '))}</small></p><table>{rows}</table>"
        )
