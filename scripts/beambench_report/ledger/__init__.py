"""The ledger: each claim of the thesis as a rule, and what measurements say of it.

Every rule judges two sets of figures: the thesis's own (`results/thesis/`), which does not always
support itself, and a run's. A rule is committed before the run that it judges. Where a rule was
amended later, the claim keeps the former rule with the reason (`claim.Amendment`), and the ledger
prints its verdict beside that of the present one.

`rules` has chapter 5, `cluster_rules` chapter 6, `further_rules` what the text says beside its
tables and figures.
"""
