"""Lists of blocks, loops of domains, Euler's formula and the outer domain: invariants 3, 4 and 5.

Every contact can be passed in two ways: from the list of KB1 to that of KB2, and back. To go on along a block
to its next contact and to change the block there is a permutation of these passages. Its cycles are the faces
of the map, and each must be the loop of one domain. A domain is on the left of its loop, so only the outer
domain has a negative area. The loop passes a virtual contact in both directions, so each block's part counts
as if it closed at the item before the contact. Areas are not checked after an error that let blocks penetrate
each other.
"""

from __future__ import annotations

from collections import Counter

import numpy as np

from udec_ia.checker.checked_state import State, corner_before
from udec_ia.compiling.interpreted_kernels import InterpretWhenSmall
from udec_ia.errors import DISORDERED
from udec_ia.kernels.audit.domain_faces import label_cycles, label_pieces, link_passages, sum_areas
from udec_ia.layout import offsets as g
from udec_ia.printable_text import counted
from udec_ia.reader.field_reading import HOSTS, INDEX, KR, TABLE, Numbers, names
from udec_ia.reader.list_walks import clockwise_link

PASSAGES = InterpretWhenSmall(link_passages, 1.7e6)  # items
CYCLES = InterpretWhenSmall(label_cycles, 3e6)  # passages
PIECES = InterpretWhenSmall(label_pieces, 6e5)  # contacts
KNB, *_ = names("corner", "host")
KLB, *_ = names("corner", "clockback")
BACK = names("contact", "clockback")[:2]
SIDES = names("contact", "loop")[:2]
AHEAD = names("contact", "associate")[:2]
KDLOOP, *_ = names("domain", "loop")


def check_map(state: State) -> None:
    """Invariants 3, 4 and 5."""
    _check_corners(state)
    _check_items(state)
    _check_contacts(state)
    _check_virtual(state)
    _check_loops(state)
    _check_counts(state)
    _check_connected(state)


def _check_corners(state: State) -> None:
    """Every block has at least three corners."""
    rings = state.rings
    corners = np.bincount(rings.owner[~rings.contact], minlength=len(rings.block))
    for k in np.flatnonzero(corners < 3):
        state.report(3, f"block@{rings.block[k]} has {counted(corners[k], 'corner')}")


def _check_items(state: State) -> None:
    """Corners name their block and the one before; links back mirror the list; contacts know their corner."""
    rings, corner = state.rings, ~state.rings.contact
    one, two = rings.contact & (rings.side == 0), rings.contact & (rings.side == 1)
    block, back, ahead = rings.block[rings.owner], rings.item[rings.before], rings.item[rings.corner]
    previous = np.zeros_like(rings.item)
    previous[corner] = rings.item[corner_before(rings)]
    fields = (KNB, KR, KLB, *AHEAD, *BACK)
    of_corners = (corner, block), (corner, previous), (corner, back)
    of_contacts = (one, ahead), (two, ahead), (one, back), (two, back)
    wrong = []
    for which, (where, wanted) in enumerate(of_corners + of_contacts):
        at = np.flatnonzero(where)
        stored = state.read(rings.item[at], fields[which])
        for row in np.flatnonzero(stored != wanted[at]).tolist():
            k = int(at[row])
            wrong.append((k, which, int(stored[row]), int(wanted[k])))
    for k, which, value, right in sorted(wrong):
        item, host, name = rings.item[k], int(block[k]), fields[which]
        what = f"{name} of {'contact' if rings.contact[k] else 'corner'}@{item} is {value}"
        if name == KNB:
            why = f"the corner is in the list of block@{host}"
        elif name == KR:
            why = f"clockwise corner@{right} precedes it"
        elif name in AHEAD:
            why = f"the first corner after it on block@{host} is {right}"
        else:
            link, _ = clockwise_link(state.h, host, right)
            why = f"{link} leads to it, on block@{host}"
        state.report(3, f"{what}, but {why}")


