"""The cost formulas of section 5.3.3, fitted to what was counted and how long it took.

`formulas` says which counts make up which time, `least_squares` fits, `fitting` adds intervals and
errors, and `section` and `plot` show them.
"""
