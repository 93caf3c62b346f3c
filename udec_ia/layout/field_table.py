"""Read groups.table and lay the groups out for a word scheme.

A word scheme is a pair of word widths, integer and real (report 3.5). All that matters for the
layout is their ratio: the number of integers in the space of one real, 1, 2 or 4. A real must start
at a multiple of its own width, so the layout pads where the 1980 machine did not need to; a group's
size is rounded up for the same reason, which keeps every group address aligned.
"""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Callable, Collection
from dataclasses import dataclass, replace
from functools import cache, cached_property
from pathlib import Path

TABLE = Path(__file__).with_name("groups.table")
SOURCE = Path(__file__).parents[2] / "offsets" / "groups.table"  # an installed program has none
SCHEMES = {  # name: (integer bits, real bits), report 3.5
    "i16r32": (16, 32),
    "i32r32": (32, 32),
    "i16r64": (16, 64),
    "i32r64": (32, 64),
    "i64r64": (64, 64),
}
RATIOS = (1, 2, 4)
GROUP_TYPES = ("int", "real")
EFFECTS = {
    "forces": "the pass kernels/drive/damped_forces.py changes unbalanced forces",
    "before": "it needs the forces of the previous cycle",
    "stiffens": "for motion that reverses in every cycle joints are 1 + f times as stiff",
    "motion": "the pass kernels/drive/kinetic_damping.py evaluates the motion of the model",
    "alpha": "it calculates ALPHA and ALPB",
}
CODES = "codes"  # values of a variable of the common block: those of its CODE lines
COMMON_TYPES = {"int": "NCOMI", "real": "NCOMR", "double": "NCOMD"}  # and the names of their numbers


class TableError(ValueError):
    """A line of the table that cannot be read; the message names file and line."""


class StaleLayout(ImportError):
    """The table at the top of the checkout has changed, and udec_ia/layout has not been made from it yet."""


@dataclass(frozen=True)
class Field:
    """One variable of a data group, or one variable of the common block."""

    name: str
    type: str  # "int", "real" or "double"
    count: int
    target: str | None  # kind of group a pointer points to, "item" for corner-or-contact, None for data
    role: str
    unit: str
    page: str
    text: str
    values: str = "-"  # what it may hold, as the table has it: a kind of group, a range, or "-"
    allowed: tuple[tuple[int, int | None], ...] = ()  # ranges of what it may hold, ends included; () for all
    since: int = 1  # the first layout that has it

    @property
    def real(self) -> bool:
        """True for a field that is no integer."""
        return self.type != "int"

    @property
    def ours(self) -> bool:
        """True for a field that the 1980 program did not have."""
        return self.page == "ours"


@dataclass(frozen=True)
class Group:
    """One kind of data group: its fields in 1980 order.

    behind: the kind of its host, if it lies directly behind each group of that kind and no pointer leads to
    it; else "". flag: the variable of the common block that is 1 in scenes that have it there.
    """

    name: str
    size_name: str
    list_head: str | None
    page: str
    text: str
    fields: tuple[Field, ...]
    behind: str = ""
    flag: str = ""


@dataclass(frozen=True)
class HeadCode:
    """The first integer of a group that says what the group is, and what extends it, "" for nothing."""

    name: str
    value: int
    group: str
    text: str
    extension: str = ""


@dataclass(frozen=True)
class Code:
    """What an integer of the fields `fields` says. flag: it and others of the field add up."""

    name: str
    value: int
    fields: tuple[str, ...]
    text: str
    flag: bool = False


@dataclass(frozen=True)
class Property:
    """A number of a material, of a joint material or of a structural material.

    keyword, value: what it and its number are called in a deck, "" if it is not given, but follows from
    others; argument: by Model.property; name: by laws. array: in the common block.
    """

    keyword: str
    value: str
    argument: str
    name: str
    array: str
    text: str


@dataclass(frozen=True)
class DampingMode:
    """A damping that only leads to rest: a value of LREST, which may hold these and 0.

    keyword: in DAMPING; its upper-case letters must be typed. code: value of LREST. fraction: name of its
    number RESTF, 0 to 1; "" without a number. effects: names of EFFECTS. help: for HELP DAMPING. report: for
    the beginning of a run, with {f} for RESTF.
    """

    keyword: str
    code: int
    fraction: str
    effects: frozenset[str]
    help: str
    report: str

    @property
    def name(self) -> str:
        """The name in messages, and of the code in kernels."""
        return self.keyword.upper()

    @property
    def argument(self) -> str:
        """The argument of Model.damping."""
        return self.keyword.lower()


@dataclass(frozen=True)
class Retired:
    """A name that a field had in the layouts before `until`."""

    name: str
    until: int
    text: str


