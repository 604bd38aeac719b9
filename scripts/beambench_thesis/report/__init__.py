"""The report on chapter 5: its sweeps, how they are run, tables, figures, page."""
