"""The pointers around a group: what it points to, what points to it, and so on; as a list or in DOT.

Groups are taken in waves, the nearest first, up to the number that a picture can show; the rest is counted.
A telescope follows the pointers of one group only forwards, some levels deep, as an indented list.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from udec_ia.heap_tools.heap_lookup import Pointers, pointers
from udec_ia.printable_text import counted
from udec_ia.reader.field_rows import COMMON
from udec_ia.reader.kind_colours import COLOURS
from udec_ia.reader.place_grammar import address_of
from udec_ia.reader.printed_listing import Listing
from udec_ia.reader.word_map import JUNK, KINDS, NOTHING, Atlas, Word, called, leads_to, names

NODES = 40  # groups that a graph shows
LEVELS, LINES = 2, 200  # of a telescope
ASTRAY = "astray"  # kind of a node that is no group


class Node(NamedTuple):
    """A group, the common block, or an address without a group. depth: pointers between it and the first."""

    name: str
    kind: str
    depth: int


class Edge(NamedTuple):
    """A pointer. meaning: what it leads to; sound: that is what the field table says."""

    source: int
    field: str
    target: int
    meaning: str
    sound: bool


class Graph(NamedTuple):
    """Nodes by address, and the pointers between them. left_out: groups as near that it has no room for."""

    nodes: dict[int, Node]
    edges: list[Edge]
    left_out: int


def neighbourhood(atlas: Atlas, place: int | str, depth: int = 1, limit: int = NODES) -> Graph:
    """The pointers around the group at, or around, a place: depth of them away, `limit` groups.

    IndexError outside IA(), ValueError for what is no group, or no depth.
    """
    address = address_of(atlas, place)
    span = atlas.span(address)
    if span.kind not in KINDS:
        raise ValueError(f"{address} is in words that are {span.kind}: only groups have pointers")
    if depth < 1:
        raise ValueError(f"depth {depth}: give the number of pointers to follow, 1 or more")
    every = list(pointers(atlas))
    nodes, wave, left_out = {span.first: 0}, np.array([span.first]), 0
    for away in range(1, depth + 1):
        near = np.setdiff1d(_near(atlas, every, wave), [*nodes])
        wave, left_out = near[: limit - len(nodes)], max(len(near) + len(nodes) - limit, 0)
        nodes |= dict.fromkeys(wave.tolist(), away)
        if left_out or not len(wave):
            break
    edges = list(_edges(atlas, every, nodes))
    return Graph(_named(atlas, nodes, edges), edges, left_out)


def _near(atlas: Atlas, every: list[Pointers], wave: Any) -> Any:
    """Addresses of the groups that groups of a wave point to, or that point to them."""
    marked, found = _marks(atlas, wave), [np.zeros(0, np.int64)]
    for one in every:
        if one.word is not None:
            found += [one.to[marked[one.at]], one.at[_at(marked, one.to)]]
    near = np.unique(np.concatenate(found))
    return near[atlas.holding("any", near)]


def _marks(atlas: Atlas, addresses: Any) -> Any:
    marked = np.zeros(atlas.free, bool)
    marked[addresses] = True
    return marked


def _at(marked: Any, to: Any) -> Any:
    """Whether what pointers lead to is marked; False for what lies outside."""
    return marked[np.where((to > 0) & (to < len(marked)), to, 0)]


def _edges(atlas: Atlas, every: list[Pointers], nodes: dict[int, int]) -> Iterator[Edge]:
    """Pointers of the groups to one another or to no group, and of the common block to the groups."""
    marked = _marks(atlas, [*nodes])
    for one in every:
        to = one.to.astype(np.int64)
        sound = atlas.holding(one.target, to)
        known = _at(marked, to)
        if one.word is None:
            chosen = np.flatnonzero(known)
        else:
            chosen = np.flatnonzero(marked[one.at] & (to != 0) & (known | ~atlas.holding("any", to)))
        meanings = leads_to(atlas, one.target, to[chosen])
        for k, text in zip(chosen.tolist(), meanings, strict=True):
            yield Edge(int(one.at[k]), one.name, int(to[k]), text, bool(sound[k]))


def _named(atlas: Atlas, depths: dict[int, int], edges: list[Edge]) -> dict[int, Node]:
    """Nodes for the groups, and for what else the edges lead from and to."""
    at = np.array([*depths], np.int64)
    kinds = (KINDS[number - 1] for number in atlas.starts[at].tolist())
    found = dict(zip(depths, map(Node, names(atlas, at), kinds, depths.values()), strict=True))
    for source, _, target, meaning, _ in edges:
        if source not in found:
            found[source] = Node(COMMON, COMMON, depths[target] + 1)
        if target not in found:
            found[target] = Node(f"{target}: {meaning}", ASTRAY, depths[source] + 1)
    return found


def graph(atlas: Atlas, place: int | str, depth: int = 1) -> Listing:
    """The same as a list of pointers. Raises as `neighbourhood` does."""
    found = neighbourhood(atlas, place, depth)

    def order(edge: Edge) -> tuple[int, Edge]:
        return min(found.nodes[end].depth for end in (edge.source, edge.target)), edge

    rows = [
        (found.nodes[edge.source].name, edge.field, edge.meaning) for edge in sorted(found.edges, key=order)
    ]
    return Listing(summary(found), ("from", "field", "to"), rows)


def summary(found: Graph) -> list[str]:
    """What is in a graph, and what is not."""
    first, groups = next(iter(found.nodes.values())), sum(node.kind in KINDS for node in found.nodes.values())
    many = counted(len(found.edges), "pointer")
    lines = [f"{many} between {counted(groups, 'group')} around {first.name}"]
    if found.left_out:
        furthest = max(node.depth for node in found.nodes.values())
        left = counted(found.left_out, "more group")
        lines.append(f"left out: {left} at a distance of {counted(furthest, 'pointer')}, and all beyond")
    return lines


def dot(found: Graph) -> str:
    """A graph in the language of Graphviz."""
    lines = [
        "digraph heap {",
        f'  label="{". ".join(summary(found))}";',
        '  rankdir=LR; node [shape=box, style="rounded,filled", fontname="sans-serif"];',
    ]
    for key, node in found.nodes.items():
        colour = COLOURS.get(node.kind, COLOURS[NOTHING if node.kind == ASTRAY else JUNK])
        lines.append(f'  "{key}" [label="{node.name}", fillcolor="{colour}30", color="{colour}"];')
    for edge in found.edges:
        style = "" if edge.sound else f', color="{COLOURS[NOTHING]}", style=dashed'
        lines.append(f'  "{edge.source}" -> "{edge.target}" [label="{edge.field}"{style}];')
    return "\n".join([*lines, "}", ""])


def telescope(atlas: Atlas, place: int | str, levels: int = LEVELS) -> Listing:
    """The pointers of the group at a place, or the one pointer there, each followed `levels` deep.

    The pointers of a group are listed where it comes first; pointers that are 0 are left out. At most LINES
    lines. IndexError outside IA(), ValueError for no such place, for what has no pointers, or for no level.
    """
    if levels < 1:
        raise ValueError(f"{levels} levels: give the number of pointers to follow, 1 or more")
    address = address_of(atlas, place)
    span, word = atlas.word_at(address)
    if span.kind not in KINDS:
        raise ValueError(f"{address} is in words that are {span.kind}: only groups have pointers")
    one = word if address != span.first or "." in str(place) else None
    if one is not None and not one.field.target:
        raise ValueError(f"{one.name} of {span.name} is no pointer: {one.field.text}")
    rows, listed = list[tuple[Any, ...]](), set() if one else {span.first}
    waiting = [(1, span.first, [one] if one else _pointers_of(atlas, span.first))]
    while waiting and len(rows) <= LINES:
        level, _, words = waiting[-1]
        if not words:
            waiting.pop()
            continue
        here = words.pop(0)
        to = int(atlas.value(here))
        (text,) = leads_to(atlas, str(here.field.target), np.array([to]))
        goes_on = level < levels and to != 0 and atlas.holds(str(here.field.target), to)
        if any(to == above for _, above, _ in waiting):
            text += " (back)"
        elif to in listed:
            text += " (above)"
        elif goes_on:
            listed.add(to)
            waiting.append((level + 1, to, _pointers_of(atlas, to)))
        rows.append((level, here.first, "  " * (level - 1) + here.name, text))
    deep = counted(levels, "level")
    head = [
        f"{called(atlas, span)}: its pointers, {deep} deep",
        "back: to a group on the path; above: to one that is listed",
    ]
    if len(rows) > LINES:
        head.append(f"the first {LINES} lines; fewer levels give fewer")
    return Listing(head, ("level", "address", "pointer", "leads to"), rows[:LINES])


def _pointers_of(atlas: Atlas, group: int) -> list[Word]:
    """The pointers of a group that are not 0."""
    return [word for word in atlas.words(atlas.span(group)) if word.field.target and atlas.value(word)]
