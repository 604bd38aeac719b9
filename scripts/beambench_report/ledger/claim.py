"""A claim of the thesis: where it stands, what it says, and the rule that tests it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from beambench_report.ledger.evidence import Evidence
from beambench_report.ledger.verdict import Check

Rule = Callable[[Evidence], list[Check]]


@dataclass(frozen=True)
class Amendment:
    """The rule that a claim had before; its verdict is printed beside that of the present one."""

    former: Rule
    why: str
    """Why the rule was amended, in one sentence."""


@dataclass(frozen=True)
class Claim:
    """One row of the ledger."""

    name: str
    where: str
    says: str
    rule: Rule
    is_figures: bool
    """The claim is a list of figures, which are bound to agree with themselves."""
    amendment: Amendment | None = None


class Claims(list[Claim]):
    """The claims in the order of the thesis; rules enrol themselves."""

    def claim(
        self,
        name: str,
        where: str,
        says: str,
        *,
        is_figures: bool = False,
        amended: Amendment | None = None,
    ) -> Callable[[Rule], Rule]:
        """Decorates the rule of a claim."""

        def enrol(rule: Rule) -> Rule:
            self.append(Claim(name, where, says, rule, is_figures, amended))
            return rule

        return enrol
