"""Invariants 3, 4 and 5: the lists of the blocks, the loops of the domains, Euler's formula.

Every contact stands in the lists of two blocks, so it can be passed in two ways: having come along the
list of KB1 one goes on along KB2, and the other way round. To go on along a block to its next contact and
to change the block there is a permutation of these passages; its cycles are the faces of the map. Each
must be the loop of one domain.
"""

from __future__ import annotations

from collections import Counter

import numpy as np

from udec_ia.inspect.check_groups import FORWARD, HOSTS, KL, KR, TABLE, State, names
from udec_ia.kernels.touch import VIRTUAL

(KNB,) = names("corner", "host")
(KLB,) = names("corner", "clockback")
BACK = names("contact", "clockback")
SIDES = names("contact", "loop")
AHEAD = names("contact", "associate")
(KDLOOP,) = names("domain", "loop")

Passage = tuple[int, int]  # a contact, and the block that is walked after it


def check_map(state: State) -> None:
    """Invariants 3, 4 and 5."""
    for block, ring in state.rings.items():
        _check_corners(state, block, ring)
        _check_items(state, block, ring)
    _check_contacts(state)
    _check_virtual(state)
    _check_loops(state)
    _check_counts(state)
    _check_connected(state)


def _check_corners(state: State, block: int, ring: list[int]) -> None:
    """Corners name their block, and the reverse list is the clockwise list read backwards."""
    corners = [iad for iad in ring if not state.is_contact[iad]]
    if len(corners) < 3:
        state.report(3, f"block@{block} has {len(corners)} corners")
    for corner, before in zip(corners, [corners[-1], *corners[:-1]], strict=True):
        if state.get(corner, KNB) != block:
            state.report(
                3,
                f"{KNB} of corner@{corner} is {state.get(corner, KNB)}, "
                f"but the corner stands in the list of block@{block}",
            )
        if state.get(corner, KR) != before:
            state.report(
                3,
                f"{KR} of corner@{corner} is {state.get(corner, KR)}, "
                f"but clockwise corner@{before} precedes it",
            )


def _check_items(state: State, block: int, ring: list[int]) -> None:
    """Links back mirror the list, and each contact knows the first corner after it."""
    corner = ring[0]
    for i in range(len(ring) - 1, -1, -1):
        iad, before = ring[i], ring[i - 1]
        if not state.is_contact[iad]:
            corner, back, name = iad, KLB, f"corner@{iad}"
        else:
            side = state.hosts(iad).index(block)
            back, name = BACK[side], f"contact@{iad}"
            if state.get(iad, AHEAD[side]) != corner:
                state.report(
                    3,
                    f"{AHEAD[side]} of {name} is {state.get(iad, AHEAD[side])}, "
                    f"but the first corner after it on block@{block} is {corner}",
                )
        if state.get(iad, back) != before:
            state.report(
                3,
                f"{back} of {name} is {state.get(iad, back)}, but {_link(state, block, before)} leads to it, "
                f"on block@{block}",
            )


def _link(state: State, block: int, iad: int) -> str:
    """The clockwise link of the item at `iad` on `block`, in words."""
    if not state.is_contact[iad]:
        return f"{KL} of corner@{iad}"
    return f"{FORWARD[state.hosts(iad).index(block)]} of contact@{iad}"


def _check_contacts(state: State) -> None:
    """Invariant 4: each contact stands in the lists of both its blocks and in the contact list."""
    standing = {(iad, block) for block, ring in state.rings.items() for iad in ring}
    listed = set(state.address["contact"].tolist())
    for contact in listed:
        blocks = state.hosts(contact)
        if blocks[0] == blocks[1]:
            state.report(4, f"contact@{contact} names block@{blocks[0]} in {HOSTS[0]} and in {HOSTS[1]}")
        for name, block in zip(HOSTS, blocks, strict=True):
            if block in state.rings and (contact, block) not in standing:
                state.report(
                    4, f"contact@{contact} names block@{block} in {name}, but stands not in the block's list"
                )
    for iad, block in standing:
        if iad not in listed and state.is_contact[iad]:
            state.report(4, f"contact@{iad} stands in the list of block@{block}, but not in the contact list")


def _check_virtual(state: State) -> None:
    """Invariants 4 and 9: a virtual contact is a bridge of the map and carries no force."""
    virtual = state.column("contact", "KCCOD") == VIRTUAL
    left, right = (state.column("contact", side) for side in SIDES)
    for row in np.flatnonzero(virtual & (left != right)):
        contact = state.address["contact"][row]
        state.report(
            4,
            f"contact@{contact} is virtual, but no bridge: "
            f"{SIDES[0]} is {left[row]}, {SIDES[1]} is {right[row]}",
        )
    for name in ("KCFN", "KCFS"):
        force = state.column("contact", name)
        for row in np.flatnonzero(virtual & (force != 0)):
            contact = state.address["contact"][row]
            state.report(9, f"contact@{contact} is virtual, but {name} is {force[row]}")


