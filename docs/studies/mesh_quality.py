"""How good the zones of GENERATE ... AUTOMATIC are: random blocks, meshed, and the angles of their zones.

    python docs/studies/mesh_quality.py [--blocks N] [--seed SEED]

prints what docs/meshes.md says. A quarter of the blocks is cut from a rectangle by random lines, as SPLIT
does, and convex; a quarter are stars with 4 to 10 points of random length; a quarter are combs, all of whose
corners are right angles; the rest are triangles. The *width* of a block is the least distance of a corner
from an edge that does not end there: no part of the block is narrower. Edges are fractions of it.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from udec_ia.ops.commands.triangulation import mesh

Points = NDArray[np.float64]
FRACTIONS = (2.0, 1.0, 0.5, 0.25)  # edges, in widths of the block
BLUNT = 60.0  # degrees: zones need not be worse than the corners of a block whose corners are all so blunt
LONGEST = 60.0  # no mesh is more edges long
HEADER = (
    "| edge / width | blocks | zones | least angle | of 1 zone in 100 | MIXED: least | of 1 zone in 100 |"
)


class Quality(NamedTuple):
    """Least angles (degrees) of all zones of a mesh, of a block with the given sharpest corner."""

    corner: float
    angles: Points


def following(outline: Points) -> Points:
    """For each corner the next one."""
    return np.asarray(np.roll(outline, -1, axis=0))


def cross(a: Points, b: Points) -> Points:
    """Vector products, positive if b is anticlockwise of a."""
    return np.asarray(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0])


def sharpest(outline: Points) -> float:
    """The least angle between two edges, inside, of the outline (clockwise); degrees."""
    back, on = np.roll(outline, 1, axis=0) - outline, following(outline) - outline
    angle = np.degrees(np.arctan2(cross(back, on), (back * on).sum(axis=1)))
    return float((angle % 360).min())


def width(outline: Points) -> float:
    """The least distance of a corner from an edge that does not end there, or from the next corner."""
    n = len(outline)
    along = following(outline) - outline
    away = outline[:, None] - outline
    part = np.clip((away * along).sum(axis=-1) / (along**2).sum(axis=-1), 0, 1)
    distance = np.linalg.norm(away - part[..., None] * along, axis=-1)
    here = np.arange(n)
    distance[here, here] = distance[here, here - 1] = np.inf
    return float(min(distance.min(), np.linalg.norm(along, axis=1).min()))


def cut(rng: np.random.Generator) -> Points:
    """A rectangle of which random lines have cut parts off."""
    outline = np.array([(0, 0), (0, 1), (1, 1), (1, 0)]) * rng.uniform(1, 3, 2)
    for _ in range(rng.integers(5)):
        normal = rng.normal(size=2)
        side = (outline - outline.mean(axis=0)) @ (normal / np.linalg.norm(normal))
        side = rng.uniform(0.3, 0.9) * side.max() - side
        points = []
        for a, b, s, t in zip(outline, following(outline), side, np.roll(side, -1), strict=True):
            points += [a] if s > 0 else []
            points += [a + (b - a) * s / (s - t)] if s * t < 0 else []
        outline = np.array(points)
    return outline


def star(rng: np.random.Generator) -> Points:
    """Points of random length around the origin, in random directions."""
    n = int(rng.integers(4, 11))
    gaps = rng.uniform(1, 3, n)
    angle = -2 * np.pi * np.cumsum(gaps) / gaps.sum()
    return np.asarray(rng.uniform(0.4, 1, (n, 1)) * np.stack([np.cos(angle), np.sin(angle)], axis=1))


def comb(rng: np.random.Generator) -> Points:
    """One to four teeth of random sizes on a bar."""
    points, x = [(0.0, 0.0)], 0.0
    for _ in range(rng.integers(1, 5)):
        high, wide, gap = rng.uniform(1, 4, 3)
        points += [(x, 1 + high), (x + wide, 1 + high), (x + wide, 1), (x + wide + gap, 1)]
        x += wide + gap
    return np.array([*points, (x, 0.0)])


def triangle(rng: np.random.Generator) -> Points:
    """Three random points."""
    points = rng.uniform(0, 1, (3, 2))
    return points if cross(points[1] - points[0], points[2] - points[0]) < 0 else points[::-1]


def blocks(count: int, seed: int) -> Iterator[Points]:
    """Random blocks, turned at random."""
    rng = np.random.default_rng(seed)
    for k in range(count):
        c, s = np.cos(turn := rng.uniform(0, 2 * np.pi)), np.sin(turn)
        yield (cut, star, comb, triangle)[k % 4](rng) @ np.array([[c, s], [-s, c]])


def measure(outlines: list[Points], fraction: float, paired: bool) -> list[Quality]:
    """The meshes of the outlines, with edges that are this fraction of their widths."""
    found = []
    for outline in outlines:
        edge = fraction * width(outline)
        if np.ptp(outline, axis=0).max() < LONGEST * edge:
            found.append(Quality(sharpest(outline), mesh(outline, edge, paired).angles))
    return found


def row(plain: list[Quality], paired: list[Quality]) -> str:
    """Numbers of blocks and zones, and angles: the least of all and the hundredth part."""
    one, two = (np.concatenate([q.angles for q in each]) for each in (plain, paired))
    angles = [f"{a:.0f}" for each in (one, two) for a in (each.min(), np.percentile(each, 1))]
    return " | ".join([str(len(plain)), f"{len(one):,}", *angles])


def main() -> None:
    """Print the tables."""
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--blocks", type=int, default=2000)
    arguments.add_argument("--seed", type=int, default=1)
    given = arguments.parse_args()
    outlines = list(blocks(given.blocks, given.seed))
    print(HEADER, "|---" * (HEADER.count("|") - 1) + "|", sep="\n")
    sharp = []
    for fraction in FRACTIONS:
        plain, paired = (measure(outlines, fraction, each) for each in (False, True))
        blunt = [[q for q in each if q.corner >= BLUNT] for each in (plain, paired)]
        print(f"| {fraction:g} | {row(*blunt)} |")
        sharp += [q.angles.min() / q.corner for q in plain + paired if q.corner < BLUNT / 2 and fraction < 1]
    print(
        f"\nBlocks with a corner below {BLUNT / 2:g} degrees, in {len(sharp)} meshes with edges below the "
        f"width: the least angle is {min(sharp):.2f} of the sharpest corner or more."
    )


if __name__ == "__main__":
    main()
