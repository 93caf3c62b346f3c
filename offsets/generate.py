"""Write what follows from groups.table: `udec_ia/layout`, and the tables of offsets that a person reads.

`udec_ia/layout/offsets.py` gives every offset as a tuple (for 1, 2 and 4 integers to a real); the accessors
pick the element by the array types at hand, so one kernel source serves all word schemes.
"""

from __future__ import annotations

from pathlib import Path

from udec_ia.layout.field_table import COMMON_TYPES, RATIOS, SCHEMES, Group, Table, TableError, lay_out, parse

HERE = Path(__file__).parent
TABLE = HERE / "groups.table"
LAYOUTS = HERE / "layouts.txt"
NAMES = HERE / "names.txt"
DRAFT = "draft"  # of a layout that no release has
LAYOUT = HERE.parent / "udec_ia" / "layout"
BANNER = "AUTO-GENERATED from offsets/groups.table by `python -m offsets`; do not edit."


def python_text(table: Table) -> str:
    """The text of udec_ia/layout/offsets.py."""
    lines = [
        f'"""{BANNER}',
        "",
        "Offsets and sizes are tuples: for 1, 2 and 4 integers to a real.",
        '"""',
        "",
    ]
    lines += ["from udec_ia.layout.field_table import require_current", ""]
    lines += [f'DIGEST = "{table.digest}"', "require_current(DIGEST)", ""]
    lines += [f"{head.name} = {head.value}  # {head.text}" for head in table.heads]
    lines.append("")
    lines += [f"{one.name} = {one.value}  # {' and '.join(one.fields)}: {one.text}" for one in table.codes]
    for group in table.groups:
        layouts = [lay_out(group, ratio) for ratio in RATIOS]
        lines += ["", f"# {group.text} (page {group.page})"]
        for field in group.fields:
            if field.role == "head":
                continue
            values = ", ".join(str(layout.offset[field.name]) for layout in layouts)
            kind = field.type
            if field.values not in ("-", field.target):
                kind += f" {field.values}"
            lines.append(f"{field.name} = ({values})  # {kind}: {field.text}")
        lines.append(f"{group.size_name} = ({', '.join(str(layout.size) for layout in layouts)})")
    for kind, number in COMMON_TYPES.items():
        lines += ["", f"# The common block, type {kind}: index of the variable, or of its first element"]
        index = 0
        for field in table.common:
            if field.type == kind:
                lines.append(f"{field.name} = {index}  # {field.text}")
                index += field.count
        lines.append(f"{number} = {index}")
    return "\n".join(lines) + "\n"


MATERIAL = '''"""{banner}"""

from __future__ import annotations

from typing import NamedTuple, TypedDict

from udec_ia.layout import offsets as g


class Material(NamedTuple):
    """The material that a law is called with: the numbers of PROPERTY. Frictions are tangents."""

{fields}


class Properties(TypedDict, total=False):
    """What PROPERTY sets."""

{given}


class JointMaterial(NamedTuple):
    """The joint material that a joint model is called with: the numbers of JPROPERTY."""

{joint_fields}


class JointProperties(TypedDict, total=False):
    """What JPROPERTY sets."""

{joint_given}


class StructuralProperties(TypedDict, total=False):
    """What SPROPERTY sets."""

{structural_given}


# Where the fields of Material and of JointMaterial stand in the common block, for number 1.
ARRAYS = (
{arrays}
)
JOINT_ARRAYS = (
{joint_arrays}
)
'''


def material_text(table: Table) -> str:
    """The text of udec_ia/layout/material.py."""
    units = {field.name: f", {field.unit}" if field.unit != "-" else "" for field in table.common}
    parts = {"banner": BANNER}
    for prefix, properties in (("", table.properties), ("joint_", table.joint_properties)):
        fields = [f"    {one.name}: float  # {one.text}{units[one.array]}" for one in properties]
        given = [f"    {one.argument}: float | None" for one in properties if one.keyword]
        parts |= {f"{prefix}fields": "\n".join(fields), f"{prefix}given": "\n".join(given)}
        parts[f"{prefix}arrays"] = "\n".join(f"    g.{one.array}," for one in properties)
    parts["structural_given"] = "\n".join(
        f"    {one.argument}: float | None" for one in table.structural_properties
    )
    return MATERIAL.format(**parts)


