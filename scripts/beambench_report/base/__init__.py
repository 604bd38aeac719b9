"""Modules used by every part of the package: records, names, figures, files, published figures."""
