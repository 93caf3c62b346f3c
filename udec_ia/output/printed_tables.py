"""PRINT: every field of every block, corner, contact and domain, and the linked lists as they run.

The columns are the fields of the table of data groups, under their own names, so a new field shows up
here by itself. What describes the rock (who, where, how fast, which force) comes first; the links that
hold the map together follow in a table of their own. No line is wider than 120 columns: a table that
would be is cut into several, one under the other, each beginning with the addresses.

A damaged heap is printed as far as it can be walked, with a line that says where it breaks.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeVar

import numpy as np

from udec_ia.errors import UdecError
from udec_ia.heap.accessors import HEAD, Memory, getr, iget, integers
from udec_ia.kernels.body.fdef import strain_rates
from udec_ia.kernels.constitutive.joint_materials import BY_BLOCKS, JOINTS, MATERIALS, material_of_pair
from udec_ia.kernels.links.longer_groups import contact_of, joint_at
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import Field
from udec_ia.ops.commands.energy_account import Balance, balance
from udec_ia.ops.commands.function_command import followed_names
from udec_ia.ops.commands.joint_property_command import FROM_PEAK, UNITS
from udec_ia.ops.common.listed_groups import list_of
from udec_ia.printable_text import counted
from udec_ia.reader.fracture_rows import CRACKS, cracks_made
from udec_ia.reader.joint_rows import STATES, joint_states
from udec_ia.reader.list_walks import (
    HEADS,
    Unsound,
    boundary,
    can_stand,
    chain,
    corners,
    extension,
    groups,
    kind_of,
    loop,
    members,
    point,
)
from udec_ia.reader.reaction_rows import COLUMNS, reactions
from udec_ia.reader.water_rows import (
    DOMAINS,
    PIPES,
    SOURCES,
    contact_flows,
    domain_water,
    water_account,
    water_balance,
    water_energy,
)
from udec_ia.reader.water_rows import STATES as WATER_STATES
from udec_ia.reader.word_map import TABLE, kind_named
from udec_ia.running.history_series import Series

T = TypeVar("T")
LINE, GAP = 120, "  "
HEAD_NAMES = {head.value: head.name for head in TABLE.heads}
NAMED = ("block", "contact", "corner", "domain", "gridpoint", "zone", "joint", "bolt", "element", "node")
TABLES = {name + "s": name for name in NAMED} | {"boundaries": "bound"}
OF_KIND = {kind: name for name, kind in TABLES.items()} | {"history": "histories"}
NAMES = {"gridpoint": "grid-point", "bound": "boundary condition", "sdef": "simply-deformable extension"}
LISTS = {"list": "block", "dlist": "domain"}
ENERGY, HISTORIES = "energy", "histories"
RESIDUAL = [one.array for one in TABLE.joint_properties if one.argument in FROM_PEAK]
CLOSURES = ("JMKNI", "JMUM1", "JMUM3")  # what follows from the properties of a joint material
RATES = ("e11", "e12", "e22")
CODES = {1: "arc/arc", 2: "arc/edge", 3: "edge/arc", 4: "virtual"}


@dataclass(frozen=True)
class Column:
    """One column of a table: its name, its unit ("" for none) and one text for each row."""

    name: str
    unit: str
    cells: list[str]
    left: bool = False

    @cached_property
    def width(self) -> int:
        return max(map(len, self.lines))

    @property
    def lines(self) -> list[str]:
        """Name, unit and cells, as they stand under each other."""
        return [self.name, self.unit, *self.cells]

    def aligned(self) -> list[str]:
        """The lines at the column's width, numbers to the right."""
        return [line.ljust(self.width) if self.left else line.rjust(self.width) for line in self.lines]


