"""Turns the records of a beambench run into plots and pictures.

It knows a run by its files alone (results.csv and its columns), never by the C++ behind them.
"""
