"""Plots and pictures of a beambench run.

They are made from its files alone (results.csv and its columns), independently of the C++ code.
"""
