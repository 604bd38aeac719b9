"""Figures in the texts of results/published: a module for each folder computes them from rows."""