def _check_contacts(state: State) -> None:
    """Invariant 4: each contact is in the lists of both its blocks and in the contact list."""
    rings, contacts = state.rings, state.address["contact"]
    one, two = (state.column("contact", name) for name in HOSTS)
    for k in np.flatnonzero(one == two):
        state.report(4, f"contact@{contacts[k]} names block@{one[k]} in {HOSTS[0]} and in {HOSTS[1]}")
    for name, block, at in zip(HOSTS, (one, two), rings.at, strict=True):
        out = np.flatnonzero((at < 0) & (one != two))
        for k in out[np.isin(block[out], rings.block)] if len(out) else out:
            text = f"contact@{contacts[k]} names block@{block[k]} in {name}"
            state.report(4, f"{text}, but is not in the block's list")
    for i in np.flatnonzero(rings.contact & (rings.row < 0)):
        text = f"contact@{rings.item[i]} is in the list of block@{rings.block[rings.owner[i]]}"
        state.report(4, f"{text}, but not in the contact list")


def _check_virtual(state: State) -> None:
    """Invariants 4 and 9: a virtual contact is a bridge of the map and carries no force."""
    virtual = state.column("contact", "KCCOD") == g.VIRTUAL
    left, right = (state.column("contact", side) for side in SIDES)
    why = "but the contact is virtual"
    bridge = virtual & (left != right)
    state.report_rows(4, "contact", SIDES[0], bridge, lambda k: f"{why}, and {SIDES[1]} is {right[k]}")
    for name in ("KCFN", "KCFS"):
        state.report_rows(9, "contact", name, virtual & (state.column("contact", name) != 0), lambda _: why)


def _passages(state: State) -> Numbers:
    """For each passage the next one around its domain; the last stands for blocks whose list is broken.

    Passage 2 row + side is that of the contact in `row` after which block KB1 (side 0) or KB2 (side 1) is
    walked.
    """
    rings = state.rings
    nowhere = 2 * len(state.address["contact"])
    following = np.full(nowhere + 1, nowhere)
    PASSAGES(len(rings.item), rings.lists, rings.contact, rings.row, rings.side, following)
    return following


def _check_loops(state: State) -> None:
    """Invariant 4: each closed loop is labelled by one domain all around, each domain has one loop."""
    following = _passages(state)
    of_loop = np.empty_like(following)
    CYCLES(len(following), following, of_loop)
    of_loop = of_loop[:-1]
    stands = state.rings.at.T.ravel() >= 0
    closed = stands & (of_loop >= 0)
    whole = len(state.rings.block) == len(state.address["block"]) and bool((closed == stands).all())
    label = np.column_stack([state.column("contact", side) for side in SIDES[::-1]]).ravel()
    starts = np.flatnonzero(of_loop == np.arange(len(of_loop)))
    for start in np.unique(of_loop[closed][label[closed] != label[of_loop[closed]]]):
        label[start] = _label(state, following, label, int(start))
    order = starts[np.argsort(label[starts], kind="stable")]
    contact = state.address["contact"]
    for k in np.flatnonzero(label[order[1:]] == label[order[:-1]]):
        before, start = order[k], order[k + 1]
        two = f"through contact@{contact[start // 2]} and through contact@{contact[before // 2]}"
        state.report(4, f"the loops {two} both name domain@{label[start]}")
    _check_domains(state, label[starts], whole)


def _label(state: State, following: Numbers, label: Numbers, start: int) -> int:
    """The domain that most passages of a loop name, and a violation for each that does not."""
    loop = [start]
    while following[loop[-1]] != start:
        loop.append(int(following[loop[-1]]))
    labels = label[loop].tolist()
    domain = Counter(labels).most_common(1)[0][0]
    for passage, named in zip(loop, labels, strict=True):
        if named != domain:
            text = f"{SIDES[1 - passage % 2]} of contact@{state.address['contact'][passage // 2]} is {named}"
            state.report(4, f"{text}, but the contact stands on the loop of domain@{domain}")
    return int(domain)


