"""Nightly runs: measured, kept, reported; and two programs or files beside each other."""
