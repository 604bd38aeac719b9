"""Draws the plots, pictures and page of a beambench run.

They are made from the run's files. Names, ratios and conclusions come from harness/analysis.
"""
