"""Verifying the hits of any program against the exact oracle."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beambench import _beambench
from beambench._beambench import NO_PRIMITIVE, InputError
from beambench.arrays import flags, ids, rays_in_place, reals
from beambench.scene import Scene
from beambench.structure import Hits

Vector = tuple[float, float, float]

CLASSES: tuple[str, ...] = tuple(_beambench.class_names())
"""agree, tie, graze, structure_error (wrong claim) and oracle_error (wrong oracle)."""


# A reason stated by the differ (verify_ray.cpp).
_OTHER_PRIMITIVE = "t is right, but another primitive is hit there"


def _number(value: float) -> str:
    """Returns the fewest digits that distinguish neighboring numbers of the type."""
    return str(value)


def _vector(numbers: NDArray[np.float32]) -> str:
    return f"({', '.join(map(_number, numbers))})"


def _hit(t: float | None, primitive: int | None) -> str:
    if t is None:
        return "no hit"
    return f"primitive {primitive} at t = {_number(t)}"


@dataclass(frozen=True, eq=False)
class Example:
    """A ray whose claimed hit does not agree with the oracle's."""

    index: int
    """The index of the ray."""
    ray: NDArray[np.float32]
    """Shape (8,): origin, t_min, direction, t_max."""
    class_name: str
    """One of CLASSES."""
    reason: str
    """The reason for the class; empty if the class is self-explanatory."""
    claimed_t: float | None
    """The claimed t; None: not given, or no hit."""
    claimed_point: Vector | None
    """The claimed point; None: not given, or no hit."""
    claimed_primitive: int | None
    """The claimed primitive; None: not given, or no hit."""
    claimed_triangle: int | None
    """The claimed triangle; None: not given, or no hit."""
    claimed_occluded: bool | None
    """The claimed occlusion; None: the claims are of closest hits."""
    oracle_t: float | None
    """The t of the closest hit by double-precision intersectors; None: no hit."""
    oracle_primitive: int | None
    """The primitive of the oracle's hit."""
    exact_t: float | None
    """The t of the closest hit by exact arithmetic; None: no hit, or not searched."""
    exact_primitive: int | None
    """The primitive of the exact hit."""
    searched: bool
    """Whether exact arithmetic judged the claim, because it differs from the oracle's hit."""

    @property
    def claim(self) -> str:
        """The claim in words."""
        if self.claimed_occluded is not None:
            return "some hit" if self.claimed_occluded else "no hit"
        if self.claimed_t is None and self.claimed_point is None:
            return "no hit"
        place = (
            f"t = {_number(self.claimed_t)}"
            if self.claimed_t is not None
            else f"point {self.claimed_point}"
        )
        if self.claimed_primitive is not None:
            return f"primitive {self.claimed_primitive} at {place}"
        if self.claimed_triangle is not None:
            return f"triangle {self.claimed_triangle} at {place}"
        return place

    def __str__(self) -> str:
        """Returns several lines: the ray, the claim, the oracle's hit and the exact hit."""
        exact = _hit(self.exact_t, self.exact_primitive) if self.searched else "not searched"
        reason = f", {self.reason}" if self.reason else ""
        return (
            f"ray {self.index}: {self.class_name}{reason}\n"
            f"  ray      from {_vector(self.ray[0:3])} along {_vector(self.ray[4:7])}, "
            f"t in [{_number(self.ray[3])}, {_number(self.ray[7])}]\n"
            f"  claimed  {self.claim}\n"
            f"  oracle   {_hit(self.oracle_t, self.oracle_primitive)}\n"
            f"  exact    {exact}"
        )


