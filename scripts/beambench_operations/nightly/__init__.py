"""Nightly runs: measuring, storing and reporting them; comparing two programs or files."""