@dataclass(frozen=True)
class Table:
    """The whole table. `digest` is the SHA-256 of its text: tables with equal digests are the same."""

    groups: tuple[Group, ...]
    heads: tuple[HeadCode, ...]
    codes: tuple[Code, ...]
    common: tuple[Field, ...]
    digest: str
    properties: tuple[Property, ...] = ()  # of materials
    joint_properties: tuple[Property, ...] = ()  # of joint materials
    structural_properties: tuple[Property, ...] = ()  # of structural materials
    retired: tuple[Retired, ...] = ()
    layout: int = 1  # number of the layout
    damping: tuple[DampingMode, ...] = ()

    def group(self, name: str) -> Group:
        """The group called `name` (block, corner, contact, domain, sdef, zone, gridpoint, jointext)."""
        return self._by_name[name]

    @cached_property
    def flags(self) -> tuple[str, ...]:
        """Variables of the common block that are 1 in scenes in which groups lie behind others."""
        return tuple(dict.fromkeys(group.flag for group in self.groups if group.flag))

    def behind(self, value_of: Callable[[str], int]) -> dict[str, str]:
        """The kind of group that lies behind each group of a kind, hosts first.

        value_of: value of a flag in this scene.
        """
        return {group.behind: group.name for group in self.groups if group.flag and value_of(group.flag)}

    @cached_property
    def rows(self) -> list[tuple[str, ...]]:
        """Kinds that can lie one behind the other: two or more, from the first on."""
        behind, found = self.behind(lambda _: 1), []
        for kind in behind:
            if not self.group(kind).behind:
                row = [kind]
                while row[-1] in behind:
                    row.append(behind[row[-1]])
                    found.append(tuple(row))
        return found

    @cached_property
    def shape(self) -> str:
        """SHA-256 of all that decides where a number lies: tables of one shape have the same layout."""
        sizes = [(f.name, f.type, f.count) for f in self.common]
        groups = [
            (
                one.name + one.behind + one.flag,
                one.size_name,
                *((f.name, f.type, f.count) for f in one.fields),
            )
            for one in self.groups
        ]
        return hashlib.sha256(repr((groups, sizes)).encode()).hexdigest()

    @property
    def fields(self) -> list[Field]:
        """All fields: those of the common block, and those of all groups."""
        return [*self.common, *(field for group in self.groups for field in group.fields)]

    @cached_property
    def common_reals(self) -> list[tuple[Field, int]]:
        """The reals of the common block in order, by the index that a follower holds: field and element."""
        return [(one, i) for one in self.common if one.type == "real" for i in range(one.count)]

    def codes_of(self, field: str) -> tuple[Code, ...]:
        """The codes and flags of the field of that name."""
        return tuple(code for code in self.codes if field in code.fields)

    @cached_property
    def _by_name(self) -> dict[str, Group]:
        return {group.name: group for group in self.groups}


@dataclass(frozen=True)
class Layout:
    """Offsets of one group for one ratio: `offset[name]` as in Appendix IV-2, and the group's size.

    An integer's offset counts integer words from 0; a real's counts reals from 1.
    """

    offset: dict[str, int]
    size: int
    used: int  # words before the size is rounded up


@cache
def read_table() -> Table:
    """The table of this program, from the file beside this module; read once. Raises TableError."""
    return parse(TABLE.read_text())


def require_current(digest: str) -> None:
    """StaleLayout if `digest` is not that of the table in the checkout, and of the program's own."""
    for path in (SOURCE, TABLE):
        if path.exists() and hashlib.sha256(path.read_bytes()).hexdigest() != digest:
            raise StaleLayout(f"{path} has changed since udec_ia/layout was made: run python -m offsets")


def parse(text: str) -> Table:
    """Parse a table, which may be that of another version. Raises TableError."""
    groups: list[Group] = []
    heads: list[HeadCode] = []
    codes: list[Code] = []
    common: list[Field] = []
    retired: list[Retired] = []
    properties: dict[str, list[Property]] = {"PROPERTY": [], "JPROPERTY": [], "SPROPERTY": []}
    damping: list[DampingMode] = []
    layout = 1
    fields: list[Field] | None = None
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        try:
            if line.startswith("LAYOUT"):
                layout = int(line.split()[1])
                continue
            left, doc = (part.strip() for part in line.split("|", 1))
            words = left.split()
            if words[0] == "RETIRED":
                retired.append(Retired(words[1], int(words[2]), doc))
            elif words[0] in properties:
                properties[words[0]].append(_property(words, doc))
            elif words[0] == "DAMPING":
                damping.append(_damping_mode(words, doc))
                codes.append(Code(damping[-1].name, damping[-1].code, ("LREST",), damping[-1].help))
            elif words[0] == "GROUP":
                fields = []
                groups.append(_group(words, doc))
            elif words[0] == "COMMON":
                fields = common
            elif words[0] == "HEAD" and words[2].isdigit():
                group, _, extension = words[3].partition("/")
                heads.append(HeadCode(words[1], int(words[2]), group, doc, extension))
            elif words[0] in ("CODE", "FLAG"):
                codes.append(_code(words, doc))
            elif fields is None:
                raise ValueError("a field stands before the first GROUP")
            else:
                in_group = fields is not common
                fields.append(_field(words, doc, GROUP_TYPES if in_group else COMMON_TYPES))
                if in_group:
                    groups[-1] = replace(groups[-1], fields=tuple(fields))
        except (ValueError, IndexError) as error:
            raise TableError(f"groups.table:{number}: {line.strip()!r}: {error}") from error
    common = [_values_of_codes(field, codes) for field in common]
    _check_names(groups, codes, common, retired)
    arrays = {field.name for field in common if field.real}
    of_blocks, of_joints, of_structures = (tuple(one) for one in properties.values())
    if lost := [one.name for one in of_blocks + of_joints + of_structures if one.array not in arrays]:
        raise TableError(f"groups.table: there is no array for the property {', '.join(lost)}")
    digest = hashlib.sha256(text.encode()).hexdigest()
    parts = tuple(groups), tuple(heads), tuple(codes), tuple(common)
    return Table(*parts, digest, of_blocks, of_joints, of_structures, tuple(retired), layout, tuple(damping))


