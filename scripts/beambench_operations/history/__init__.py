"""The history of runs on one machine, and what got slower or wrong in it."""
