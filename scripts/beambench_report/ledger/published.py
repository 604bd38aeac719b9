"""The thesis's own figures, as results/thesis/ has them."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pandas as pd

from beambench_report.ledger.cluster_evidence import FIGURES, ClusterEvidence
from beambench_report.ledger.evidence import CELLS, OCTREES, TIMES, WORK, Evidence
from beambench_report.problem import Problem

FOLDER = Path(__file__).resolve().parents[3] / "results/thesis"
_OCTREE_STRUCTURES = ("beam", "samet", "samet-net")
# What the thesis calls beams and non-terminal beams are those that its constructor made, and those
# of them that were cut: a beam that lies wholly inside the next leaf is only placed there
# (section 4.4.2, `PasaPor`; graphic 3.4).
_MADE_BY_CUTTING = {"beams": "beams_made", "beams_nonterminal": "beams_divided"}


@cache
def published_evidence(folder: Path = FOLDER) -> Evidence:
    """Tables 5.2 to 5.8 and the figures that stand in the text.

    The thesis gives no intervals: what it prints counts as exact.
    """
    times = _times(_read(folder / "times.csv"))
    text = _read(folder / "figures_in_text.csv")
    parallel = text["section"].astype(str).str.startswith("6")
    return Evidence(
        times[list(TIMES)],
        _work(text[~parallel].copy(), times),
        _octrees(_read(folder / "octree_counts.csv")),
        _cluster(text[parallel]),
    )


@cache
def primitives_by_scene(folder: Path = FOLDER) -> dict[str, int]:
    """Table 5.1: polygons and spheres of each scene."""
    scenes = _read(folder / "scenes.csv")
    return dict(zip(scenes["scene"], scenes["polygons"] + scenes["spheres"], strict=True))


def _read(path: Path) -> pd.DataFrame:
    try:
        return pd.read_csv(path)
    except FileNotFoundError:
        raise Problem(f"{path}: there is no such file; restore it with git") from None


def _times(rows: pd.DataFrame) -> pd.DataFrame:
    """Tables 5.4 to 5.8 do not repeat that a leaf is split as soon as it holds anything."""
    rows["contender"] = rows["algorithm"]
    rows["level"] = rows["max_level"].fillna(0).astype(int)
    rows["objects"] = rows["max_objects"].fillna(0).astype(int)
    rows["cells"] = rows["contender"].eq("voxel-grid") * CELLS
    rows["resolution"] = _resolution(rows)
    rows["samples"] = 1
    rows["low"] = rows["high"] = rows["seconds"]
    return rows


def _work(text: pd.DataFrame, times: pd.DataFrame) -> pd.DataFrame:
    text["contender"] = text["structure"]
    text["level"] = text["max_level"].fillna(0).astype(int)
    text["objects"] = text["cells"] = 0
    text["samples"] = 1
    text["resolution"] = _resolution(text)
    text["low"] = text["high"] = text["value"]
    rows = text[list(WORK)]
    cut = rows[rows["quantity"].isin(_MADE_BY_CUTTING)]
    cut = cut.assign(quantity=cut["quantity"].map(_MADE_BY_CUTTING))
    return pd.concat([rows, cut, _seconds_of_shares(rows, times)], ignore_index=True)


def _seconds_of_shares(work: pd.DataFrame, times: pd.DataFrame) -> pd.DataFrame:
    """A share of a time that is printed is a time: what C09 needs, where the thesis tells it."""
    setting = ["scene", "contender", "level", "objects", "resolution"]
    known = times.drop_duplicates(setting)[[*setting, "seconds"]]
    shares = work[work["quantity"].eq("share_nonterminal")].merge(known, on=setting)
    seconds = shares["value"] * shares["seconds"]
    shares = shares.assign(quantity="seconds_nonterminal", value=seconds, low=seconds, high=seconds)
    return shares[list(WORK)]


def _octrees(rows: pd.DataFrame) -> pd.DataFrame:
    names = {
        "max_level": "level",
        "max_objects": "objects",
        "exit_beam_pixels_1280x1024": "exit_pixels",
    }
    return rows.rename(columns=names)[list(OCTREES)].drop_duplicates()


def _cluster(text: pd.DataFrame) -> ClusterEvidence:
    """The thesis says no more of its network than that it is an Ethernet."""
    rows = text.assign(network="Ethernet", low=text["value"], high=text["value"])
    return ClusterEvidence(rows[list(FIGURES)])


def _resolution(rows: pd.DataFrame) -> pd.Series:
    """`320x200`, or nothing where a figure is of no resolution."""
    width, height = (rows[side].astype("Int64").astype(str) for side in ("width", "height"))
    return (width + "x" + height).where(rows["width"].notna(), "")
