"""Releases: the files of a version, tried in bare systems, and the record of all versions."""
