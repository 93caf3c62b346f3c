"""Write what follows from groups.table: `generated.py` and the tables of offsets a person reads.

`generated.py` gives every offset as a tuple (for 1, 2 and 4 integers to a real); the accessors pick
the element by the array types at hand, so one kernel source serves all word schemes.
"""

from __future__ import annotations

from pathlib import Path

from offsets.table import COMMON_TYPES, RATIOS, Group, Table, lay_out, read_table

HERE = Path(__file__).parent
SCHEMES = {  # name: (integer bits, real bits), report 3.5
    "i16r32": (16, 32),
    "i32r32": (32, 32),
    "i16r64": (16, 64),
    "i32r64": (32, 64),
    "i64r64": (64, 64),
}
BANNER = "AUTO-GENERATED from offsets/groups.table by `python -m offsets`; do not edit."


def python_text(table: Table) -> str:
    """The text of generated.py."""
    lines = [
        f'"""{BANNER}',
        "",
        "Offsets and sizes are tuples: for 1, 2 and 4 integers to a real.",
        '"""',
        "",
    ]
    lines += [f'DIGEST = "{table.digest}"', ""]
    lines += [f"{head.name} = {head.value}  # {head.text}" for head in table.heads]
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


def files(table: Table) -> dict[Path, str]:
    """Every generated file and its text."""
    texts = {HERE / "generated.py": python_text(table)}
    for scheme in SCHEMES:
        texts[HERE / f"{scheme}.txt"] = scheme_text(table, scheme)
    return texts


def stale() -> list[str]:
    """Names of the generated files that do not follow from the table as it stands."""
    return [p.name for p, text in files(read_table()).items() if not p.exists() or p.read_text() != text]


def write() -> None:
    """Write every generated file."""
    for path, text in files(read_table()).items():
        path.write_text(text)
