"""Adds hover titles to matplotlib's SVG, and removes what is not needed."""

import re
from collections.abc import Iterator
from typing import TypeVar
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from matplotlib.artist import Artist

_SVG, _XLINK = "http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink"
_G, _USE = f"{{{_SVG}}}g", f"{{{_SVG}}}use"
_TITLE, _DEFS = f"{{{_SVG}}}title", f"{{{_SVG}}}defs"
_HREF = f"{{{_XLINK}}}href"
_HOVER = "hover:"
_MANY_CORNERS = 10
# All texts share one font family and all lines the same ends: the root element states both once.
_FAMILY = re.compile(r" *font-family: ([^;]*);")
_ROOT_STYLE = "stroke-linejoin: round; stroke-linecap: butt; font-family: {}"

_Drawn = TypeVar("_Drawn", bound=Artist)


def hover(artist: _Drawn, text: str) -> _Drawn:
    """Makes the SVG show the text when the mouse is over the artist; returns the artist.

    The text is stored in the artist's id, which `compact` turns into a title.
    """
    artist.set_gid(_HOVER + text)
    return artist


def compact(svg: str) -> str:
    """Returns the plot with hover titles; it looks the same at a third of the length."""
    root = ElementTree.fromstring(svg)
    for child in list(root):
        is_style_sheet = child.tag == _DEFS and [one.tag for one in child] == [f"{{{_SVG}}}style"]
        if child.tag.endswith("metadata") or is_style_sheet:
            root.remove(child)
    families = _FAMILY.findall(svg)
    root.set("style", _ROOT_STYLE.format(families[0] if families else "sans-serif"))
    used = _used_ids(root)
    for element in root.iter():
        _shorten(element, used)
    _share_markers(root)
    _unwrap(root)
    ElementTree.register_namespace("", _SVG)
    ElementTree.register_namespace("xlink", _XLINK)
    return f"<?xml version='1.0' encoding='utf-8'?>\n{ElementTree.tostring(root, 'unicode')}\n"


def _used_ids(root: Element) -> dict[str, str]:
    """Returns the ids that are referenced, each with a short replacement."""

    def used() -> Iterator[str]:
        for element in root.iter():
            for value in element.attrib.values():
                yield from re.findall(r"url\(#([^)]+)\)", value)
            if reference := element.get(_HREF):
                yield reference.removeprefix("#")

    return {name: f"i{place}" for place, name in enumerate(dict.fromkeys(used()))}


def _shorten(element: Element, used: dict[str, str]) -> None:
    name = element.attrib.pop("id", "")
    if name.startswith(_HOVER):
        title = Element(_TITLE)
        title.text = name.removeprefix(_HOVER)
        element.insert(0, title)
    elif name in used:
        element.set("id", used[name])
    for key, value in element.attrib.items():
        if key in ("d", "x", "y", "width", "height", "transform"):
            value = _rounded(value)
        elif key == _HREF:
            value = f"#{used[value.removeprefix('#')]}"
        elif key == "style":
            value = re.sub(r"([:;]) ", r"\1", _FAMILY.sub("", value))
            value = value.removesuffix(";").replace("stroke-dashoffset:0;", "")
        element.set(key, re.sub(r"url\(#([^)]+)\)", lambda m: f"url(#{used[m[1]]})", value))
    if element.get("transform", "").startswith("rotate(-0 "):
        del element.attrib["transform"]
    # Text between elements is only indentation. Text within elements is kept: in mathematical
    # labels each character has a <tspan>.
    if element.text and not element.text.strip():
        element.text = None
    if element.tail and not element.tail.strip():
        element.tail = None


def _share_markers(root: Element) -> None:
    """Defines each marker once for all colors; every use states its color."""
    first: dict[tuple[str | None, str | None], str] = {}
    same: dict[str, str] = {}
    for parent in list(root.iter(_G)):
        for definitions in parent.findall(_DEFS):
            for path in list(definitions):
                look = (path.get("d"), path.get("style"))
                same[path.get("id", "")] = first.setdefault(look, path.get("id", ""))
                if first[look] != path.get("id"):
                    definitions.remove(path)
            if not len(definitions):
                parent.remove(definitions)
    for use in root.iter(_USE):
        name = use.get(_HREF, "").removeprefix("#")
        use.set(_HREF, f"#{same.get(name, name)}")


def _rounded(text: str) -> str:
    """Rounds to a hundredth of a point, or to a tenth in lines with many corners."""
    digits = 1 if text.count("L") > _MANY_CORNERS else 2

    def shorter(number: re.Match[str]) -> str:
        return f"{float(number[0]):.{digits}f}".rstrip("0").rstrip(".")

    text = re.sub(r"-?\d+\.\d+(?:e-?\d+)?", shorter, text)
    return re.sub(r"([MLCz]) | (?=[MLCz])|\n", r"\1", re.sub(r"\s+", " ", text)).strip()


def _unwrap(parent: Element) -> None:
    """Removes groups without attributes, and moves the style of equal markers to their group."""
    for child in list(parent):
        _unwrap(child)
        if child.tag == _G and not child.attrib and child.find(_TITLE) is None:
            place = list(parent).index(child)
            parent.remove(child)
            for offset, inner in enumerate(list(child)):
                parent.insert(place + offset, inner)
        elif child.tag == _G and not child.attrib and len(child) == 2 and child[1].tag == _G:
            inner = child[1]  # the title moves to the group that it describes
            child.remove(inner)
            child.attrib.update(inner.attrib)
            child.extend(list(inner))
    markers = [child for child in parent if child.tag == _USE]
    styles = {marker.get("style") for marker in markers}
    others = [child for child in parent if child.tag not in (_USE, _TITLE)]
    if parent.tag == _G and len(styles) == 1 and not others and "style" not in parent.attrib:
        parent.set("style", styles.pop() or "")
        for marker in markers:
            marker.attrib.pop("style", None)
