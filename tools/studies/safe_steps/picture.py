"""A picture of what a search has found: the safe bound and the estimate of 1980 over the true limit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from safe_steps.search import LIMITS, Found

BINS = np.geomspace(0.1, 10, 101)
COLOURS = {"bound": "tab:blue", "estimate": "tab:orange"}
CALLED = {"bound": "safe bound (FRACTION 1 SAFE)", "estimate": "estimate of 1980 (FRACTION 1)"}


def draw(found: list[Found], path: Path) -> None:
    """Two histograms, of rigid and of deformable scenes; a step to the right of 1 is unstable."""
    figure = Figure(figsize=(7, 5), layout="constrained")
    axes = figure.subplots(len(LIMITS), 1, sharex=True)
    for axis, kind in zip(axes, LIMITS, strict=True):
        rows = [one for one in found if one.kind == kind and np.isfinite(one.bound)]
        for name, colour in COLOURS.items():
            shares = np.clip([getattr(one, name) for one in rows], BINS[0], BINS[-1])
            axis.hist(shares, BINS, color=colour, alpha=0.7, label=CALLED[name])
        axis.axvline(1, color="black", linewidth=1)
        axis.set_xscale("log")
        axis.set_title(f"{len(rows):,} {kind} scenes", fontsize=10)
        axis.set_ylabel("scenes")
    axes[0].legend(fontsize=8, loc="upper left")
    axes[-1].set_xlabel("time-step over the true limit; all below 0.1 stand there")
    figure.savefig(path, dpi=120)
