"""A picture as a file: PNG to look at, SVG to print or to edit."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING

from udec_ia.files import put_in_place
from udec_ia.printable import printable

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DPI = 150
TYPES = (".png", ".svg")


def write(figure: Figure, base: Path) -> list[Path]:
    """Write base.png and base.svg; returns both paths. Error 31 if that cannot be done."""
    paths = [base.with_name(f"{base.name}{kind}") for kind in TYPES]
    for path in paths:
        write_as(figure, path)
    return paths


def write_as(figure: Figure, path: Path) -> None:
    """Write the file `path`, as the end of its name says. Error 31 if it cannot be done."""
    image, kind = io.BytesIO(), path.suffix[1:].lower()
    figure.savefig(image, format=kind, dpi=DPI, metadata={"Date": None} if kind == "svg" else None)
    put_in_place(path, image.getvalue(), force=False)


def picture_path(name: str | Path, more: tuple[str, ...] = ()) -> Path:
    """The path of a picture that is to be written. ValueError unless it ends as the type of one does."""
    path = Path(name)
    if path.suffix.lower() not in (*TYPES, *more):
        ends = " or ".join((*TYPES, *more))
        raise ValueError(f"{printable(str(name))}: the name of a picture ends in {ends}")
    return path
