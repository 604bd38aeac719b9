"""Escapes text from outside (names, paths, messages of programs) for terminals."""

import re

# Control characters except the line feed, separators, direction marks, and bytes that are not text.
_HIDDEN = re.compile(
    "[\x00-\x09\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ufeff\ud800-\udfff]"
)
_LONGEST = 4000


def printable(text: str) -> str:
    """Escapes characters that a terminal would interpret (`\x1b`), and shortens long texts in the
    middle.
    """
    if len(text) > _LONGEST:
        text = f"{text[: _LONGEST * 5 // 8]} ... {text[-_LONGEST * 3 // 8 :]}"
    return _HIDDEN.sub(lambda hidden: hidden[0].encode("unicode_escape").decode(), text)
