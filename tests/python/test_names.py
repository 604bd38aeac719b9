"""Names of files, colors of structures."""

from __future__ import annotations

import pandas as pd
import pytest

from beambench_report.base.figure import looks, structure_color
from beambench_report.base.names import file_stems, with_names, without_order


def test_file_stems_are_plain_and_never_collide() -> None:
    stems = file_stems(["tetra:n=6", "tetra n 6", "Über/x.nff", "...", "escena1"])
    assert list(stems.values()) == ["tetra-n-6", "tetra-n-6-2", "ber-x-nff", "scene", "escena1"]


def test_variants_share_the_color_of_their_structure_and_differ_otherwise() -> None:
    rows = pd.DataFrame(
        [
            ("samet", "max_level=5", "samet max_level=5"),
            ("samet", "max_level=6", "samet max_level=6"),
            ("embree", "", "embree"),
        ],
        columns=["structure", "parameters", "contender"],
    )
    found = looks(rows)
    five, six = found["samet max_level=5"], found["samet max_level=6"]
    assert five.color == six.color == structure_color("samet") != found["embree"].color
    assert (five.marker, five.dashes) != (six.marker, six.dashes)


def test_an_unknown_structure_has_a_lasting_color() -> None:
    assert structure_color("newcomer") == structure_color("newcomer")


@pytest.mark.parametrize(
    ("label", "kind"),
    [
        ("primary", "primary"),
        ("shadow:order=sorted", "shadow"),
        ("diffuse:order=sorted,seed=7", "diffuse:seed=7"),
        ("ao:samples=4,order=sorted", "ao:samples=4"),
        ("path:bounces=3", "path:bounces=3"),
        ("a:order=sorted,b.rays", "a:order=sorted,b.rays"),
    ],
)
def test_the_label_of_rays_without_their_order(label: str, kind: str) -> None:
    assert without_order(label) == kind


def test_both_orders_of_a_list_are_one_view() -> None:
    """The module divides labels as `without_order` does."""
    kinds = ["diffuse:seed=7", "diffuse:order=sorted,seed=7"]
    facts = {"scene": "s", "camera": "c", "structure": "embree", "parameters": "", "samples": 1}
    rows = with_names(pd.DataFrame([facts | {"ray_kind": kind} for kind in kinds]))
    assert rows["view"].nunique() == rows["kind"].nunique() == 1
    assert list(rows["contender"]) == ["embree", "embree, sorted rays"]
