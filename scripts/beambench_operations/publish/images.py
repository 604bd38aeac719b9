"""The images of a text: SVG where there is one, since PNGs of the same plots are not committed."""

import re
from pathlib import Path

_IMAGE = re.compile(r"\]\(([^)\s:]+)\.png\)")


def with_small_images(text: str, folder: Path) -> str:
    """Returns the text with links to SVG where FOLDER has them in place of the PNG."""

    def smaller(found: re.Match[str]) -> str:
        has_svg = (folder / f"{found[1]}.svg").is_file()
        return f"]({found[1]}.svg)" if has_svg else found[0]

    return _IMAGE.sub(smaller, text)
