"""What there is by name: structures, scenes and kinds of rays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from beambench import _beambench


@dataclass(frozen=True)
class Parameter:
    """A parameter of a structure, a scene or a kind of rays."""

    name: str
    """By which it is given."""
    type: str
    """integer, integer or auto, real, flag, choice, or cells (`32`, `64x32x16`, `auto`)."""
    default: str
    """As text."""
    minimum: float | None
    """Of a number, inclusive; None for flags and choices."""
    maximum: float | None
    """Of a number, inclusive; None for flags and choices."""
    choices: tuple[str, ...]
    """Of a choice."""
    description: str
    """One sentence, units included."""


@dataclass(frozen=True)
class StructureInfo:
    """A structure by name."""

    name: str
    """By which `Structure` builds it."""
    summary: str
    """One sentence with the source in the literature."""
    parameters: tuple[Parameter, ...]
    """In the order of its label."""
    conformance: str
    """bit-exact: the hits of `exhaustive`; tolerance: arithmetic of its own; baseline: no hits."""
    counters: dict[str, str]
    """What it counts, and what that means."""


@dataclass(frozen=True)
class SceneInfo:
    """A generated scene by name."""

    name: str
    """By which `Scene` makes it."""
    summary: str
    """One sentence."""
    parameters: tuple[Parameter, ...]
    """In the order of its label."""


@dataclass(frozen=True)
class RayKindInfo:
    """A kind of rays by name."""

    name: str
    """By which `Scene.rays` makes them."""
    summary: str
    """Where the rays come from."""
    parameters: tuple[Parameter, ...]
    """Such as the seed of random rays."""
    query: str
    """What is to be found: closest, any, or picture (both)."""


def _parameters(entry: dict[str, Any]) -> tuple[Parameter, ...]:
    return tuple(Parameter(**parameter) for parameter in entry["parameters"])


def structures() -> list[StructureInfo]:
    """All structures, with their parameters and counters."""
    return [
        StructureInfo(**{**entry, "parameters": _parameters(entry)})
        for entry in _beambench.structures()
    ]


def scenes() -> list[SceneInfo]:
    """All scenes of the catalogue, sorted by name."""
    return [
        SceneInfo(**{**entry, "parameters": _parameters(entry)}) for entry in _beambench.scenes()
    ]


def ray_kinds() -> list[RayKindInfo]:
    """All kinds of rays that `Scene.rays` makes; `whitted`, whole pictures, is for sweeps only."""
    return [
        RayKindInfo(**{**entry, "parameters": _parameters(entry)})
        for entry in _beambench.ray_kinds()
    ]
