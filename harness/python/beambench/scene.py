"""Scenes, over which structures are built and in which rays are traced."""

from __future__ import annotations

import os
import warnings
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beambench import _beambench
from beambench._beambench import InputError
from beambench.arrays import encoded, ids, reals, require_coordinates, text, whole_number
from beambench.picture import to_img, to_srgb

if TYPE_CHECKING:
    from beambench.structure import Structure

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Camera:
    """A pinhole camera. `dataclasses.replace` makes a modified copy."""

    eye: Vector
    """The position of the camera."""
    at: Vector
    """A point that the camera looks at."""
    up: Vector = (0.0, 0.0, 1.0)
    """The upward direction in the image; not parallel to the view."""
    angle: float = 45.0
    """The full vertical field of view in degrees."""
    aspect: float = 1.0
    """The width of the frustum divided by its height; a resolution only samples the frustum."""
    width: int = 512
    """The image width in pixels if no resolution is given."""
    height: int = 512
    """The image height in pixels if no resolution is given."""
    name: str = "custom"
    """The name by which a camera of a scene is chosen."""


def _vector(name: str, given: ArrayLike) -> Vector:
    x, y, z = reals(name, given, (3,), np.float64).tolist()
    return x, y, z


def _compiled(camera: Camera) -> _beambench.Camera:
    return _beambench.Camera(
        name=text("name of the camera", camera.name),
        eye=_vector("eye", camera.eye),
        at=_vector("at", camera.at),
        up=_vector("up", camera.up),
        angle=float(camera.angle),
        aspect=float(camera.aspect),
        width=whole_number("width of the camera", camera.width),
        height=whole_number("height of the camera", camera.height),
    )