def scheme_text(table: Table, scheme: str) -> str:
    """The offsets of one scheme, in the manner of Appendix IV-2."""
    ibits, rbits = SCHEMES[scheme]
    ratio = rbits // ibits
    lines = [f"# {BANNER}", f"# Word scheme {scheme}: {ratio} integer(s) = 1 real", ""]
    for group in table.groups:
        lines += [*_group_lines(group, ratio), ""]
    return "\n".join(lines)


def _group_lines(group: Group, ratio: int) -> list[str]:
    layout = lay_out(group, ratio)
    lines = [f"{group.name}: {group.text}", f"  {'variable':10}{'':8}{'integer':>8}{'real':>8}"]
    for field in group.fields:
        value = layout.offset[field.name]
        columns = f"{'':>8}{value:>8}" if field.real else f"{value:>8}{'':>8}"
        name = "<head>" if field.role == "head" else field.name
        lines.append(f"  {name:10}{'real' if field.real else 'integer':8}{columns}".rstrip())
    pad = layout.size - layout.used
    lines.append(f"  {group.size_name} = {layout.size} words" + (f", {pad} of them padding" if pad else ""))
    return lines


def layouts_text(table: Table, before: str) -> str:
    """The list of all layouts, `before`, with that of `table`, which has the next number if it is new.

    It is then a draft, which gives way to another one or to none, until somebody takes the word away: from
    a release on. TableError if the table has the number of another one, or a field is younger than it.
    """
    lines = [line for line in before.splitlines() if not line.endswith(DRAFT)]
    known = dict(line.split() for line in lines if not line.startswith("#"))
    number = str(table.layout)
    if number not in known and table.layout == len(known) + 1:
        lines.append(f"{number}  {table.shape}  {DRAFT}")
    elif known.get(number) != table.shape:
        raise TableError(
            f"groups.table: this is not layout {number} of layouts.txt: give it number {len(known) + 1} "
            f"(LAYOUT), new fields the page ours/{len(known) + 1}, and names that are gone a line RETIRED"
        )
    young = [field.name for field in table.fields if field.since > table.layout]
    if young:
        raise TableError(f"groups.table: {', '.join(young)} younger than layout {number}")
    return "\n".join(lines) + "\n"


def names_text(table: Table, before: str, released: int) -> str:
    """The list of all names that fields have had, `before`, with those of `table`: what restart files know.

    released: the last layout that is no draft. TableError if a name of it is gone without a line RETIRED.
    """
    head, *lines = before.splitlines()
    reserved = {name: since for name, since in map(str.split, lines) if int(since) <= released}
    now = {field.name: str(field.since) for field in table.fields}
    gone = sorted(reserved.keys() - now.keys() - {one.name for one in table.retired})
    if gone:
        line = f"RETIRED  {gone[0]}  {table.layout} | what it was"
        raise TableError(f"groups.table: {gone[0]} is gone, but restart files have it: give it a line {line}")
    return "\n".join([head, *(f"{name}  {since}" for name, since in {**reserved, **now}.items())]) + "\n"


def files() -> dict[Path, str]:
    """Every generated file and its text. TableError as layouts_text."""
    text = TABLE.read_text()
    table = parse(text)
    texts = {LAYOUT / "offsets.py": python_text(table), LAYOUT / "groups.table": text}
    texts[LAYOUT / "material.py"] = material_text(table)
    texts[LAYOUTS] = layouts_text(table, LAYOUTS.read_text())
    released = table.layout - texts[LAYOUTS].rstrip().endswith(DRAFT)
    texts[NAMES] = names_text(table, NAMES.read_text(), released)
    for scheme in SCHEMES:
        texts[HERE / f"{scheme}.txt"] = scheme_text(table, scheme)
    return texts


def stale() -> list[str]:
    """Names of the generated files that do not follow from the table as it stands, in the checkout."""
    return [
        str(path.relative_to(HERE.parent))
        for path, text in files().items()
        if not path.exists() or path.read_text() != text
    ]


def write() -> None:
    """Write every generated file."""
    for path, text in files().items():
        path.write_text(text)
