"""What the formulas tell over what was measured."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain

import numpy as np

from beambench_report.figure import Plot, new_figure
from beambench_report.style import variant_look
from beambench_report.thesis.cost.fitting import Fit

_HEIGHTS = {1: 3.0, 2: 3.4, 3: 2.5}  # inches, by the number of panels
_BAND = 0.25
_NANOSECONDS = {"ms": 1e-6, "ns a ray": 1.0}


def draw_fits(stem: str, fits: Sequence[Fit]) -> Plot:
    """A panel a formula: every cell a point; on the line, the formula tells the time exactly."""
    figure, panels = new_figure(_HEIGHTS[len(fits)], 1, len(fits))
    for panel, fit in zip(panels, fits, strict=True):
        scale = _NANOSECONDS[fit.formula.unit]
        measured = np.array([one.time for one in fit.observations]) * scale
        told = np.array(fit.told) * scale
        structures = [one.cell.structure for one in fit.observations]
        for structure in dict.fromkeys(structures):
            at = [name == structure for name in structures]
            look = variant_look(structure, 0 if structure == "beam" else 1)
            panel.scatter(
                measured[at],
                told[at],
                s=12,
                color=look.colour,
                marker=look.marker,
                alpha=0.55,
                linewidths=0,
                label=structure,
            )
        both = [value for value in chain(measured, told) if value > 0]
        ends = np.array([min(both) / 1.5, max(both) * 1.5])
        panel.plot(ends, ends, color="#333333", linewidth=0.8)
        panel.fill_between(
            ends, ends * (1 - _BAND), ends * (1 + _BAND), color="#999999", alpha=0.25, linewidth=0
        )
        panel.set(xscale="log", yscale="log", xlim=ends, ylim=ends, aspect="equal")
        panel.set_title(fit.formula.title, fontsize=8.5)
        panel.set_ylabel(f"told / {fit.formula.unit}", labelpad=1)
        panel.set_xlabel(f"measured / {fit.formula.unit}")
        panel.tick_params(labelsize=8)
        panel.grid(which="major", color="#dddddd", linewidth=0.6)
        panel.legend(frameon=False, fontsize=8, loc="upper left")
    return Plot(stem, figure, "Times told by counts over measured times")