@dataclass(frozen=True, eq=False, repr=False)
class Report:
    """The findings of a verification."""

    verdict: str
    """ok; mismatch: any structure_error; grazes: more than max(2, 1e-4 x rays) grazes."""
    rays: int
    """The number of rays verified."""
    hits: int
    """The number of rays that hit anything, by the oracle."""
    counts: dict[str, int]
    """The number of rays in each class."""
    classes: NDArray[np.uint8]
    """The class of each ray, an index in CLASSES: uint8, shape (N,) or the shape of the Hits."""
    examples: list[Example]
    """Errors first; at most ten of each class except agree."""

    @property
    def ok(self) -> bool:
        """Whether the verdict is ok."""
        return self.verdict == "ok"

    @property
    def hint(self) -> str:
        """The probable cause of wrong ids at the right t; empty if there are none."""
        wrong = [example for example in self.examples if example.reason == _OTHER_PRIMITIVE]
        if not wrong:
            return ""
        if wrong[0].claimed_triangle is not None:
            return "hint: t is right and triangle is not; expected rows of scene.triangles"
        return (
            "hint: t is right and primitive is not; expected ids of primitives: the rows given to "
            "Scene.from_triangles or from_spheres (with degenerate='skip', scene.source_rows maps "
            "ids to rows), or places in the scene's file, where a polygon of several triangles is "
            "one primitive. For ids of triangles, give triangle=ids, or map them: "
            "primitive=scene.triangle_primitives[ids]"
        )

    def __str__(self) -> str:
        """Returns the verdict, the counts, and the first examples."""
        counts = ", ".join(f"{name} {n}" for name, n in self.counts.items() if n > 0)
        lines = [f"{self.verdict}: {self.rays} rays, {self.hits} of them hit; {counts}"]
        shown = self.examples[:3]
        lines += [str(example) for example in shown]
        left = self.rays - self.counts["agree"] - len(shown)
        if left > 0:
            lines.append(f"{left} more that do not agree: see classes and examples")
        if self.hint:
            lines.append(self.hint)
        if self.counts["oracle_error"] > 0:
            lines.append(
                "oracle_error: by exact arithmetic, the claim is right and the oracle is "
                "wrong; such rays count as right"
            )
        return "\n".join(lines)

    def __repr__(self) -> str:
        """Returns the verdict and the counts."""
        return f"<beambench.Report {str(self).splitlines()[0]}>"

    def _repr_html_(self) -> str:
        color = "#1a7f37" if self.ok else "#b42318"
        most = max(self.counts.values())
        rows = "".join(
            f"<tr><th>{name.replace('_', ' ')}</th><td>{count:,}</td>"
            f'<td><div style="width:{160 * count / most:.0f}px;height:0.8em;background:#8aa"></div>'
            "</td></tr>"
            for name, count in self.counts.items()
            if count > 0
        )
        examples = "".join(f"<pre>{escape(str(one))}</pre>" for one in self.examples[:5])
        return (
            f'<p><b style="color:{color}">{escape(self.verdict)}</b>: {self.rays:,} rays, '
            f"{self.hits:,} of them hit</p><table>{rows}</table>{examples}"
        )


@dataclass(frozen=True, eq=False)
class _Claims:
    """The given arrays, converted; None for arrays that were not given."""

    t: NDArray[np.float32] | None
    point: NDArray[np.float32] | None
    primitive: NDArray[np.uint32] | None
    triangle: NDArray[np.uint32] | None
    occluded: NDArray[np.uint8] | None

    def given(self) -> dict[str, NDArray[Any]]:
        return {name: array for name, array in vars(self).items() if array is not None}

    def example(self, entry: dict[str, Any], rays: NDArray[np.float32]) -> Example:
        """Returns an example, with the claim taken from the given arrays."""
        i = entry["index"]
        named = [array[i] for array in (self.primitive, self.triangle) if array is not None]
        missed = any(id_ == NO_PRIMITIVE for id_ in named)
        t = None if self.t is None or missed or np.isinf(self.t[i]) else self.t[i]
        point = None
        if self.point is not None and not missed and not np.isinf(self.point[i]).any():
            x, y, z = self.point[i].tolist()
            point = (x, y, z)
        missed |= t is None and point is None
        oracle = entry["oracle"] or (None, None)
        exact = entry["exact"] or (None, None)
        return Example(
            index=i,
            ray=rays[i].copy(),
            class_name=CLASSES[entry["class"]],
            reason=entry["reason"],
            claimed_t=t,
            claimed_point=point,
            claimed_primitive=None if self.primitive is None or missed else int(self.primitive[i]),
            claimed_triangle=None if self.triangle is None or missed else int(self.triangle[i]),
            claimed_occluded=None if self.occluded is None else bool(self.occluded[i]),
            oracle_t=oracle[0],
            oracle_primitive=oracle[1],
            exact_t=exact[0],
            exact_primitive=exact[1],
            searched=entry["searched"],
        )


def _require_form(given: dict[str, ArrayLike | None]) -> None:
    """Raises TypeError unless the arrays form one kind of claim."""
    names = " and ".join(name for name, array in given.items() if array is not None)
    wanted = (
        "pass t or point, with or without primitive or triangle, for closest hits; or only "
        "occluded for any-hit queries"
    )
    if not names:
        raise TypeError(f"no hits are given; {wanted}")
    one_place = (given["t"] is None) != (given["point"] is None)
    one_id = given["primitive"] is None or given["triangle"] is None
    if names != "occluded" and not (one_place and one_id and given["occluded"] is None):
        raise TypeError(
            f"{names} cannot be combined; {wanted}"
            if " " in names
            else f"{names} alone does not state a hit; {wanted}"
        )


