"""Nightly runs: measured, kept, reported; comparisons of two programs or files."""
