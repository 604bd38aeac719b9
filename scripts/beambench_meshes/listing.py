"""The table of meshes that scripts/meshes can register."""

from __future__ import annotations

from beambench_meshes.downloads import DOWNLOADS
from beambench_meshes.recipes import RECIPES


def rows() -> list[tuple[str, str, str, str, str]]:
    """Returns the name, triangles, description, package and license of each recipe."""
    return [
        (r.name, f"{r.triangles:,}", r.what, r.package.name, r.package.license) for r in RECIPES
    ]


def licenses() -> list[tuple[str, str, str, str]]:
    """Returns the package, megabytes, license and authors, once for each package."""
    packages = {recipe.package: None for recipe in RECIPES}
    return [(p.name, str(p.megabytes), p.license, p.authors) for p in packages]


def listing() -> str:
    """Returns the text of `--list`."""
    lines = _aligned(
        [("mesh", "triangles", "package", "MB"), *_short()], right=(False, True, False, True)
    )
    lines += [
        "",
        *_aligned(
            [
                ("package", "license", "authors"),
                *((name, terms, by) for name, _, terms, by in licenses()),
            ]
        ),
    ]
    lines += ["", "To be downloaded, and registered with --from:"]
    for download in DOWNLOADS:
        counts = " or ".join(f"{version.triangles:,}" for version in download.versions)
        lines += [
            f"  {download.name}: {counts} triangles, in {' or '.join(download.files)}",
            f"    from {download.where}",
            f"    {download.license}",
        ]
    return "\n".join(lines)


def _short() -> list[tuple[str, str, str, str]]:
    return [(r.name, f"{r.triangles:,}", r.package.name, str(r.package.megabytes)) for r in RECIPES]


def _aligned(table: list[tuple[str, ...]], right: tuple[bool, ...] = ()) -> list[str]:
    widths = [max(len(cell) for cell in column) for column in zip(*table, strict=True)]
    sides = right or (False,) * len(widths)
    return [
        "  ".join(
            cell.rjust(width) if is_right else cell.ljust(width)
            for cell, width, is_right in zip(row, widths, sides, strict=True)
        ).rstrip()
        for row in table
    ]