def _passages(state: State) -> dict[Passage, Passage]:
    """For each passage the next one around its domain."""
    following: dict[Passage, Passage] = {}
    for block, ring in state.rings.items():
        contacts = [iad for iad in ring if state.is_contact[iad]]
        for contact, after in zip(contacts, [*contacts[1:], *contacts[:1]], strict=True):
            one, two = state.hosts(after)
            following[contact, block] = (after, two if one == block else one)
    return following


def _side(state: State, passage: Passage) -> str:
    """The field that names the domain of a passage: going on along KB2, one came along KB1 and is in KD1."""
    contact, block = passage
    return SIDES[1 - state.hosts(contact).index(block)]


def _check_loops(state: State) -> None:
    """Invariant 4: each closed loop is labelled by one domain all around, each domain has one loop."""
    following = _passages(state)
    whole = len(state.rings) == len(state.address["block"])
    loops: dict[int, Passage] = {}
    seen: set[Passage] = set()
    for start in following:
        if start in seen:
            continue
        loop, here = [], start
        while here in following and here not in seen:
            seen.add(here)
            loop.append(here)
            here = following[here]
        if here != start:
            whole = False  # it leads on to a block whose list is broken
            continue
        domain = _label(state, loop)
        if domain in loops:
            state.report(
                4,
                f"the loop through contact@{start[0]} and the loop through contact@{loops[domain][0]} "
                f"both name domain@{domain}",
            )
        loops[domain] = start
    _check_domains(state, loops, whole)


def _label(state: State, loop: list[Passage]) -> int:
    """The domain that most passages of `loop` name, and a violation for each that does not."""
    labels = [state.get(passage[0], _side(state, passage)) for passage in loop]
    domain = Counter(labels).most_common(1)[0][0]
    for passage, label in zip(loop, labels, strict=True):
        if label != domain:
            state.report(
                4,
                f"{_side(state, passage)} of contact@{passage[0]} is {label}, "
                f"but the contact stands on the loop of domain@{domain}",
            )
    return domain


def _check_domains(state: State, loops: dict[int, Passage], whole: bool) -> None:
    listed = set(state.address["contact"].tolist())
    for domain in state.address["domain"].tolist():
        contact = state.get(domain, KDLOOP)
        if not listed:
            if contact != 0:
                state.report(4, f"{KDLOOP} of domain@{domain} is {contact}, but there are no contacts")
        elif contact not in listed:
            state.report(4, f"{KDLOOP} of domain@{domain} is {contact}, which is no contact in use")
        elif domain not in [state.get(contact, side) for side in SIDES]:
            state.report(
                4, f"{KDLOOP} of domain@{domain} is contact@{contact}, which does not stand on its loop"
            )
        if listed and whole and domain not in loops:
            state.report(4, f"no loop of contacts is that of domain@{domain}")


def _check_counts(state: State) -> None:
    """Invariant 5: blocks - contacts + domains = 2, and the counts of the common block are true."""
    blocks, contacts, domains = (len(state.address[kind]) for kind in ("block", "contact", "domain"))
    if blocks and blocks - contacts + domains != 2:
        state.report(5, f"{blocks} blocks - {contacts} contacts + {domains} domains is not 2")
    if not blocks and contacts + domains:
        state.report(5, f"there are no blocks, but {contacts} contacts and {domains} domains")
    virtual = int(np.count_nonzero(state.column("contact", "KCCOD") == VIRTUAL))
    counts = {"NBLK": blocks, "NCON": contacts, "NDOM": domains, "NVIRT": virtual}
    for name, count in counts.items():
        if state.common(name) != count:
            text = next(field.text for field in TABLE.common if field.name == name)
            state.report(5, f"{name}, the {text}, is {state.common(name)}, but there are {count}")


def _check_connected(state: State) -> None:
    """Invariant 5: from any block every other one is reached over contacts, real or virtual."""
    blocks = state.address["block"].tolist()
    beside: dict[int, list[int]] = {block: [] for block in blocks}
    for contact in state.address["contact"].tolist():
        one, two = state.hosts(contact)
        if one in beside and two in beside:
            beside[one].append(two)
            beside[two].append(one)
    reached = set(blocks[:1])
    front = blocks[:1]
    while front:
        front = [block for here in front for block in beside[here] if block not in reached]
        front = list(dict.fromkeys(front))
        reached.update(front)
    for block in blocks:
        if block not in reached:
            state.report(5, f"no chain of contacts leads from block@{blocks[0]} to block@{block}")


def neighbours(state: State, skipped: set[int]) -> list[tuple[int, int, int]]:
    """(block, contact, next contact) for contacts with no corner between them, `skipped` ones left out."""
    close = []
    for block, ring in state.rings.items():
        before = 0
        for iad in ring:
            if not state.is_contact[iad]:
                before = 0
            elif iad not in skipped:
                if before:
                    close.append((block, before, iad))
                before = iad
    return close