def printout(h: Memory, *what: str, series: Sequence[Series] = ()) -> str:
    """The tables and lists asked for, in the order asked for (PRINT, report I-1). Error 7, 10 or 26.

    what: a kind of groups, "list" (clockwise list of every block), "dlist" (anticlockwise loop of every
    domain), "energy", "histories" (what `series` have recorded), or one of LISTINGS.
    """
    known = ", ".join([*TABLES, *LISTS, ENERGY, HISTORIES, *LISTINGS])
    if not what:
        raise UdecError(7, "PRINT of what?", f"give one or more of {known}")
    parts = [_state(h)]
    for name in (OF_KIND.get(kind_named(one) or one, one) for one in what):
        if name == "joints":
            parts += _joint_materials(h)
        if name in TABLES:
            parts += _group_tables(h, TABLES[name])
            if name == "boundaries" and h.ci[g.IOUPNT]:
                parts += _array_table("Sources and sinks of water", water_balance(h), SOURCES)
            if name == "blocks" and any(iget(h, iad, HEAD) == g.MSDEF for iad in _all(h, "block")):
                parts += _group_tables(h, "sdef")
        elif name in LISTS:
            parts += _lists(h, LISTS[name])
        elif name == ENERGY:
            parts.append(_energy(balance(h)))
        elif name == HISTORIES:
            parts += _histories(series)
        elif name in LISTINGS:
            parts += LISTINGS[name](h)
        else:
            raise UdecError(10, f"PRINT {name}", f"give one or more of {known}")
    return "\n\n".join(parts) + "\n"


def _state(h: Memory) -> str:
    """One line: cycle, time, and the size of the map."""
    virtual = f" ({h.ci[g.NVIRT]} virtual)" if h.ci[g.NVIRT] else ""
    return (
        f"cycle {h.ci[g.MCTOT]}, time {h.cd[g.TIME]:.6g} s: {counted(h.ci[g.NBLK], 'block')}, "
        f"{counted(h.ci[g.NCON], 'contact')}{virtual}, {counted(h.ci[g.NDOM], 'domain')}"
    )


def _greatest(h: Memory) -> list[str]:
    """PRINT MAX: the greatest velocity of a block, forces and overlap of a contact, and their places."""
    lines = ["Greatest"]
    for what, unit, kind, fields, place in (
        ("velocity", "m/s", "block", (g.KXD, g.KYD), (g.KX, g.KY)),
        ("normal force", "N/m", "contact", (g.KCFN,), (g.KXC, g.KYC)),
        ("shear force", "N/m", "contact", (g.KCFS,), (g.KXC, g.KYC)),
        ("overlap", "m", "contact", (g.KCN,), (g.KXC, g.KYC)),
    ):
        at: Any = np.array(list(_all(h, kind)), np.int64)
        if kind == "contact":
            at = at[integers(h, at, g.KCCOD) != g.VIRTUAL]
        if len(at):
            values = [np.asarray(getr(h, at, k), np.float64) for k in fields]
            size = values[0] if what == "overlap" else np.hypot.reduce(np.abs(values))  # a gap is negative
            worst = int(size.argmax())
            x, y = (float(getr(h, int(at[worst]), k)) for k in place)
            lines.append(f"{what:14}{size[worst]:14.6g} {unit:4} {kind}@{at[worst]} at ({x:.6g}, {y:.6g})")
    return ["\n".join(lines)]


def _energy(b: Balance) -> str:
    """PRINT ENERGY: what was put in, what is there, what was lost, and what is not accounted for."""
    lines = [
        ("there at first, and by commands", b.commands),
        ("work of boundary conditions", b.boundary),
        *([("work of water", b.water)] if b.water else []),
        ("kinetic", b.kinetic),
        ("strain of contacts", b.contacts),
        ("strain of deformable blocks", b.blocks),
        *([("strain of structures", b.structures)] if b.structures else []),
        ("gravity, since the account began", b.potential),
        ("lost to friction", b.friction),
        ("lost to mass damping", b.mass_damping),
        ("lost on the way to rest", b.relaxation),
        ("lost to stiffness damping", b.stiffness_damping),
        ("lost to yielding", b.yielding),
        ("lost to changes of shape", b.shape),
        *([("taken by cracks", b.cracks)] if b.cracks else []),
        ("not accounted for", b.residual),
    ]
    table = "\n".join(f"{name:34}{value:14.6g}" for name, value in lines)
    per_cent = 100 * abs(b.residual) / b.throughput if b.throughput else 0.0
    share = f"{per_cent:.2g} % of {b.throughput:.6g} that passed through"
    return f"Energy, in J per m of thickness\n{table} = {share}"


