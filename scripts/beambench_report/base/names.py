"""What plots and files call the contenders and the views of a run."""

import os
import re
from collections.abc import Iterable

import pandas as pd

# Lists the plots of a run for programs, as plots/README.md does for people.
PLOT_INDEX = "index.json"


def contender_labels(rows: pd.DataFrame) -> pd.Series:
    """Structure names, with those parameters that differ between rows of one structure.

    `samet` when the run has it once; `samet max_level=6` when it sweeps the level.
    """
    keys = list(zip(rows["structure"], rows["parameters"], strict=True))
    items = {key: parameter_items(key[1]) for key in dict.fromkeys(keys)}
    varying = {
        structure: varying_parameters(text for name, text in items if name == structure)
        for structure in dict.fromkeys(key[0] for key in items)
    }
    labels = {
        key: " ".join([key[0], *(f"{n}={v}" for n, v in own.items() if n in varying[key[0]])])
        for key, own in items.items()
    }
    return pd.Series([labels[key] for key in keys], index=rows.index)


def view_titles(rows: pd.DataFrame) -> pd.Series:
    """`subjects`, and the machine where a run has several: only its own times are compared."""
    if rows["machine_id"].nunique() < 2:
        return subjects(rows)
    return subjects(rows) + ", " + rows["machine_id"].map(machine_label)


def machine_label(machine_id: str) -> str:
    """What titles and captions call a machine."""
    return f"machine {machine_id[:8]}"


def subjects(rows: pd.DataFrame) -> pd.Series:
    """What the rays see: the scene, and camera, samples and ray kind where a run has several."""
    titles = rows["scene"].copy()
    if (rows.groupby("scene")["camera"].nunique() > 1).any():
        titles += ", camera " + rows["camera"]
    if rows["samples"].nunique() > 1:
        titles += ", " + rows["samples"].map("{:.0f} samples".format)
    if rows["ray_kind"].nunique() > 1:
        titles += ", " + rows["ray_kind"] + " rays"
    return titles


def path_of_name(name: str) -> str:
    """The path of the file that records name so: `\\x1b` is a byte, two backslashes are one.

    Names of files are made by `name_of_path` (scenes/base/printable.hpp).
    """
    pieces = re.split(rb"\\(\\|x[0-9a-f]{2})", name.encode())
    for i in range(1, len(pieces), 2):
        pieces[i] = bytes.fromhex(pieces[i][1:].decode()) if len(pieces[i]) > 1 else pieces[i]
    return os.fsdecode(b"".join(pieces))


def file_stems(titles: Iterable[str]) -> dict[str, str]:
    """A file name for each title: lower case, digits and dashes, no two the same."""
    stems: dict[str, str] = {}
    for title in titles:
        stem = plain = re.sub(r"[^a-z0-9]+", "-", title.lower()).strip("-") or "scene"
        number = 2
        while stem in stems.values():
            stem = f"{plain}-{number}"
            number += 1
        stems[title] = stem
    return stems


def parameter_items(text: str) -> dict[str, str]:
    """The parameters of a row, `name=value` separated by commas."""
    return dict(item.split("=", 1) for item in text.split(",") if "=" in item)


def varying_parameters(texts: Iterable[str]) -> set[str]:
    """The names of those parameters that differ between rows of one structure."""
    values: dict[str, set[str]] = {}
    items = [parameter_items(text) for text in texts]
    for name in {name for one in items for name in one}:
        values[name] = {one.get(name, "") for one in items}
    return {name for name, seen in values.items() if len(seen) > 1}
