"""Line breaks and images in Markdown: since the lengths of figures vary, lines are refilled."""

import re
import textwrap
from pathlib import Path

_WIDTH = 120
_OTHER = re.compile(r"^(?:$|#|\||!\[|<!--)")
_FENCE = "```"
_ITEM = re.compile(r"^\s*- ")
_IMAGE = re.compile(r"\]\(([^)\s:]+)\.png\)")


def laid_out(text: str) -> str:
    """Fills paragraphs and list items to lines of at most 120 columns.

    Headings, tables, images, comments and fenced code stay as they are.
    """
    lines: list[str] = []
    block: list[str] = []
    in_code = False
    for line in text.split("\n"):
        is_fence = line.startswith(_FENCE)
        if in_code or is_fence or _OTHER.match(line.strip()):
            lines += [*_filled(block), line.rstrip()]
            block = []
            in_code = in_code != is_fence
        elif _ITEM.match(line):
            lines += _filled(block)
            block = [line]
        else:
            block.append(line)
    return "\n".join([*lines, *_filled(block)])


def _filled(block: list[str]) -> list[str]:
    """Fills a paragraph or an item; the lines of an item after the first are indented."""
    if not block:
        return []
    first = block[0]
    margin = first[: len(first) - len(first.lstrip())]
    indent = f"{margin}  " if _ITEM.match(first) else margin
    words = " ".join(line.strip() for line in block)
    return textwrap.wrap(
        words,
        _WIDTH,
        initial_indent=margin,
        subsequent_indent=indent,
        break_long_words=False,
        break_on_hyphens=False,
    )


def with_small_images(text: str, folder: Path) -> str:
    """Replaces links to PNGs by SVGs if FOLDER has them: PNGs of plots are not committed."""

    def smaller(found: re.Match[str]) -> str:
        has_svg = (folder / f"{found[1]}.svg").is_file()
        return f"]({found[1]}.svg)" if has_svg else found[0]

    return _IMAGE.sub(smaller, text)