def _histories(series: Sequence[Series]) -> list[str]:
    """PRINT HISTORIES: what is recorded, how many numbers there are, and between which they lie."""
    if not series:
        return ["No histories"]
    heads = ("history", "of", "at", "every", "numbers", "minimum", "maximum", "last", "unit")
    rows = []
    for one in series:
        values = one.numbers[:, 2]
        known = values[~np.isnan(values)]
        ends = [known.min(), known.max()] if len(known) else [np.nan, np.nan]
        what = [f"{one.number}: {one.name}", one.group, one.place, str(one.every), str(len(values))]
        last = values[-1] if len(values) else np.nan
        rows.append([*what, *(f"{value:.6g}" for value in (*ends, last)), one.unit])
    left = (*heads[:3], "unit")
    columns = [
        Column(head, "", list(cells), left=head in left)
        for head, cells in zip(heads, zip(*rows, strict=True), strict=True)
    ]
    return _stacked(f"Histories: {len(series)}", columns[0], columns[1:])


def _reactions(h: Memory) -> list[str]:
    """PRINT REACTIONS: the forces that hold, and their sums with the moment about the origin."""
    rows = reactions(h)
    if not len(rows):
        return ["Nothing is fixed, and nothing has a prescribed velocity"]
    columns = []
    for name, (unit, kind) in COLUMNS.items():
        columns.append(_array_column(name, unit, kind, rows[name]))
    moment = rows["moment"] + rows["x"] * rows["fy"] - rows["y"] * rows["fx"]
    total = (
        f"Sum: fx {rows['fx'].sum():.6g} N/m, fy {rows['fy'].sum():.6g} N/m, "
        f"moment about (0, 0) {moment.sum():.6g} N"
    )
    title = f"Reactions: {len(rows)}, the forces that hold, own weight included"
    return [*_stacked(title, columns[0], columns[1:]), total]


def _functions(h: Memory) -> list[str]:
    """PRINT FUNCTIONS: the functions and sines, and what follows them."""
    signals = list_of(h, "signal").tolist()
    if not signals:
        return ["No functions"]
    followed = integers(h, list_of(h, "bound"), g.KUS)
    heads = "function", "points", "from", "to", "factor", "followed by"
    rows = []
    for isg in signals:
        points = [*chain(h, iget(h, isg, g.KTP), g.KTPN)]
        name, begins = f"FUNCTION {iget(h, isg, g.KTNUM)}", float(getr(h, isg, g.KTBEG))
        ends = [begins, begins + float(getr(h, isg, g.KTLAST))]
        if points:
            ends = [float(getr(h, it, g.KTPT)) for it in (points[0], points[-1])]
        else:
            name = f"sine of {getr(h, isg, g.KTFREQ):.6g} Hz"
        conditions = int((followed == isg).sum())
        used = [counted(conditions, "boundary condition")] if conditions else []
        numbers = (f"{number:.6g}" for number in (*ends, getr(h, isg, g.KTNOW)))
        rows.append([name, str(len(points)), *numbers, ", ".join([*used, *followed_names(h, isg)])])
    columns = [
        Column(head, "s" if head in ("from", "to") else "", list(cells), left=head in (heads[0], heads[-1]))
        for head, cells in zip(heads, zip(*rows, strict=True), strict=True)
    ]
    return _stacked(f"Functions: {len(rows)}", columns[0], columns[1:])