def _property(words: list[str], doc: str) -> Property:
    _, keyword, value, argument, name, array = (word.strip("-") for word in words)
    return Property(keyword, value, argument, name, array, doc)


def _group(words: list[str], doc: str) -> Group:
    _, name, size_name, list_head, page = words
    if list_head[0] == "+":
        host, flag = list_head[1:].split("/")
        return Group(name, size_name, None, page, doc, (), host, flag)
    return Group(name, size_name, None if list_head == "-" else list_head, page, doc, ())


def _code(words: list[str], doc: str) -> Code:
    word, name, value, fields = words
    if word == "FLAG" and int(value).bit_count() != 1:
        raise ValueError("the number of a flag is 1, 2, 4, 8, ...")
    return Code(name, int(value), tuple(fields.split(",")), doc, word == "FLAG")


def _damping_mode(words: list[str], doc: str) -> DampingMode:
    _, keyword, code, fraction, effects = words
    found = frozenset(effects.split(","))
    if unknown := found - {*EFFECTS}:
        raise ValueError(f"a damping mode has the effects {', '.join(EFFECTS)}, not {', '.join(unknown)}")
    text, report = (part.strip() for part in doc.split("|"))
    return DampingMode(keyword, int(code), fraction.strip("-"), found, text, report)


def _values_of_codes(field: Field, codes: list[Code]) -> Field:
    """The field, which may hold its codes and nothing else if its values are "codes"."""
    if field.values != CODES:
        return field
    values = ",".join(str(code.value) for code in codes if field.name in code.fields)
    if not values:
        raise TableError(f"groups.table: there is no code for the field {field.name}")
    return replace(field, values=values, allowed=_ranges(values))


def _check_names(groups: list[Group], codes: list[Code], common: list[Field], retired: list[Retired]) -> None:
    """TableError if two fields or codes have one name, or a code has no field: offsets.py has them all.

    A retired name is not used again: a restart file of before holds it with another meaning.
    """
    names = [field.name for group in groups for field in group.fields if field.role != "head"]
    names += [field.name for field in common]
    lost = [code.name for code in codes if not {*code.fields} <= {*names}]
    if lost:
        raise TableError(f"groups.table: there is no field for the code {', '.join(lost)}")
    names += [code.name for code in codes] + [one.name for one in retired]
    double = {name for name, times in Counter(names).items() if times > 1}
    if double:
        raise TableError(
            f"groups.table: two fields, codes or retired names are called {', '.join(sorted(double))}"
        )


def _field(words: list[str], doc: str, types: Collection[str]) -> Field:
    name, kind, values, role, unit, page = words
    base, _, count = kind.partition("*")
    if base not in types:
        raise ValueError(f"type {base!r} is none of {', '.join(types)}")
    target = values.rstrip("!") if values[0].isalpha() and values != CODES else None
    if target is not None:
        allowed = _ranges("1.." if values.endswith("!") else "0..")
    else:
        allowed = () if values in ("-", CODES) else _ranges(values)
    if int(count or 1) < 1:
        raise ValueError(f"there are {count} of it")
    page, _, since = page.partition("/")
    if page != "ours" and (since or not page.isdigit()):
        raise ValueError(f"{page!r} is neither a page of the report nor ours")
    return Field(name, base, int(count or 1), target, role, unit, page, doc, values, allowed, int(since or 1))


def _ranges(text: str) -> tuple[tuple[int, int | None], ...]:
    """((0, 2), (4, 4), (6, None)) for "0..2,4,6.."; None for no upper end."""
    found: list[tuple[int, int | None]] = []
    for part in text.split(","):
        low, dots, high = part.partition("..")
        found.append((int(low), int(high) if high else None if dots else int(low)))
    return tuple(found)


def lay_out(group: Group, ratio: int) -> Layout:
    """Offsets and size of `group` where one real takes the space of `ratio` integers."""
    offset: dict[str, int] = {}
    word = 0
    for field in group.fields:
        if field.real:
            word = -(-word // ratio) * ratio
            offset[field.name] = word // ratio + 1
            word += field.count * ratio
        else:
            offset[field.name] = word
            word += field.count
    return Layout(offset, -(-word // ratio) * ratio, word)


@cache
def layouts(ratio: int) -> dict[str, Layout]:
    """The layout of every group of this program's table, by name, where a real takes `ratio` integers."""
    return {group.name: lay_out(group, ratio) for group in read_table().groups}
