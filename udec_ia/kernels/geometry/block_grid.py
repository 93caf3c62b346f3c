"""A grid of square cells in which blocks find their neighbours.

The grid exists only while contacts are searched: the blocks on large domains are entered anew in each cycle
in which one of them searches. A block that is not wider than a cell is entered in the cell of its middle, a
larger one in all cells that its edges pass through, since no other block can be inside it. Cells are
numbered by their place and found through a table, so blocks that fly far away cost nothing.
"""

from __future__ import annotations

from collections import namedtuple
from typing import Any

import numpy as np

from udec_ia.compiling.kernel_decorators import inlined, kernel
from udec_ia.heap.accessors import Memory, getr, iget
from udec_ia.layout import offsets as g

WIDE = 3.0  # cells across, above which a block is entered edge by edge
FARTHEST = 2.0e9  # cells from the origin; a block that is farther away is entered in the last one

# blocks: their addresses; box: (n, 4) lower x and y, upper x and y; cell: width of a cell; reach: distance
# in x and y up to which blocks are neighbours; start: first entry of each row of the table; key, row: cell
# and block of the entries; seen: number of the last search that has met each block; search: number of the
# latest one
Grid = namedtuple("Grid", ["blocks", "box", "cell", "reach", "start", "key", "row", "seen", "search"])


@kernel
def enter_circle(h: Memory, ib: int, box: Any) -> None:
    """Fill `box` with the lower x and y and the upper x and y of a circle around block `ib`."""
    x, y, r = np.float64(getr(h, ib, g.KX)), np.float64(getr(h, ib, g.KY)), np.float64(getr(h, ib, g.KBRO))
    box[0], box[1], box[2], box[3] = x - r, y - r, x + r, y + r


@kernel
def enter_outline(h: Memory, ib: int, box: Any) -> None:
    """As enter_circle, for the outline of block `ib`."""
    ip0 = iget(h, ib, g.KP)
    box[0], box[1], box[2], box[3] = np.inf, np.inf, -np.inf, -np.inf
    ip = ip0
    while True:
        x, y = np.float64(getr(h, ip, g.KXP)), np.float64(getr(h, ip, g.KYP))
        box[0], box[1], box[2], box[3] = min(box[0], x), min(box[1], y), max(box[2], x), max(box[3], y)
        ip = iget(h, ip, g.KR)
        if ip == ip0:
            return


@inlined
def _cell(x: float, cell: float) -> int:
    """Number of the cell, in x or in y, that contains the coordinate `x`."""
    return int(min(max(np.floor(x / cell), -FARTHEST), FARTHEST))


@kernel
def _enter_cells(box: Any, cell: float, margin: float, keys: Any, n: int) -> int:
    """Enter the cells that `box` covers with a margin in `keys` from place `n` on; returns the next place.

    Beyond the end of `keys` they are only counted.
    """
    left, right = _cell(box[0] - margin, cell), _cell(box[2] + margin, cell)
    below, above = _cell(box[1] - margin, cell), _cell(box[3] + margin, cell)
    for i in range(left, right + 1):
        for j in range(below, above + 1):
            if n < len(keys):
                keys[n] = i * 0x100000000 + j
            n += 1
    return n


@kernel
def cells_of(h: Memory, ib: int, box: Any, cell: float, margin: float, keys: Any) -> int:
    """Enter the cells of block `ib` in `keys`; returns their number, which may be more than there is room."""
    if max(box[2] - box[0], box[3] - box[1]) <= WIDE * cell:
        return _enter_cells(box, cell, margin, keys, 0)
    part = np.empty(4, np.float64)
    n = 0
    ip0 = iget(h, ib, g.KP)
    ip = ip0
    while True:
        ia = iget(h, ip, g.KR)
        ax, ay = np.float64(getr(h, ia, g.KXP)), np.float64(getr(h, ia, g.KYP))
        bx, by = np.float64(getr(h, ip, g.KXP)), np.float64(getr(h, ip, g.KYP))
        pieces = 1 + int(max(abs(bx - ax), abs(by - ay)) / cell)
        for k in range(pieces):
            px, py = ax + (bx - ax) * k / pieces, ay + (by - ay) * k / pieces
            qx, qy = ax + (bx - ax) * (k + 1) / pieces, ay + (by - ay) * (k + 1) / pieces
            part[0], part[1], part[2], part[3] = min(px, qx), min(py, qy), max(px, qx), max(py, qy)
            n = _enter_cells(part, cell, margin, keys, n)
        ip = ia
        if ip == ip0:
            return n