def _water(h: Memory) -> list[str]:
    """PRINT WATER: the fluid, its account, the water in each domain and the flow at each contact."""
    if not h.ci[g.LWATER]:
        return ["No fluid"]
    modes = {code.value: code.name for code in TABLE.codes_of("LFLOW")}
    kw, density, viscosity = (float(h.cr[k]) for k in (g.WKW, g.WDENS, g.WVISC))
    steps = counted(h.ci[g.NFLOW], "step")
    stable = f"{h.cr[g.FDEL]:.4g} s" if h.cr[g.FDEL] else "none, as nothing flows"
    step = f"greatest stable step of flow: {stable}; {steps} in the last pass, whose flows are below"
    fluid = (
        f"Fluid: KW {kw:.6g} Pa, density {density:.6g} kg/m3, viscosity {viscosity:.6g} Pa.s, "
        f"{modes[int(h.ci[g.LFLOW])]}"
    )
    account = ", ".join(f"{what} {value:.6g}" for what, value in water_account(h).items())
    domains, pipes = domain_water(h), contact_flows(h)
    parts = [f"{fluid}\n{step}\nWater (m2): {account}"]
    if h.ci[g.LENER]:
        energy = ", ".join(f"{what} {value:.6g}" for what, value in water_energy(h).items())
        parts.append(f"Energy of the water (J/m): {energy}")
    parts += _array_table("Sources and sinks of water", water_balance(h), SOURCES)
    parts += _array_table(f"Water in domains: {len(domains)}", domains, DOMAINS)
    return parts + _array_table(f"Flow at contacts: {len(pipes)}, from domain one to two", pipes, PIPES)


def _cracks(h: Memory) -> list[str]:
    """PRINT CRACKS: the cracks that runs have made."""
    return _array_table("Cracks made in runs", cracks_made(h), CRACKS)


LISTINGS = {
    "reactions": _reactions,
    "functions": _functions,
    "water": _water,
    "max": _greatest,
    "cracks": _cracks,
}


def _array_table(title: str, rows: Any, units: dict[str, tuple[str, str]]) -> list[str]:
    """A table of a structured array; units: of its columns, with their types."""
    columns = [_array_column(name, unit, kind, rows[name]) for name, (unit, kind) in units.items()]
    return _stacked(title, columns[0], columns[1:]) if len(rows) else [title]


def _array_column(name: str, unit: str, kind: str, values: Any) -> Column:
    """A column of a structured array; states by their names."""
    if name == "state":
        return Column(name, unit, [WATER_STATES[k] for k in values.tolist()], left=True)
    if values.dtype.kind == "U":
        return Column(name, unit, values.tolist(), left=True)
    return Column(name, unit, [f"{v:.6g}" if kind == "f8" else str(v) for v in values.tolist()])


def _joint_materials(h: Memory) -> list[str]:
    """PRINT JOINTS: the joint materials, with those of their properties that are given in one of them."""
    at = np.flatnonzero(h.ci[g.JMLAW : g.JMLAW + MATERIALS])
    if not len(at):
        return []
    models = {code.value: code.name for code in TABLE.codes_of("JMLAW")}
    pairs = zip(h.ci[g.JMB1 + at].tolist(), h.ci[g.JMB2 + at].tolist(), strict=True)
    columns = [
        Column("model", "", [models[n] for n in h.ci[g.JMLAW + at].tolist()], left=True),
        Column("per", "", [UNITS[n] for n in h.ci[g.JMUNIT + at].tolist()], left=True),
        Column("between", "", [f"{i} {j}" if i else "" for i, j in pairs]),
    ]
    fields = {field.name: field for field in TABLE.common}
    names = {one.array: one.keyword.upper() for one in TABLE.joint_properties}
    for array in (*names, *CLOSURES):
        values = h.cr[getattr(g, array) + at]
        given = values >= 0 if array in RESIDUAL else values != 0
        if given.any():
            unit = fields[array].unit.replace("-", "")
            cells = [f"{value:.6g}" if one else "" for value, one in zip(values.tolist(), given, strict=True)]
            columns.append(Column(names.get(array, array), unit, cells))
    first = Column("joint material", "", [str(m + 1) for m in at.tolist()])
    return _stacked(f"Joint materials: {len(at)}", first, columns)


