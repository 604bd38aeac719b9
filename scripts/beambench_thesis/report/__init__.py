"""The report on chapter 5: which sweeps, how they are run, tables, figures, page."""
