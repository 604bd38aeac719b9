"""results/published/census: rays of whole pictures by kind, shadows, adaptive depth."""

from pathlib import Path
from typing import Any

from beambench_report.base.files import Problem, read_json

_KINDS = ("eye_hits", "reflected", "refracted", "shadow")
_SHOWN = ("lattice", "rings", "escena1", "finishes", "balls", "maceta", "misil", "habitacion",
          "ajedrez", "gears", "mount")  # fmt: skip


def figures(folder: Path) -> dict[str, Any]:
    """Returns our counts and Haines's, and the effects of shadow cache, light buffers and depth."""
    spd = _scenes(folder / "spd.json")
    published = {name: one["published"] for name, one in spd.items() if one.get("published")}
    return {
        "kinds": _KINDS,
        "published": published,
        "hidden": {name: _hidden(one) for name, one in spd.items()},
        "most": max(
            abs(one[kind]["difference_percent"]) for one in published.values() for kind in _KINDS
        ),
        "others": {name: one for name, one in spd.items() if name not in published},
        "shadows": _shadows(folder),
        "weights": {
            weight: _weights(_scenes(folder / f"least-weight-{weight}.json"))
            for weight in ("0.01", "0.1")
        },
        "pictures": _pictures(_scenes(folder / "pictures-1280x1024.json")),
    }


def _scenes(file: Path) -> dict[str, dict[str, Any]]:
    source = read_json(file)
    if not isinstance(source, dict):
        raise Problem(f"{file}: there is no census; restore it with git")
    return {one["scene"]: one for one in source["scenes"]}


def _hidden(one: dict[str, Any]) -> float:
    return one["shadow_hidden"] / one["shadow_rays"] if one["shadow_rays"] else 0.0


def _shadows(folder: Path) -> dict[str, Any]:
    """Returns shadow rays hidden and found by the cache, and relative times, by scene."""
    plain, cache, buffer = (
        _scenes(folder / f"shadows-{name}.json") for name in ("rays", "cache", "light-buffer")
    )
    found = {}
    for scene, one in plain.items():
        if not one["shadow_hidden"]:
            continue
        own, listed = cache[scene], buffer[scene]
        found[scene] = {
            "hidden": _hidden(one),
            "cached": own["shadow_cached"] / own["shadow_hidden"],
            "cache_time": own["picture_ms"] / one["picture_ms"],
            "tests": listed["shadow_tests"] / max(listed["shadow_listed"], 1),
            "buffer_time": listed["picture_ms"] / one["picture_ms"],
            "with_lists": (listed["picture_ms"] + listed["preparation_ms"]) / one["picture_ms"],
        }
    by_name = {scene.split(":")[0]: scene for scene in found}
    times = sorted((own["cache_time"], scene) for scene, own in found.items())
    return {
        "shown": {name: found[by_name[name]] for name in _SHOWN if name in by_name},
        "scenes": len(plain),
        "cached": (min(cached := [own["cached"] for own in found.values()]), max(cached)),
        "cache_times": (times[0], times[-1]),
    }


def _weights(scenes: dict[str, dict[str, Any]]) -> dict[str, dict[str, float]]:
    return {
        name: {"time": one["picture_ms"] / one["full_picture_ms"], "error": one["error"]}
        for name, one in scenes.items()
    }


def _pictures(scenes: dict[str, dict[str, Any]]) -> dict[str, Any]:
    seconds = [(one["picture_ms"] + one["eye_ms"]) / 1e3 for one in scenes.values()]
    most = max(zip(seconds, scenes, strict=True))
    return {"scenes": len(seconds), "seconds": sum(seconds), "least": min(seconds), "most": most}
