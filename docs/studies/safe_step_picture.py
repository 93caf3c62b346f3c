"""Pictures of the safe bound and the estimate of 1980 over the true limit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from support.safe_step_search import LIMITS, Found

BINS = np.geomspace(0.1, 10, 101)
COLOURS = {"bound": "tab:blue", "estimate": "tab:orange", "runs": "black"}
CALLED = {
    "bound": "safe bound (FRACTION 1 SAFE)",
    "estimate": "estimate of 1980 (FRACTION 1)",
    "runs": "limit by runs",
}


def dots(found: dict[str, dict[str, float]], path: Path) -> None:
    """A line for each scene, with dots at shares of the true limit, called as in CALLED."""
    figure = Figure(figsize=(7, 6), layout="constrained")
    axis = figure.subplots()
    for name in CALLED:
        shares = [one[name] for one in found.values()]
        axis.plot(shares, range(len(found)), "o", ms=5, color=COLOURS[name], label=CALLED[name])
    axis.axvline(1, color="black", linewidth=1)
    axis.set(
        xlim=(0, None),
        yticks=range(len(found)),
        yticklabels=list(found),
        xlabel="time-step over the limit of the matrices",
    )
    axis.invert_yaxis()
    axis.grid(axis="y", alpha=0.3)
    figure.legend(fontsize=8, loc="outside upper center", ncols=len(CALLED))
    figure.savefig(path, dpi=120)


def draw(found: list[Found], path: Path) -> None:
    """Two histograms, of rigid and of deformable scenes; a step to the right of 1 is unstable."""
    figure = Figure(figsize=(7, 5), layout="constrained")
    axes = figure.subplots(len(LIMITS), 1, sharex=True)
    for axis, kind in zip(axes, LIMITS, strict=True):
        rows = [one for one in found if one.kind == kind and np.isfinite(one.bound)]
        for name in ("bound", "estimate"):
            shares = np.clip([getattr(one, name) for one in rows], BINS[0], BINS[-1])
            axis.hist(shares, BINS, color=COLOURS[name], alpha=0.7, label=CALLED[name])
        axis.axvline(1, color="black", linewidth=1)
        axis.set_xscale("log")
        axis.set_title(f"{len(rows):,} {kind} scenes", fontsize=10)
        axis.set_ylabel("scenes")
    axes[0].legend(fontsize=8, loc="upper left")
    axes[-1].set_xlabel("time-step over the true limit; all below 0.1 stand there")
    figure.savefig(path, dpi=120)
