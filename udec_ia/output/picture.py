"""A picture as two files: PNG to look at, SVG to print or to edit."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING

from udec_ia.files import put_in_place

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DPI = 150


def write(figure: Figure, base: Path) -> list[Path]:
    """Write base.png and base.svg; returns both paths. Error 31 if that cannot be done."""
    paths = [base.with_name(f"{base.name}.{kind}") for kind in ("png", "svg")]
    for path in paths:
        image, kind = io.BytesIO(), path.suffix[1:]
        figure.savefig(image, format=kind, dpi=DPI, metadata={"Date": None} if kind == "svg" else None)
        put_in_place(path, image.getvalue(), force=False)
    return paths
