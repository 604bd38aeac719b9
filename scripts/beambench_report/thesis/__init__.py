"""Chapter 5 of the thesis, measured again: which sweeps, how they are run, and the report on them.

`catalogue` says which sweeps serve which table and figure, `plan` and `runner` make them, `cells`
reads what they measured, and `report` puts it beside what the thesis printed.
"""
