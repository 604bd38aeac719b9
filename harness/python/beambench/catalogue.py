"""Lists structures, scenes and kinds of rays by name."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from beambench import _beambench


@dataclass(frozen=True)
class Parameter:
    """A parameter of a structure, a scene or a kind of rays."""

    name: str
    """The name by which it is specified."""
    type: str
    """integer, integer or auto, real, flag, choice, or cells (`32`, `64x32x16`, `auto`)."""
    default: str
    """The default, as text."""
    minimum: float | None
    """The minimum of a number, inclusive; None for flags and choices."""
    maximum: float | None
    """The maximum of a number, inclusive; None for flags and choices."""
    choices: tuple[str, ...]
    """The values of a choice."""
    description: str
    """One sentence, including units."""


@dataclass(frozen=True)
class StructureInfo:
    """A structure by name."""

    name: str
    """The name by which `Structure` builds it."""
    summary: str
    """One sentence, with the source in the literature."""
    parameters: tuple[Parameter, ...]
    """The parameters, in the order of its label."""
    conformance: str
    """bit-exact: same hits as `exhaustive`; tolerance: its own arithmetic; baseline: no hits."""
    counters: dict[str, str]
    """The counters and their meanings."""


@dataclass(frozen=True)
class SceneInfo:
    """A generated scene by name."""

    name: str
    """The name by which `Scene` makes it."""
    summary: str
    """One sentence."""
    parameters: tuple[Parameter, ...]
    """The parameters, in the order of its label."""


@dataclass(frozen=True)
class RayKindInfo:
    """A kind of rays by name."""

    name: str
    """The name by which `Scene.rays` makes them."""
    summary: str
    """The origin of the rays."""
    parameters: tuple[Parameter, ...]
    """The parameters, such as the seed of random rays."""
    query: str
    """The query: closest, any, or picture (both)."""


def _parameters(entry: dict[str, Any]) -> tuple[Parameter, ...]:
    return tuple(Parameter(**parameter) for parameter in entry["parameters"])


def structures() -> list[StructureInfo]:
    """Returns all structures, with their parameters and counters."""
    return [
        StructureInfo(**{**entry, "parameters": _parameters(entry)})
        for entry in _beambench.structures()
    ]


def scenes() -> list[SceneInfo]:
    """Returns all scenes of the catalogue, sorted by name."""
    return [
        SceneInfo(**{**entry, "parameters": _parameters(entry)}) for entry in _beambench.scenes()
    ]


def ray_kinds() -> list[RayKindInfo]:
    """Returns the kinds of rays that `Scene.rays` generates; `whitted` is only for sweeps."""
    return [
        RayKindInfo(**{**entry, "parameters": _parameters(entry)})
        for entry in _beambench.ray_kinds()
    ]
