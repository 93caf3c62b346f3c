"""A picture of curves, as studies write it with --out."""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure

Curves = dict[str, list[tuple[float, float]]]


def draw(file: Path, curves: Curves, across: str, up: str, x: str = "linear", y: str = "log") -> None:
    """Write `file`. across, up: what the axes show; x, y: their scales."""
    figure = Figure(figsize=(9, 5), layout="constrained")
    axes = figure.subplots()
    for label, points in curves.items():
        axes.plot([one for one, _ in points], [one for _, one in points], "o-", ms=3, label=label)
    axes.set(xlabel=across, ylabel=up, xscale=x, yscale=y)
    figure.legend(fontsize="small", loc="outside right upper")
    figure.savefig(file, dpi=120)
