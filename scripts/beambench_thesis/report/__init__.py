"""The report on chapter 5: its sweeps and their runs, tables, figures and pages."""
