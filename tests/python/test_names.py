"""Names of files, colors of structures."""

from __future__ import annotations

import pandas as pd

from beambench_report.base.figure import looks, structure_color
from beambench_report.base.names import file_stems


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
