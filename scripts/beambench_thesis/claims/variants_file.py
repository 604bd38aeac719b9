"""The verdicts over perturbed scenes and deeper octrees, in a small table beside the report.

The table replaces the runs that it was made from if these are not kept, as in results/published.
"""

import csv
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from beambench_report.base.files import Problem, write_whole
from beambench_thesis.claims.register import Finding, JudgedClaim
from beambench_thesis.claims.verdict import Verdict

NAME = "variants.csv"
_DEEPER = "deeper"


def write_variants(claims: Sequence[JudgedClaim], path: Path) -> Path:
    """Writes a row for each claim and variant, and for the other reading of the levels."""
    rows = [
        (one.claim.name, number, found.verdict.value)
        for one in claims
        for number, found in enumerate(one.variants, 1)
    ]
    rows += [(one.claim.name, _DEEPER, one.deeper.verdict.value) for one in claims if one.deeper]

    def write(pending: Path) -> None:
        with pending.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(["claim", "variant", "verdict"])
            writer.writerows(rows)

    return write_whole(path, write)


def with_variants(claims: Sequence[JudgedClaim], path: Path) -> list[JudgedClaim]:
    """Returns the claims with the verdicts of such a table, if there is one.

    Raises Problem if a verdict is unknown.
    """
    if not path.is_file():
        return list(claims)
    variants: dict[str, list[Finding]] = {}
    deeper: dict[str, Finding] = {}
    with path.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            try:
                claim, variant, found = row["claim"], row["variant"], Verdict(row["verdict"])
            except (KeyError, ValueError) as error:
                raise Problem(f"{path}: {error}; write it again from its runs") from error
            if variant == _DEEPER:
                deeper[claim] = Finding(found, [])
            else:
                variants.setdefault(claim, []).append(Finding(found, []))
    return [
        replace(
            one,
            variants=tuple(variants.get(one.claim.name, ())),
            deeper=deeper.get(one.claim.name),
        )
        for one in claims
    ]
