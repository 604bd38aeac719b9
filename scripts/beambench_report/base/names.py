"""Names of the contenders and the views of a run in plots and files."""

import os
import re
from collections.abc import Iterable
from itertools import count

import pandas as pd

from beambench.analysis import name_cells, without_order

# Lists the plots of a run for programs, as plots/README.md does for people.
PLOT_INDEX = "index.json"
# Flags that change the hits: watertight edges, and omitted backs of closed solids.
_CHANGE_HITS = ("robust", "backface_culling")
_NAMED = ("scene", "camera", "structure", "parameters", "samples", "ray_kind")


def with_names(rows: pd.DataFrame) -> pd.DataFrame:
    """Returns the rows with the names of their cells in plots and pages.

    `contender`: the structure, with the parameters that differ between its rows. `subject`: the
    scene, with camera, samples and kind of rays if these vary. `view`: the subject on one machine;
    contenders are compared within a view. `kind`: the kind of rays, whatever their order.
    `is_tuned`: whether the row is the best of several parameter sets.
    """
    facts = rows[list(_NAMED)].assign(
        samples=rows["samples"].fillna(0).astype(int),
        machine_id=rows.get("machine_id", ""),
        parameter_sets=rows.get("parameter_sets", 1),
    )
    facts["parameter_sets"] = facts["parameter_sets"].fillna(1).astype(int)
    # Lists, because iterating over a column takes three calls for each of its fields.
    names = name_cells(list(zip(*(facts[name].tolist() for name in facts), strict=True)))
    found = pd.DataFrame(names, columns=["contender", "subject", "view"], index=rows.index)
    found["is_tuned"] = facts["parameter_sets"] > 1
    found["kind"] = rows["ray_kind"].map(without_order)
    return pd.concat([rows, found], axis="columns").copy()  # defragments it


def machine_label(machine_id: str) -> str:
    """Returns the name of a machine in titles and captions."""
    return f"machine {machine_id[:8]}"


def path_of_name(name: str) -> str:
    """Returns the path for a file name in a record.

    `name_of_path` (scenes/base/printable.hpp) makes such names: a code such as `\x1b` stands for a
    byte, two backslashes stand for one.
    """
    pieces = re.split(rb"\\(\\|x[0-9a-f]{2})", name.encode())
    for i in range(1, len(pieces), 2):
        pieces[i] = bytes.fromhex(pieces[i][1:].decode()) if len(pieces[i]) > 1 else pieces[i]
    return os.fsdecode(b"".join(pieces))


def file_stems(titles: Iterable[str]) -> dict[str, str]:
    """Returns a file name for each title: lower case, digits and dashes, all different."""
    stems: dict[str, str] = {}
    for title in titles:
        plain = re.sub(r"[^a-z0-9]+", "-", title.lower()).strip("-") or "scene"
        free = (f"{plain}-{number}" if number > 1 else plain for number in count(1))
        stems[title] = next(stem for stem in free if stem not in stems.values())
    return stems


def parameter_items(text: str) -> dict[str, str]:
    """Parses the parameters of a row: `name=value`, separated by commas."""
    return dict(item.split("=", 1) for item in text.split(",") if "=" in item)


def brief_name(contender: str) -> str:
    """Returns a contender's name for crowded plots, mostly values: `sah-bvh lbvh reinsertion`.

    Flags that are not set are left out, except flags that change which hits are found. A number
    keeps the name of its parameter.
    """
    structure, *items = contender.split(" ")
    words = [structure]
    for item in items:
        name, _, value = item.partition("=")
        if value == "true":
            words.append(name)
        elif name in _CHANGE_HITS:
            words.append(item)
        elif value != "false":
            words.append(value if value[:1].isalpha() else item)
    return " ".join(words)


def varying_parameters(texts: Iterable[str]) -> set[str]:
    """Returns the names of the parameters that differ between rows of one structure."""
    items = [parameter_items(text) for text in texts]
    return {name for one in items for name in one if len({own.get(name, "") for own in items}) > 1}
