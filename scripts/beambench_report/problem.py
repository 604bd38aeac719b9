"""What can go wrong through no fault of the program."""


class Problem(Exception):  # noqa: N818 (a wrong request is no programming error)
    """One sentence for the user: what is wrong with which file, and what to do."""