def _require_hits_alone(hits: object, given: dict[str, ArrayLike | None]) -> None:
    """Raises TypeError unless these are Hits, given without other arrays."""
    if not isinstance(hits, Hits):
        raise TypeError(
            f"hits is a {type(hits).__name__}; expected a beambench.Hits, or arrays by name: t=..."
        )
    names = " and ".join(name for name, array in given.items() if array is not None)
    if names:
        raise TypeError(f"hits cannot be combined with {names}; pass one or the other")


def verify(
    scene: Scene,
    rays: ArrayLike,
    hits: Hits | None = None,
    *,
    t: ArrayLike | None = None,
    point: ArrayLike | None = None,
    primitive: ArrayLike | None = None,
    triangle: ArrayLike | None = None,
    occluded: ArrayLike | None = None,
) -> Report:
    """Verifies the hits that any program reports for a list of rays.

    The claims are closest hits (`hits`, a whole result of `closest_hits` or `trace_image`; or `t`
    or `point`, optionally with `primitive` or `triangle`) or any-hit results (only `occluded`). A
    claim is compared with the hit of an oracle in double precision, with tolerances for rounding to
    float32; disputes are decided by exact arithmetic. A miss at the edge between two triangles
    counts as a graze; the conformance kit (`beambench verify --kit`) verifies whether rays leak out
    of closed meshes at edges.

    Args:
        scene: the scene against which the rays were traced.
        rays: shape (N, 8), float32: origin, t_min, direction, t_max; used in place, or converted
            first.
        hits: the result of a structure, with N hits in any shape. The hits of an image, from
            `Structure.trace_image`, are in the order of `Scene.rays("primary", ...)`.
        t: shape (N,), real numbers, rounded to float32: the hit is at origin + t * direction;
            infinity for a miss.
        point: shape (N, 3), real numbers, rounded to float32: the point that is hit; three
            infinities: a miss.
        primitive: shape (N,), integers: the id in the scene. If polygons have several triangles,
            this is not the triangle's row (`Scene.triangle_primitives` maps rows to ids); -1 or
            NO_PRIMITIVE: a miss.
        triangle: shape (N,), integers: the row of `Scene.triangles`; -1 or NO_PRIMITIVE: a miss.
        occluded: shape (N,), bool, or integers 0 and 1: whether the ray hits anything.

    Returns:
        The verdict, the number of rays in each class, the class of each ray, and examples.

    Raises:
        InputError: another shape, no rays, or a ray or hit with impossible numbers, such as NaN or
            an id that is not in the scene; the message states the index of the ray.
        TypeError: another dtype, or arrays that cannot be combined.
    """
    if not isinstance(scene, Scene):
        raise TypeError(f"scene is a {type(scene).__name__}; expected a beambench.Scene")
    given: dict[str, ArrayLike | None] = {
        "t": t,
        "point": point,
        "primitive": primitive,
        "triangle": triangle,
        "occluded": occluded,
    }
    if hits is not None:
        _require_hits_alone(hits, given)
        t, primitive = hits.t.reshape(-1), hits.primitive.reshape(-1)
    else:
        _require_form(given)
    lines = rays_in_place(rays)
    claims = _Claims(
        None if t is None else reals("t", t, ("N",), np.float32),
        None if point is None else reals("point", point, ("N", 3), np.float32),
        None if primitive is None else ids("primitive", primitive, ("N",)),
        None if triangle is None else ids("triangle", triangle, ("N",)),
        None if occluded is None else flags("occluded", occluded, ("N",)),
    )
    for name, array in claims.given().items():
        if len(array) != len(lines):
            raise InputError(
                f"{name} has {len(array)} rows, but there are {len(lines)} rays; expected one each"
            )
    if len(lines) == 0:
        raise InputError("there are no rays; a verdict without rays would be meaningless")
    none = np.empty(0)
    found, classes = _beambench.verify(
        scene._compiled,
        lines,
        none.astype(np.float32) if claims.t is None else claims.t,
        np.empty((0, 3), np.float32) if claims.point is None else claims.point,
        none.astype(np.uint32) if claims.primitive is None else claims.primitive,
        none.astype(np.uint32) if claims.triangle is None else claims.triangle,
        none.astype(np.uint8) if claims.occluded is None else claims.occluded,
    )
    return Report(
        verdict=found["verdict"],
        rays=found["rays"],
        hits=found["hits"],
        counts=dict(zip(CLASSES, found["counts"], strict=True)),
        classes=classes if hits is None else classes.reshape(hits.t.shape),
        examples=[claims.example(entry, lines) for entry in found["examples"]],
    )
