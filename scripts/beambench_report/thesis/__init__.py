"""Chapter 5 of the thesis, measured again: which sweeps, how they are run, and the report on them.

`catalogue` names the sweeps that serve each table and figure, `plan` and `runner` run them, `facts`
keeps what single commands print beside them, `cells` reads what was measured. `report` gathers all
of it beside what the thesis printed; `markdown` and `page` write the report in its two forms, with
the sentences of `words`.
"""