@inlined
def _row_of(key: int, rows: int) -> int:
    """Row of the table for a cell; `rows` is a power of 2."""
    mixed = (key >> 32) * 73856093 ^ (key & 0xFFFFFFFF) * 19349663
    return mixed & (rows - 1)


@inlined
def _is_narrow(box: Any, cell: float) -> bool:
    """True if `box` is not wider than a cell."""
    return bool(max(box[2] - box[0], box[3] - box[1]) <= cell)


@kernel
def _enter_block(h: Memory, ib: int, box: Any, cell: float, keys: Any) -> int:
    """Enter the cells in which block `ib` is listed in `keys`; returns their number, as cells_of."""
    if not _is_narrow(box, cell):
        return cells_of(h, ib, box, cell, 0.0, keys)
    if len(keys) > 0:
        keys[0] = _cell((box[0] + box[2]) * 0.5, cell) * 0x100000000 + _cell((box[1] + box[3]) * 0.5, cell)
    return 1


@kernel
def make_grid(h: Memory, blocks: Any, box: Any, cell: float, reach: float) -> Any:
    """The grid of the blocks at the addresses `blocks` with the outlines `box`."""
    n = len(blocks)
    nothing = np.empty(0, np.int64)
    total = 0
    for k in range(n):
        total += _enter_block(h, blocks[k], box[k], cell, nothing)
    key, row = np.empty(total, np.int64), np.empty(total, np.int64)
    m = 0
    for k in range(n):
        cells = _enter_block(h, blocks[k], box[k], cell, key[m:])
        row[m : m + cells] = k
        m += cells
    rows = 1
    while rows < total:
        rows *= 2
    start = np.zeros(rows + 1, np.int64)
    for i in range(total):
        start[_row_of(key[i], rows) + 1] += 1
    for i in range(rows):
        start[i + 1] += start[i]
    place = start[:rows].copy()
    keys_in_order, rows_in_order = np.empty(total, np.int64), np.empty(total, np.int64)
    for i in range(total):
        at = _row_of(key[i], rows)
        keys_in_order[place[at]], rows_in_order[place[at]] = key[i], row[i]
        place[at] += 1
    seen, search = np.zeros(n, np.int64), np.zeros(1, np.int64)
    return Grid(blocks, box, cell, reach, start, keys_in_order, rows_in_order, seen, search)


@inlined
def box_gap(a: Any, b: Any) -> float:
    """The distance of the boxes `a` and `b` in x or in y, whichever is greater; negative if they meet."""
    return max(max(a[0] - b[2], b[0] - a[2]), max(a[1] - b[3], b[1] - a[3]))


@kernel
def _blocks_at(grid: Any, keys: Any, cells: int, box: Any, reach: float) -> Any:
    """Rows of the blocks in the first `cells` of `keys` whose boxes are nearer than `reach` to `box`."""
    found = np.empty(32, np.int64)
    n = 0
    grid.search[0] += 1
    for c in range(cells):
        at = _row_of(keys[c], len(grid.start) - 1)
        for i in range(grid.start[at], grid.start[at + 1]):
            k = grid.row[i]
            if grid.key[i] != keys[c] or grid.seen[k] == grid.search[0]:
                continue
            grid.seen[k] = grid.search[0]
            if box_gap(grid.box[k], box) >= reach:
                continue
            if n == len(found):
                longer = np.empty(n + n, np.int64)
                longer[:n] = found
                found = longer
            found[n] = k
            n += 1
    return np.sort(found[:n])


@kernel
def neighbours(h: Memory, grid: Any, k: int) -> Any:
    """Rows of the blocks, `k` included, whose boxes are nearer than the reach to that of row `k`."""
    keys = np.empty(64, np.int64)
    margin = grid.reach + grid.cell * 0.5  # the middle of a narrow block is half a cell from its outline
    cells = cells_of(h, grid.blocks[k], grid.box[k], grid.cell, margin, keys)
    if cells > len(keys):
        keys = np.empty(cells, np.int64)
        cells_of(h, grid.blocks[k], grid.box[k], grid.cell, margin, keys)
    return _blocks_at(grid, keys, cells, grid.box[k], grid.reach)


@kernel
def blocks_inside(grid: Any, box: Any) -> Any:
    """Addresses of the blocks that may lie inside `box`; others may be among them."""
    keys = np.empty(256, np.int64)
    wide = max(box[2] - box[0], box[3] - box[1]) > grid.cell * 12.0
    cells = len(keys) + 1 if wide else _enter_cells(box, grid.cell, 0.0, keys, 0)
    if cells > len(keys):
        return grid.blocks
    return grid.blocks[_blocks_at(grid, keys, cells, box, 0.0)]