def _until_broken(walk: Iterator[T]) -> tuple[list[T], list[str]]:
    """What can be reached, and the complaint if the walk broke off."""
    reached: list[T] = []
    try:
        for step in walk:
            reached.append(step)
    except Unsound as broken:
        return reached, [f"the heap is damaged here: {broken.detail}"]
    return reached, []


def _all(h: Memory, kind: str) -> Iterator[int]:
    """Addresses of all groups of a kind; corners, grid-points and zones block by block."""
    if kind == "corner":
        for block in groups(h, "block"):
            yield from corners(h, block)
    elif kind in ("gridpoint", "zone"):
        for block in groups(h, "block"):
            yield from members(h, block, kind)
    elif kind == "sdef":
        for block in groups(h, "block"):
            if iget(h, block, HEAD) == g.MSDEF:
                yield extension(h, block)
    elif kind == "joint":
        yield from filter(None, (joint_at(h, ic) for ic in groups(h, "contact")))
    else:
        yield from groups(h, kind)


def _group_tables(h: Memory, kind: str) -> list[str]:
    """The tables of one kind of group: what it describes, then how it is linked."""
    addresses, complaint = _until_broken(_all(h, kind))
    name = NAMES.get(kind, kind)
    if not addresses:
        return [f"No {name}s", *complaint]
    codes = HEADS.get(kind, ())
    described: list[Column] = []
    linked: list[Column] = []
    for field in TABLE.group(kind).fields:
        if field.role == "head":
            types = [HEAD_NAMES.get(iget(h, iad, HEAD), "?") for iad in addresses]
            described += [Column("type", "", types)] if len(codes) > 1 else []
        else:
            column = _field_column(h, addresses, field)
            (described if field.role in ("data", "host") else linked).append(column)
    if kind == "zone":
        described += _strain_rates(h, addresses)
    if kind == "joint":
        described[:0] = _contacts_of_joints(h, addresses)
    code = f", head code {HEAD_NAMES[codes[0]]} = {codes[0]}" if len(codes) == 1 else ""
    address = Column("address", "", [str(iad) for iad in addresses])
    title = f"{name.capitalize()}s: {len(addresses)}{code}"
    return [
        *_stacked(title, address, described),
        *(_stacked(f"{name.capitalize()}s: links", address, linked) if linked else []),
        *complaint,
    ]


def _contacts_of_joints(h: Memory, joints: list[int]) -> list[Column]:
    """Contacts that have a joint material: their places, why they have it, and the states of their joints."""
    contacts = [contact_of(h, ix) for ix in joints]
    places = [field for field in TABLE.group("contact").fields if field.name in ("KXC", "KYC")]
    states = [[*STATES][state] for state in joint_states(h, np.array(joints)).tolist()]
    return [
        Column("contact", "", [str(ic) for ic in contacts]),
        *(_field_column(h, contacts, field) for field in places),
        Column(
            "material by", "", [_rule(h, ic, ix) for ic, ix in zip(contacts, joints, strict=True)], left=True
        ),
        Column("state", "", states, left=True),
    ]


def _rule(h: Memory, ic: int, ix: int) -> str:
    """What gives contact `ic` its joint material (kernels/constitutive/joint_materials.py)."""
    m = iget(h, ix, g.KCJMAT)
    if m == BY_BLOCKS:
        return "INSITU"
    if iget(h, ix, g.KCJFLAG) & g.JOINT_GIVEN:
        return "CHANGE"
    blocks = iget(h, ic, g.KB1), iget(h, ic, g.KB2)
    if not all(can_stand(h, ib, "block") for ib in blocks):
        return "?"
    of_joint = m in h.ci[g.JLINE : g.JLINE + JOINTS]
    of_pair = material_of_pair(h, *(iget(h, ib, g.KMAT) for ib in blocks)) == m
    return "JOINT or BETWEEN" if of_joint and of_pair else "BETWEEN" if of_pair else "JOINT"