class Scene:
    """A scene of spheres, cones and polygons, in single precision.

    A scene never changes: structures, arrays and other threads may share it.
    """

    def __init__(self, spec: str | bytes | os.PathLike[Any], *, strict: bool = False) -> None:
        """Makes a scene of the catalogue, or reads a file.

        Args:
            spec: a name with parameters (`"balls:n=3"`, see `scenes`), a registered mesh
                (`"mesh:dragon"`), or the path of an NFF or mesh file, which need not be UTF-8.
            strict: raise an InputError if the file's reader skips or repairs something; otherwise,
                this only causes a UserWarning.

        Raises:
            InputError: no such name or file, a parameter out of range, or a malformed file (the
                message states the line).
        """
        self._compiled = _beambench.load_scene(encoded("spec", spec), bool(strict))
        self._source_rows: NDArray[np.int64] | None = None
        for warning in self._compiled.warnings:
            warnings.warn(warning, stacklevel=2)

    @classmethod
    def _of(cls, compiled: _beambench.Scene) -> Scene:
        scene = cls.__new__(cls)
        scene._compiled = compiled
        scene._source_rows = None
        return scene

    @classmethod
    def from_triangles(
        cls,
        vertices: ArrayLike,
        triangles: ArrayLike,
        *,
        name: str = "mesh",
        up: str = "z",
        degenerate: str = "error",
    ) -> Scene:
        """Makes a scene of flat, two-sided triangles; primitive i is row i of `triangles`.

        Args:
            vertices: shape (V, 3), real numbers; rounded to float32 once.
            triangles: shape (T, 3), integers: rows of `vertices`.
            name: the name of the scene.
            up: "y" or "z"; used by the cameras fitted to the scene.
            degenerate: the treatment of triangles without area after rounding, which no ray can
                hit: "error" or "skip". Skipped triangles do not count as primitives, and
                `source_rows` contains the row of each primitive.

        Raises:
            InputError: another shape, a coordinate that is not a number or beyond 1e9, an
                index without a vertex, no triangles, or a triangle without area; the message states
                the row.
            TypeError: another dtype.
        """
        points = reals("vertices", vertices, ("V", 3), np.float64)
        require_coordinates("vertices", points)
        corners = ids("triangles", triangles, ("T", 3))
        beyond = (corners >= len(points)).any(axis=1)
        if beyond.any():
            row = int(np.argmax(beyond))
            given = tuple(np.asarray(triangles)[row].tolist())
            raise InputError(
                f"triangles[{row}] is {given}, but there are {len(points)} vertices; "
                "expected row indices of vertices, from 0"
            )
        if degenerate not in ("error", "skip"):
            raise InputError(f"degenerate is {degenerate!r}; expected 'error' or 'skip'")
        flat = _beambench.triangles_without_area(points, corners)
        if len(flat) > 0 and degenerate == "error":
            row = int(flat[0])
            raise InputError(
                f"triangles[{row}] is {tuple(corners[row].tolist())}, which has no area in single "
                f"precision ({len(flat)} such rows in all); remove it, or pass degenerate='skip'"
            )
        rows = np.delete(np.arange(len(corners)), flat)
        if len(rows) == 0:
            raise InputError("triangles has no row with an area; expected at least one triangle")
        kept = corners if len(flat) == 0 else np.ascontiguousarray(corners[rows])
        scene = cls._of(
            _beambench.scene_of_triangles(text("name", name), points, kept, text("up", up))
        )
        scene._source_rows = rows
        return scene

    @classmethod
    def from_spheres(
        cls, centers: ArrayLike, radii: ArrayLike, *, name: str = "spheres", up: str = "z"
    ) -> Scene:
        """Makes a scene of hollow spheres; primitive i is row i of `centers`.

        Args:
            centers: shape (S, 3), real numbers; rounded to float32 once.
            radii: shape (S,), or one number for all spheres; rays hit a sphere with a negative
                radius only from the inside.
            name: the name of the scene.
            up: "y" or "z"; used by the cameras fitted to the scene.

        Raises:
            InputError: another shape, a value that is not a number or beyond 1e9, a radius of 0, or
                no spheres; the message states the row.
            TypeError: another dtype.
        """
        points = reals("centers", centers, ("S", 3), np.float64)
        require_coordinates("centers", points)
        shape: tuple[str, ...] = () if np.ndim(radii) == 0 else ("S",)
        sizes = reals("radii", radii, shape, np.float64)
        if sizes.ndim == 1 and len(sizes) != len(points):
            raise InputError(f"there are {len(points)} centers and {len(sizes)} radii")
        if len(points) == 0:
            raise InputError("centers has no row; expected at least one sphere")
        each = np.ascontiguousarray(np.broadcast_to(sizes, len(points)))
        wrong = ~(np.abs(each) <= 1e9) | (each.astype(np.float32) == 0.0)
        if wrong.any():
            row = int(np.argmax(wrong))
            raise InputError(
                f"radii[{row}] is {each[row]:g}; expected a number from -1e9 to 1e9, but not 0"
            )
        return cls._of(
            _beambench.scene_of_spheres(text("name", name), points, each, text("up", up))
        )

    @property
    def name(self) -> str:
        """The name with all parameters, or the file's path."""
        return self._compiled.name

    @property
    def primitives(self) -> int:
        """The number of primitives; their ids are 0 ... primitives - 1."""
        return self._compiled.primitives

    @property
    def lights(self) -> int:
        """The number of point lights, for shadow rays and pictures."""
        return self._compiled.lights

    @property
    def hash(self) -> str:
        """The hash of what rays can hit: 16 hexadecimal digits, the same on every machine."""
        return self._compiled.hash

    @property
    def bounds(self) -> NDArray[np.float32]:
        """The bounding box of all primitives: its two corners, shape (2, 3), float32; a copy."""
        return self._compiled.bounds

    @property
    def vertices(self) -> NDArray[np.float32]:
        """The vertices of polygons: shape (V, 3), float32, read-only, without a copy."""
        return self._compiled.vertices

    @property
    def triangles(self) -> NDArray[np.uint32]:
        """The triangles of polygons, as rows of `vertices`: (T, 3), uint32, read-only, without a
        copy."""
        return self._compiled.triangles

    @property
    def triangle_primitives(self) -> NDArray[np.uint32]:
        """The primitive of each triangle: shape (T,), uint32, read-only, without a copy."""
        return self._compiled.triangle_primitives

    @property
    def spheres(self) -> NDArray[np.float32]:
        """Center and radius of each sphere: shape (S, 4), float32, read-only, without a copy.

        All radii are positive, even of spheres made with a negative radius, which rays hit only
        from the inside.
        """
        return self._compiled.spheres

    @property
    def primitive_kinds(self) -> NDArray[np.uint32]:
        """0 sphere, 1 cone, 2 polygon: shape (P,), uint32, read-only, without a copy."""
        return self._compiled.primitive_kinds

    @property
    def source_rows(self) -> NDArray[np.int64] | None:
        """The row of each primitive in the given triangles; None for other scenes."""
        return self._source_rows

    @property
    def cameras(self) -> tuple[Camera, ...]:
        """The cameras; there is at least one, and the first is the default."""
        return tuple(
            Camera(c.eye, c.at, c.up, c.angle, c.aspect, c.width, c.height, c.name)
            for c in self._compiled.cameras
        )

    def camera(self, name: str) -> Camera:
        """Returns the camera of that name.

        Args:
            name: the name of one of `cameras`.

        Raises:
            InputError: there is no such camera; the message lists the names.
        """
        for camera in self.cameras:
            if camera.name == name:
                return camera
        names = ", ".join(camera.name for camera in self.cameras)
        raise InputError(f"there is no camera '{name}' in {self.name}; expected one of {names}")

    def _image(
        self, camera: Camera | str | None, resolution: tuple[int, int] | None, samples: int
    ) -> _beambench.ImageChoice:
        """Returns the requested image; the compiled part rejects invalid images."""
        if isinstance(camera, str):
            camera = self.camera(camera)
        if camera is not None and not isinstance(camera, Camera):
            raise TypeError(f"camera is {camera!r}; expected a Camera, a name, or None")
        size = (0, 0) if resolution is None else resolution
        if (
            not isinstance(size, tuple | list)
            or len(size) != 2
            or not all(isinstance(n, int | np.integer) for n in size)
        ):
            raise TypeError(
                f"resolution is {resolution!r}; expected (width, height), two whole numbers"
            )
        if resolution is not None and not all(1 <= n <= 16384 for n in size):
            raise InputError(
                f"resolution is {tuple(size)}; expected width and height from 1 to 16384"
            )
        chosen = self._compiled.cameras[0] if camera is None else _compiled(camera)
        return _beambench.ImageChoice(
            chosen, int(size[0]), int(size[1]), whole_number("samples", samples)
        )

    def rays(
        self,
        kind: str | bytes | os.PathLike[Any] = "primary",
        *,
        resolution: tuple[int, int] | None = None,
        camera: Camera | str | None = None,
        samples: int = 1,
    ) -> NDArray[np.float32]:
        """Returns rays of a kind, bit for bit those of the program.

        Args:
            kind: one of `ray_kinds`, such as `"primary"`, `"shadow"` or `"diffuse:seed=2"`; or the
                path of a file that ends in `.rays`.
            resolution: width and height of the image whose rays these are, or from whose hits they
                start; None: the camera's own.
            camera: the camera of that image; None: the scene's first.
            samples: rays per pixel: 1, 4, 5, 9, 16, ...

        Returns:
            Shape (N, 8), float32: origin, t_min, direction, t_max. Primary rays go row by row from
            the top left, with the samples of a pixel together.

        Raises:
            InputError: an unknown kind or camera, an invalid image, or a scene
                without such rays (no lights, no mirrors).
        """
        return self._compiled.rays(encoded("kind", kind), self._image(camera, resolution, samples))

    def render(
        self,
        *,
        resolution: tuple[int, int] | None = None,
        camera: Camera | str | None = None,
        samples: int = 1,
        shading: str = "preview",
        structure: Structure | str = "tile-beam",
        threads: int = 0,
    ) -> NDArray[np.float32]:
        """Draws a picture of the scene.

        Args:
            resolution: width and height; None: the camera's own.
            camera: None: the scene's first.
            samples: rays per pixel: 1, 4, 5, 9, 16, ...
            shading: preview, normals, id, depth, or whitted (lights, shadows, mirrors, glass).
            structure: a structure built over this scene, or a name with parameters.
            threads: number of threads; 0: one per core, within the CPU quota.

        Returns:
            Linear light of shape (height, width, 3), float32, the top row first, without a copy.
            `to_srgb` encodes it for displays.

        Raises:
            InputError: an unknown name, or an invalid image.
        """
        from beambench.structure import Structure, require_threads

        count = require_threads(threads)
        image = self._image(camera, resolution, samples)
        built = structure if isinstance(structure, Structure) else Structure(self, structure)
        if built.scene is not self:
            raise InputError("structure was built over another scene; build one over this scene")
        return _beambench.render(built._compiled, image, text("shading", shading), count)

    def __copy__(self) -> Scene:
        """Returns this scene, which never changes."""
        return self

    def __deepcopy__(self, memo: dict[int, object]) -> Scene:
        """Returns this scene, which never changes."""
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        """Returns the whole scene for pickle, not just the name that generates it."""
        compiled = self._compiled
        return _unpickled, (compiled.pickled(), list(compiled.warnings), self._source_rows)

    def __repr__(self) -> str:
        """Returns the name and the size of the scene."""
        return f"<beambench.Scene '{self.name}', {self.primitives} primitives>"

    def _repr_html_(self) -> str:
        words = escape(f"{self.name}, {self.primitives:,} primitives")
        camera = self.cameras[0]
        side = 320 / max(1.0, camera.aspect)
        size = (max(round(side * camera.aspect), 1), max(round(side), 1))
        picture = to_srgb(self.render(resolution=size))
        return f"<figure>{to_img(picture, words)}<figcaption>{words}</figcaption></figure>"


def _unpickled(pickled: bytes, warned: list[str], source_rows: NDArray[np.int64] | None) -> Scene:
    """Restores the scene stored by `Scene.__reduce__`."""
    scene = Scene._of(_beambench.unpickled_scene(pickled, warned))
    scene._source_rows = source_rows
    return scene
