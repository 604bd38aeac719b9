"""Errors in a user's files or arguments."""

from __future__ import annotations


class Problem(Exception):  # noqa: N818 (as in beambench_report)
    """One sentence for the user."""
