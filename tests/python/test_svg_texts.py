"""The texts of plots: all drawn texts are in the SVG, and all axes and colors are named."""

from __future__ import annotations

import re
from collections.abc import Callable
from xml.etree import ElementTree

import pytest
from matplotlib.axes import Axes

from beambench_operations.publish.documents import PUBLISHED
from beambench_report.base.figure import LINE_COLORS, Plot, house_style, new_figure, svg_of
from svg_texts import missing_in, missing_texts


def drawn(change: Callable[[Axes], object]) -> str:
    """Draws a plot of two lines on logarithmic axes, with a change to its panel."""
    with house_style():
        figure, (panel,) = new_figure(2.5)
        for line, color in zip(("first <&> line", "second line"), LINE_COLORS, strict=False):
            panel.plot([1e-2, 1e3], [1e-3, 1e4], color=color, label=line)
        panel.set(xscale="log", yscale="log", xlabel="rays", ylabel="ms")
        for axis in (panel.xaxis, panel.yaxis):
            axis.set_major_formatter("{x:,g}")
        panel.legend(frameon=False)
        change(panel)
        return svg_of(Plot("plot", figure, "two lines"))


def words(svg: str) -> str:
    """Returns all characters except spaces and those of metadata."""
    root = ElementTree.fromstring(svg)
    parts = [child for child in root if not child.tag.endswith(("metadata", "style"))]
    return "".join("".join(text for part in parts for text in part.itertext()).split())


def test_every_character_that_matplotlib_draws_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    def draw_powers(panel: Axes) -> None:
        panel.set(xscale="linear", yscale="linear")
        panel.set(xscale="log", yscale="log", title="A title: $\\frac{a}{b}$ for $x^2$")

    kept = drawn(draw_powers)
    monkeypatch.setattr("beambench_report.base.figure.compact", lambda svg: svg)
    whole = drawn(draw_powers)
    style = re.compile(r"<style.*?</style>", re.DOTALL)
    assert words(kept) == words(style.sub("", whole))
    assert "10\N{MINUS SIGN}2" in words(kept)
    assert "first<&>line" in words(kept)


def test_published_plots_have_the_texts_that_their_axes_and_colors_need() -> None:
    assert missing_in(PUBLISHED) == {}


@pytest.mark.parametrize(
    ("change", "missing"),
    [
        (lambda panel: None, []),
        (lambda panel: panel.set_xlabel(""), ["panel 1: the horizontal axis has no label"]),
        (lambda panel: panel.set_ylabel(""), ["panel 1: the vertical axis has no label"]),
        (
            lambda panel: panel.tick_params(labelbottom=False),
            ["panel 1: the horizontal axis has 0 tick labels"],
        ),
        (
            lambda panel: panel.tick_params(labelleft=False),
            ["panel 1: the vertical axis has 0 tick labels"],
        ),
        (
            lambda panel: panel.get_legend().remove(),
            [f"nothing names the color {color}" for color in LINE_COLORS[:2]],
        ),
        (
            lambda panel: panel.get_legend().get_texts()[0].set_text(""),
            [f"nothing names the color {LINE_COLORS[0]}"],
        ),
    ],
)
def test_a_text_that_is_missing_is_found(
    change: Callable[[Axes], object], missing: list[str]
) -> None:
    assert missing_texts(drawn(change)) == missing


@pytest.mark.parametrize("tag", ["text", "tspan"])
def test_an_empty_text_is_found(tag: str) -> None:
    svg = drawn(lambda panel: panel.set_title("rays in $10^3$"))
    emptied = re.sub(f"(<{tag}[^>]*>)[^<]+(</{tag}>)", r"\1\2", svg, count=1)
    assert emptied != svg
    assert f"<{tag}> is empty" in missing_texts(emptied)
