"""The thesis measured again: paper, chapter5, chapter6, claims and report, in this order."""
