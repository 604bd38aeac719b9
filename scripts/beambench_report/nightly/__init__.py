"""Nightly runs: their history, what got slower or wrong, and the page that shows it."""
