"""The ledger: each claim of the thesis's chapter 5 as a rule, and what measurements say of it.

The rules (`rules.py`) were written and committed before any full run of the thesis's tables was
made, so that none could be bent to what came out. Known by then were the thesis's own figures and
the octree counts of the stand-in scenes (results/published/README.md), which C02 and C05 rest on,
and a glance at two scenes at 320x200: the number of beams of maceta (C10) and the cost of
escena1's hierarchy (C21).

Every rule first judges the thesis's own figures (`results/thesis/`), then a run's: the thesis does
not always support itself.
"""