def _check_domains(state: State, with_loop: Numbers, whole: bool) -> None:
    """Each domain knows a contact of its loop, and has one."""
    domains, contact = state.address["domain"], state.column("domain", KDLOOP)
    if not len(state.address["contact"]):
        state.report_rows(4, "domain", KDLOOP, contact != 0, lambda _: "but there are no contacts")
        return
    row = state.rows("contact", contact)
    beside = [state.column("contact", side)[row] == domains for side in SIDES]

    def why(k: int) -> str:
        return "which is no contact in use" if row[k] < 0 else "a contact that does not stand on its loop"

    state.report_rows(4, "domain", KDLOOP, (row < 0) | ~np.any(beside, axis=0), why)
    if whole:
        for domain in domains[~np.isin(domains, with_loop)]:
            state.report(4, f"no loop of contacts belongs to domain@{domain}")


def _check_counts(state: State) -> None:
    """Invariant 5: blocks - contacts + domains = 2, and the counts of the common block are true."""
    blocks, contacts, domains = (len(state.address[kind]) for kind in ("block", "contact", "domain"))
    if blocks and blocks - contacts + domains != 2:
        state.report(5, f"{blocks} blocks - {contacts} contacts + {domains} domains is not 2")
    if not blocks and contacts + domains:
        others = f"{counted(contacts, 'contact')} and {counted(domains, 'domain')}"
        state.report(5, f"there are no blocks, but {others}")
    virtual = int(np.count_nonzero(state.column("contact", "KCCOD") == g.VIRTUAL))
    soft = int(np.count_nonzero(state.h.ia[state.address["block"] - 1] != g.MRIG))
    counts = {"NBLK": blocks, "NCON": contacts, "NDOM": domains, "NVIRT": virtual, "NSOFT": soft}
    for name, count in counts.items():
        if state.common(name) != count:
            text = next(field.text for field in TABLE.common if field.name == name)
            state.report(5, f"{name}, the {text}, is {state.common(name)}, but counting gives {count}")


def _check_connected(state: State) -> None:
    """Invariant 5: from any block every other one is reached over contacts, real or virtual."""
    blocks = state.address["block"]
    one, two = (state.rows("block", state.column("contact", name)) for name in HOSTS)
    smallest = np.empty(len(blocks), INDEX)
    PIECES(len(one), one, two, smallest)
    for block in blocks[smallest != 0]:
        state.report(5, f"no chain of contacts leads from block@{blocks[0]} to block@{block}")


AREAS = InterpretWhenSmall(sum_areas, 9e5)  # items


def check_outer(state: State) -> None:
    """Invariant 4, if every list is closed and all places are numbers."""
    rings, domains = state.rings, state.address["domain"]
    if state.common("NSPOIL") in DISORDERED:
        return
    if len(rings.block) < len(state.address["block"]) or len(domains) < 2:
        return
    if not len(rings.item) or (rings.row < 0).any() or (rings.at < 0).any():  # a block's part is missing
        return
    corner, contact = ([state.offset[name] for name in names] for names in (("KXP", "KYP"), ("KXC", "KYC")))
    base = (rings.item - 1) // state.ratio - 1
    places = state.h.ra[base[:, None] + np.where(rings.contact[:, None], contact, corner)].astype(float)
    places -= places[0].copy()  # of the first item, a corner
    virtual = state.column("contact", "KCCOD") == g.VIRTUAL
    named = np.array([state.rows("domain", state.column("contact", side)) for side in SIDES])
    twice = np.zeros(len(domains))
    of_lists = rings.lists, rings.contact, rings.row, rings.side
    if not AREAS(len(rings.item), *of_lists, virtual, named, places, twice):
        return
    outer, lowest = state.common("IODPNT"), int(twice.argmin())
    if outer != domains[lowest]:
        state.report(4, f"IODPNT is {outer}, but domain@{domains[lowest]} lies around all blocks")
