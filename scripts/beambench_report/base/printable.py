"""Text from outside (names, paths, messages of programs) as terminals show it."""

import re

# Control characters but the line feed, separators, marks of direction, and bytes that are no text.
_HIDDEN = re.compile(
    "[\x00-\x09\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ufeff\ud800-\udfff]"
)
_LONGEST = 4000


def printable(text: str) -> str:
    """Escapes what a terminal would act upon (`\\x1b`); the middle of a long text is left out."""
    if len(text) > _LONGEST:
        text = f"{text[: _LONGEST * 5 // 8]} ... {text[-_LONGEST * 3 // 8 :]}"
    return _HIDDEN.sub(lambda hidden: hidden[0].encode("unicode_escape").decode(), text)
