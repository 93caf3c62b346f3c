"""The pointers around a group as a picture: the group on the left, beside it what is a pointer away, ...

Within a column groups stand near those that they are linked with. Pointers between the same two groups are
one arrow with all their names; one that leads to something else than the field table says is red and dashed.
"""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

from udec_ia.file_replacement import put_in_place
from udec_ia.heap_tools.pointer_graph import Edge, Graph, Node, colour, dot, neighbourhood, summary
from udec_ia.output.block_drawing import INK, picture_path, write_as
from udec_ia.reader.kind_colours import COLOURS
from udec_ia.reader.printed_listing import Listing
from udec_ia.reader.word_map import NOTHING, Atlas

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

BOX = (1.45, 0.34)  # inches of a group, width and height
ROOM = 175.0  # characters of one point that fit into it
STEP = (3.1, 0.5)  # inches from a column, and from a row, to the next
EDGE = 0.3  # inches around the picture
DOT = ".dot"
Place = tuple[float, float]


def draw(atlas: Atlas, place: int | str, out: str | Path, depth: int = 1) -> Listing:
    """Draw the pointers around the group at a place to the file `out`, as PNG, SVG or DOT.

    Raises as `pointer_graph.neighbourhood` does, ValueError for another kind of file, error 31 if it
    cannot be written.
    """
    path, found = picture_path(out, (DOT,)), neighbourhood(atlas, place, depth)
    if path.suffix.lower() == DOT:
        put_in_place(path, dot(found).encode(), force=False)
    else:
        write_as(figure(found), path)
    return Listing([*summary(found), f"wrote {path}"])


def figure(found: Graph) -> Figure:
    """The picture of a graph."""
    from matplotlib.figure import Figure

    places = layout(found)
    width = max(x for x, _ in places.values()) + BOX[0] + 2 * EDGE
    height = max(y for _, y in places.values()) + BOX[1] + 3 * EDGE
    picture = Figure((width + STEP[0] - BOX[0], height), facecolor="white")
    axes = picture.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=(-EDGE, picture.get_figwidth() - EDGE), ylim=(height - 2 * EDGE, -EDGE))
    axes.axis("off")
    together: dict[tuple[int, ...], list[Edge]] = {}
    for edge in found.edges:
        together.setdefault(
            tuple(sorted((edge.source, edge.target), key=lambda key: places[key])), []
        ).append(edge)
    for (one, *other), edges in together.items():
        _arrow(axes, one, places[one], places[other[0]], edges)
    for key, node in found.nodes.items():
        _box(axes, places[key], node)
    notes = ". ".join(summary(found))
    axes.text(0.0, height - 2.6 * EDGE, notes, fontsize=7, color=INK, va="top")
    return picture


def layout(found: Graph) -> dict[int, Place]:
    """Where each node stands, its upper left corner in inches, y down: columns by depth, in a good order."""
    columns: dict[int, list[int]] = {}
    for key, node in found.nodes.items():
        columns.setdefault(node.depth, []).append(key)
    links = Counter((edge.source, edge.target) for edge in found.edges)
    links.update({(target, source): many for (source, target), many in [*links.items()]})
    tallest = max(map(len, columns.values()))
    row: dict[int, float] = {}
    for depth in sorted(columns):
        column = _in_order(columns[depth], links, row)
        row.update((key, k + (tallest - len(column)) / 2) for k, key in enumerate(column))
    return {key: (node.depth * STEP[0], row[key] * STEP[1]) for key, node in found.nodes.items()}


def _in_order(column: list[int], links: Counter[tuple[int, int]], row: dict[int, float]) -> list[int]:
    """The nodes of a column: each behind the one that it has the largest number of pointers with.

    row: of the nodes in the columns before; where there is a choice, what is linked with the upper ones comes
    first.
    """

    def height(key: int) -> float:
        rows = [row[one] for one in row if links[key, one]]
        return sum(rows) / len(rows) if rows else 0.0

    waiting, found = sorted(column, key=height), list[int]()
    while waiting:
        best = max(waiting, key=lambda key: links[found[-1], key]) if found else waiting[0]
        waiting.remove(best)
        found.append(best)
    return found


def _box(axes: Axes, place: Place, node: Node) -> None:
    """A group: its kind and address, and below that its blocks."""
    from matplotlib.patches import FancyBboxPatch

    (x, y), shade = place, colour(node)
    for face, edge in (("white", "none"), (shade + "30", shade)):
        round_box = "round,pad=0.0,rounding_size=0.06"
        axes.add_patch(
            FancyBboxPatch((x, y), *BOX, boxstyle=round_box, facecolor=face, edgecolor=edge, zorder=3)
        )
    lines = node.name.replace(" of ", "\nof ", 1).replace(": ", "\n", 1).split("\n")
    size = min(6.5, ROOM / max(map(len, lines)))
    style: dict[str, Any] = {
        "ha": "center",
        "va": "center",
        "fontsize": size,
        "color": INK,
        "linespacing": 1.1,
    }
    axes.text(x + BOX[0] / 2, y + BOX[1] / 2, "\n".join(lines), zorder=5, **style)


def _arrow(axes: Axes, one: int, start: Place, end: Place, edges: list[Edge]) -> None:
    """The pointers between two groups, of which `one` is on the left or above, with their names."""
    from matplotlib.patches import FancyArrowPatch
    from matplotlib.path import Path as Curve

    there, back = ([edge.field for edge in edges if (edge.source == one) is way] for way in (True, False))
    shade = INK if all(edge.sound for edge in edges) else COLOURS[NOTHING]
    curve, same = _curve(start, end), start[0] == end[0]
    arrow: dict[str, Any] = {
        "arrowstyle": ("<|-|>" if there else "<|-") if back else "-|>",
        "mutation_scale": 6,
    }
    line: dict[str, Any] = {"color": shade, "linewidth": 0.6, "linestyle": "-" if shade == INK else "--"}
    codes = [Curve.MOVETO, Curve.CURVE3, Curve.CURVE3]
    axes.add_patch(FancyArrowPatch(path=Curve(curve, codes), zorder=2, **arrow, **line))
    share = 0.5 if same else 0.68  # from the start to the names
    x, y = (
        (1 - share) ** 2 * p + 2 * share * (1 - share) * q + share**2 * r
        for p, q, r in zip(*curve, strict=True)
    )
    marks = ("\u2193", "\u2191") if same else ("\u2192", "\u2190")
    label = "\n".join(
        f"{mark} {', '.join(names)}" for mark, names in zip(marks, (there, back), strict=True) if names
    )
    around = {"boxstyle": "round,pad=0.05", "facecolor": "white", "edgecolor": "none", "alpha": 0.8}
    axes.text(x, y, label, fontsize=5, color=shade, ha="center", va="center", bbox=around, zorder=2.5)


def _curve(start: Place, end: Place) -> list[Place]:
    """Where an arrow begins, bends to, and ends; within a column it goes around on the right."""
    same = end[0] == start[0]
    x1, y1, x2, y2 = start[0] + BOX[0], start[1] + BOX[1] / 2, end[0] + BOX[0] * same, end[1] + BOX[1] / 2
    out = min(0.2 + 0.25 * (y2 - y1) / STEP[1], STEP[0]) if same else (x2 - x1) / 2
    if start == end:
        y1, y2 = start[1], start[1] + BOX[1]
    return [(x1, y1), (x1 + out, (y1 + y2) / 2), (x2, y2)]