def _strain_rates(h: Memory, zones: list[int]) -> list[Column]:
    """Strain rates of zones in the last step, which are not stored but follow from their grid-points."""
    points = set(_until_broken(_all(h, "gridpoint"))[0])
    triples = [{iget(h, iz, g.KZG, i) for i in range(3)} for iz in zones]
    rates = [
        strain_rates(h, iz) if triple <= points else (np.nan,) * 3
        for iz, triple in zip(zones, triples, strict=True)
    ]
    return [Column(name, "1/s", [f"{rate[i]:.6g}" for rate in rates]) for i, name in enumerate(RATES)]


def _field_column(h: Memory, addresses: Sequence[int], field: Field) -> Column:
    offset = getattr(g, field.name)
    at: Any = np.array(addresses, np.int64)
    if field.real:
        cells = [f"{value:.6g}" for value in getr(h, at, offset).tolist()]
    else:
        numbers = [integers(h, at, offset, i).tolist() for i in range(field.count)]
        cells = [" ".join(map(str, row)) for row in zip(*numbers, strict=True)]
    return Column(field.name, "" if field.unit == "-" else field.unit, cells)


def _stacked(title: str, first: Column, columns: list[Column]) -> list[str]:
    """As many tables as it takes to keep within LINE, each with the column `first` on its left."""
    tables: list[list[Column]] = []
    room = 0
    for column in columns:
        if column.width + len(GAP) > room:
            tables.append([first])
            room = LINE - first.width
        tables[-1].append(column)
        room -= column.width + len(GAP)
    return [f"{title}{', continued' if i else ''}\n{_table(table)}" for i, table in enumerate(tables)]


def _table(columns: list[Column]) -> str:
    """Columns side by side under their names and, if any has one, their units."""
    lines = [GAP.join(row).rstrip() for row in zip(*(column.aligned() for column in columns), strict=True)]
    if not lines[1]:
        del lines[1]
    return "\n".join(lines)


def _lists(h: Memory, kind: str) -> list[str]:
    """PRINT List and DList: for each block or domain, what its list passes, in order."""
    owners, complaint = _until_broken(groups(h, kind))
    return [*(_one_list(h, kind, owner) for owner in owners), *complaint]


def _one_list(h: Memory, kind: str, owner: int) -> str:
    """The clockwise list of a block, or the anticlockwise loop of a domain with the blocks it goes along."""
    if kind == "block":
        title = f"block@{owner}: clockwise list"
        items, complaint = _until_broken(boundary(h, owner))
        along = []
    else:
        title = f"domain@{owner}{' (the outer one)' if owner == h.ci[g.IODPNT] else ''}: anticlockwise loop"
        steps, complaint = _until_broken(loop(h, owner))
        items = [item for item, _ in steps]
        along = [Column("along", "", [f"block@{block}" for _, block in steps], left=True)]
    names = Column("item", "", [f"{kind_of(h, item)}@{item}" for item in items], left=True)
    return "\n".join(
        [title, *([_table([names, *along, *_item_columns(h, items)])] if items else []), *complaint]
    )


def _item_columns(h: Memory, items: list[int]) -> list[Column]:
    """OUTCP: the place of each item; of a contact also its blocks, code, corners and domains."""
    rows = []
    for item in items:
        if kind_of(h, item) == "corner":
            place, rest = point(h, item, g.KXP, g.KYP), [""] * 4
        else:
            place = point(h, item, g.KXC, g.KYC)
            pairs = ((g.KB1, g.KB2), (g.KCP1, g.KCP2), (g.KD1, g.KD2))
            rest = [" - ".join(str(iget(h, item, field)) for field in pair) for pair in pairs]
            rest.insert(1, CODES.get(iget(h, item, g.KCCOD), "?"))
        rows.append([*(f"{value:.6g}" for value in place), *rest])
    heads = (("x", "m"), ("y", "m"), ("KB1 - KB2", ""), ("on", ""), ("KCP1 - KCP2", ""), ("KD1 - KD2", ""))
    return [Column(*head, list(cells)) for head, cells in zip(heads, zip(*rows, strict=True), strict=True)]
