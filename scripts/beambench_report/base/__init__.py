"""Modules used by every part of the package: records, names, plots, files, the thesis's figures."""
