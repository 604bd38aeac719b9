"""Embeds plots in an HTML page: in the page's colors, light or dark, and with unique ids."""

import re

from beambench_report.base.palette import TINTS

_VARIABLES = {tint.light: f"var(--{tint.name}, {tint.light})" for tint in TINTS}
_PIXELS_PER_POINT = 5 / 3


def inline_svg(text: str, stem: str) -> str:
    """Returns the `<svg>` element of an SVG, as wide as the page; its ids begin with `stem`."""
    svg = re.sub(r"<svg[^>]*>", _root, text[text.index("<svg") :], count=1)
    prefix = f"plot-{stem}-"
    svg = svg.replace("xlink:href=", "href=")
    svg = re.sub(r'( id="|href="#|url\(#)', rf"\g<1>{prefix}", svg)
    return re.sub(r' style="[^"]*"', _in_variables, svg).strip()


def dark_variables() -> dict[str, str]:
    """Returns the CSS variables of all plots for a dark page, with their colors."""
    return {f"--{tint.name}": tint.dark for tint in TINTS}


def _root(tag: re.Match[str]) -> str:
    box = re.search(r'viewBox="([^"]*)"', tag[0])[1]
    style = re.search(r'style="([^"]*)"', tag[0])[1]
    width = _PIXELS_PER_POINT * float(box.split()[2])
    size = f"width: {width:.0f}px; max-width: 100%; height: auto"
    return f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}" style="{size}; {style}">'


def _in_variables(style: re.Match[str]) -> str:
    return re.sub(r"#[0-9a-f]{6}\b", lambda color: _VARIABLES.get(color[0], color[0]), style[0])
