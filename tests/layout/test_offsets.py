"""The field table and what follows from it: the report's own tables, alignment, order, currency."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from naive.layout import ONE_INTEGER_TO_A_REAL, TWO_INTEGERS_TO_A_REAL, count_words

from offsets.generate import DRAFT, LAYOUTS, NAMES, files, layouts_text, names_text, stale
from offsets.generate import TABLE as SOURCE
from udec_ia.heap.find_lose import find
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.layout import offsets
from udec_ia.layout.code_names import spelled
from udec_ia.layout.field_table import (
    COMMON_TYPES,
    RATIOS,
    Group,
    Table,
    TableError,
    lay_out,
    parse,
    read_table,
)

TABLE = read_table()
GROUPS = pytest.mark.parametrize("group", TABLE.groups, ids=lambda group: group.name)


def report_name(name: str) -> str:
    return "<head code>" if name == "HEAD" else name


@pytest.mark.parametrize(("ratio", "printed"), [(2, TWO_INTEGERS_TO_A_REAL), (1, ONE_INTEGER_TO_A_REAL)])
def test_corner_offsets_are_those_of_the_report(ratio: int, printed: dict[str, int]) -> None:
    """Appendix IV-2, page 66: all that it prints, in its order, and after it only what is ours."""
    offset = {report_name(name): k for name, k in lay_out(TABLE.group("corner"), ratio).offset.items()}
    assert list(offset)[: len(printed)] == list(printed)
    assert {name: offset[name] for name in printed} == printed
    assert all(field.ours for field in TABLE.group("corner").fields[len(printed) :])


@pytest.mark.parametrize(("ratio", "printed"), [(2, TWO_INTEGERS_TO_A_REAL), (1, ONE_INTEGER_TO_A_REAL)])
def test_generated_corner_offsets_are_those_of_the_report(ratio: int, printed: dict[str, int]) -> None:
    for name, k in printed.items():
        if name != "<head code>":
            assert getattr(offsets, name)[ratio >> 1] == k, name


@pytest.mark.parametrize("ratio", RATIOS)
@GROUPS
def test_layout_is_the_count_on_ones_fingers(group: Group, ratio: int) -> None:
    counted, size = count_words([(f.name, f.real, f.count) for f in group.fields], ratio)
    layout = lay_out(group, ratio)
    assert layout.offset == counted
    assert layout.size == size
    assert getattr(offsets, group.size_name)[ratio >> 1] == size


@pytest.mark.parametrize("ratio", RATIOS)
@GROUPS
def test_alignment_and_no_overlap(group: Group, ratio: int) -> None:
    """Sizes are whole reals, so every group address is aligned; no two fields share a word."""
    layout = lay_out(group, ratio)
    assert layout.size % ratio == 0
    words: list[int] = []
    for field in group.fields:
        k = layout.offset[field.name]
        first = (k - 1) * ratio if field.real else k
        words += range(first, first + field.count * (ratio if field.real else 1))
    assert len(words) == len(set(words))
    assert set(words) <= set(range(layout.size))


@pytest.mark.parametrize("name", ALL_SCHEMES)
def test_addresses_are_aligned_whatever_is_found(name: str) -> None:
    array = MainArray(ALL_SCHEMES[name])
    for group in TABLE.groups:
        address = int(find(array.h, getattr(offsets, group.size_name)))
        assert address > 0
        assert (address - 1) * array.h.ia.itemsize % array.h.ra.itemsize == 0


@pytest.mark.parametrize("ratio", RATIOS)
@GROUPS
def test_1980_fields_keep_order_and_offsets(group: Group, ratio: int) -> None:
    """What is ours stands after the last 1980 word: without it every 1980 offset is the same."""
    of_1980 = tuple(field for field in group.fields if not field.ours)
    assert group.fields[: len(of_1980)] == of_1980
    if not of_1980:
        return
    bare = Group(group.name, group.size_name, group.list_head, group.page, group.text, of_1980)
    offset = lay_out(group, ratio).offset
    assert lay_out(bare, ratio).offset == {field.name: offset[field.name] for field in of_1980}
    words = [
        offset[f.name] if not f.real else (offset[f.name] - 1) * ratio
        for f in group.fields
        if f.name != "HEAD"
    ]
    assert words == sorted(words)


def test_names_are_unique() -> None:
    """An offset is known by its name alone."""
    names = [f.name for group in TABLE.groups for f in group.fields if f.role != "head"]
    names += [f.name for f in TABLE.common] + [group.size_name for group in TABLE.groups]
    names += [head.name for head in TABLE.heads]
    assert len(names) == len(set(names))


def test_common_block_indices_do_not_overlap() -> None:
    for kind, size in COMMON_TYPES.items():
        places = [
            getattr(offsets, f.name) + i for f in TABLE.common if f.type == kind for i in range(f.count)
        ]
        assert places == list(range(getattr(offsets, size)))


def test_pointers_name_a_kind_of_group() -> None:
    kinds = {group.name for group in TABLE.groups} | {"item", "soft", "any"}
    for fields in (*(group.fields for group in TABLE.groups), TABLE.common):
        for field in fields:
            assert field.target is None or field.target in kinds, field.name


def test_generated_files_are_current() -> None:
    assert stale() == []
    assert TABLE.digest == offsets.DIGEST
    assert len(files()) == 5 + len(ALL_SCHEMES)


@pytest.mark.parametrize(
    "bad",
    [
        "KZZ  integer  -  data  -  53 | neither int nor real",
        "KZZ  int  -  data  53 | a column is missing",
        "KZZ  int  -  data  -  53   no bar",
        "KZZ  int*x  -  data  -  53 | not a number",
        "GROUP  short  NVSH | columns are missing",
        "KZZ  int  -  data  -  his | no page",
        "KZZ  int  -  data  -  53/2 | the report has one layout",
        "RETIRED  KOLD  soon | not a number",
        "PROPERTY  Weight  w  weight  DENS | a column is missing",
        "HEAD  MBAD",
        "CODE  OPEN  four  KCCOD | not a number",
    ],
)
def test_bad_lines_are_named(bad: str) -> None:
    text = SOURCE.read_text()
    line = len(text.splitlines()) + 1
    with pytest.raises(TableError, match=rf"groups\.table:{line}: ") as caught:
        parse(text + bad + "\n")
    assert bad.strip() in str(caught.value)


@pytest.mark.parametrize(
    ("line", "output"),
    [
        ("CODE  OPEN  1  KNONE | of no field", "there is no field for the code OPEN"),
        ("CODE  OPEN  1  KGFIX,KNONE | of one field only", "there is no field for the code OPEN"),
        ("FLAG  OPEN  3  KGFIX | the sum of others", "the number of a flag is 1, 2, 4"),
        ("CODE  VIRTUAL  5  KCCOD | twice", "called VIRTUAL"),
        ("RETIRED  KX  2 | a name that is in use again", "retired names are called KX"),
        ("CODE  KX  5  KCCOD | a field's name", "called KX"),
    ],
)
def test_a_code_has_a_field_and_a_name_of_its_own(line: str, output: str) -> None:
    with pytest.raises(TableError, match=output):
        parse(SOURCE.read_text() + line + "\n")


def test_a_property_has_an_array() -> None:
    with pytest.raises(TableError, match="there is no array for the property weight"):
        parse(SOURCE.read_text() + "PROPERTY  Weight  w  weight  weight  WGHT | of nothing\n")


def test_a_damping_mode_is_one_line() -> None:
    """Its code follows from it, and that LREST may hold this code and none between."""
    before, after = SOURCE.read_text().split("DAMPING   Adaptive")
    last = TABLE.damping[-1].code + 1

    def with_line(effects: str) -> Table:
        line = f"Brake {last + 1} f {effects} | opposes the weight | takes {{f:g}} of every weight"
        return parse(f"{before}DAMPING   {line}\nDAMPING   Adaptive{after}")

    table = with_line("forces,stiffens")
    (field,) = (field for field in table.common if field.name == "LREST")
    (mode,) = (one for one in table.damping if one.name == "BRAKE")
    assert sorted(field.allowed) == [(code, code) for code in (*range(last), last + 1)]
    assert [code.name for code in spelled(table.codes_of("LREST"), mode.code)] == ["BRAKE"]
    assert mode.effects == {"forces", "stiffens"}
    assert mode.report.format(f=0.5) == "takes 0.5 of every weight"
    with pytest.raises(TableError, match="weights"):
        with_line("weights")
    with pytest.raises(TableError, match="no code for the field LSCALE"):
        changed("LSCALE  int   0..1", "LSCALE  int   codes")


def test_codes_are_in_the_range_of_their_field() -> None:
    fields = {field.name: field for group in TABLE.groups for field in group.fields}
    fields |= {field.name: field for field in TABLE.common}
    coded = {name for code in TABLE.codes for name in code.fields}
    assert coded == {
        "KBFIX",
        "KCCOD",
        "KGFIX",
        "KUFIX",
        "KHK",
        "KCJFLAG",
        "KVCODE",
        "KOKIND",
        "LFLOW",
        "JMLAW",
        "JMUNIT",
        "JMSHORT",
        "JPHASE",
        "LREST",
        "KFRK",
        "KASTAT",
        "KMSTAT",
        "KMKIND",
        "KNSTAT",
        "KNSIDE",
    }
    for code in TABLE.codes:
        for name in code.fields:
            assert any(low <= code.value <= (high or 0) for low, high in fields[name].allowed)
        assert getattr(offsets, code.name) == code.value


SUMS = {
    "KBFIX": {0, 1, 2, 4, 6, 8, 10, 12, 14},
    "KGFIX": {0, 1, 2, 3},
    "KUFIX": {0, 1, 2, 3, 4},  # a rotation has a condition of its own
    "KCJFLAG": {*range(512)},
    "JMSHORT": {*range(4)},
    "KASTAT": {*range(8)},
    "KMSTAT": {*range(8)},
    "KNSTAT": {*range(4)},
}


def test_flags_add_up_to_what_their_field_may_hold() -> None:
    """The range of a field with flags holds their sums and nothing else, but for what excludes itself."""
    for name, sums in SUMS.items():
        codes = TABLE.codes_of(name)
        assert all(code.flag for code in codes)
        (field,) = (field for field in TABLE.fields if field.name == name)
        held = {value for low, high in field.allowed for value in range(low, (high or 0) + 1)}
        assert held == sums
        for value in held:
            assert sum(code.value for code in spelled(codes, value)) == value
    assert [code.name for code in TABLE.codes if code.flag] == [
        "FIXED", "GIVEN_X", "GIVEN_Y", "GIVEN_TURN", "ALONG_X", "ALONG_Y",
        "JOINT_SLIPS", "JOINT_SLIPPED", "JOINT_BROKEN", "JOINT_GIVEN", "JOINT_STALE",
        "JOINT_OPENS", "BEGINS_OPENING", "OPENS_BESIDE1", "OPENS_BESIDE2",
        "YIELDED", "SHEARED", "BROKEN", "NODE_SLIPPED", "NODE_PARTED", "HINGED",
        "TURNS", "SPRINGS_ALONE", "LINEAR_BETWEEN",
    ]  # fmt: skip
    assert spelled(TABLE.codes_of("LREST"), 5) == []  # LOCAL and ADAPTIVE do not add up


def changed(old: str, new: str) -> Table:
    text = SOURCE.read_text()
    assert old in text
    return parse(text.replace(old, new))


def released(layouts: str) -> str:
    """The list of layouts once none of them is a draft any more."""
    return layouts.replace(f"  {DRAFT}\n", "\n")


def test_a_layout_has_a_number_and_every_number_one_layout() -> None:
    """A new field needs the next one, and says since when it is there; a wording needs none."""
    known = released(LAYOUTS.read_text())
    last = TABLE.layout
    assert layouts_text(TABLE, known) == known
    assert layouts_text(changed("| block type number", "| type of the block"), known) == known
    with pytest.raises(TableError, match=f"not layout {last} of layouts.txt: give it number {last + 1}"):
        layouts_text(changed("KBRO   real", "KNEW   real  -  data  m  ours | new\nKBRO   real"), known)
    text = SOURCE.read_text().replace(f"LAYOUT  {last}\n", f"LAYOUT  {last + 1}\n")
    more = text.replace("KBRO   real", f"KNEW   real  -  data  m  ours/{last + 1} | new\nKBRO   real")
    new = parse(more)
    assert {f.name: f.since for f in new.group("block").fields}["KNEW"] == last + 1
    draft = layouts_text(new, known)
    assert draft == f"{known}{last + 1}  {new.shape}  draft\n"
    other = parse(more.replace("KNEW", "KNEWER"))
    assert layouts_text(other, draft) == f"{known}{last + 1}  {other.shape}  draft\n"  # a draft gives way
    assert layouts_text(TABLE, draft) == known
    with pytest.raises(TableError, match=f"KNEW younger than layout {last + 1}"):
        layouts_text(parse(more.replace(f"ours/{last + 1}", f"ours/{last + 2}")), known)
    with pytest.raises(TableError, match=f"not layout {last + 2}"):
        layouts_text(parse(more.replace(f"LAYOUT  {last + 1}", f"LAYOUT  {last + 2}")), known)


def test_what_is_gone_is_told_and_its_name_is_kept() -> None:
    gone = changed("\nLAYOUT  ", "\nRETIRED  KOLD  1 | the colour of a block\nLAYOUT  ")
    assert [(one.name, one.until, one.text) for one in gone.retired] == [("KOLD", 1, "the colour of a block")]


def test_a_name_that_a_release_has_had_is_not_lost() -> None:
    known, last = NAMES.read_text(), TABLE.layout
    assert names_text(TABLE, known, last) == known
    more = changed("KBRO   real", f"KNEW   real  -  data  m  ours/{last + 1} | new\nKBRO   real")
    draft = names_text(more, known, last)
    assert set(draft.splitlines()) - set(known.splitlines()) == {f"KNEW  {last + 1}"}
    assert names_text(TABLE, draft, last) == known
    with pytest.raises(TableError, match=f"KNEW is gone, but .* RETIRED  KNEW  {last}"):
        names_text(TABLE, draft, last + 1)
    told = changed("\nLAYOUT  ", f"\nRETIRED  KNEW  {last + 1} | new\nLAYOUT  ")
    assert names_text(told, draft, last + 1) == draft


def test_the_text_says_when_a_pointer_is_0() -> None:
    for field in (*(one for group in TABLE.groups for one in group.fields), *TABLE.common):
        if field.target is not None:
            never = field.values.endswith("!")
            assert ("; 0 " in field.text) is not never, field.name


def test_a_field_before_the_first_group_is_refused() -> None:
    with pytest.raises(TableError, match="before the first GROUP"):
        parse("KB  int  block  next  -  53 | lost\n")


PROBE = """
from udec_ia.layout.offsets import KX
from udec_ia.heap.accessors import getr
from udec_ia.compiling.kernel_decorators import kernel

@kernel
def probe(h, iad):
    return getr(h, iad, KX)
"""

SCRIPT = """
from udec_ia.layout import offsets as g
from udec_ia.heap.accessors import putr
from udec_ia.heap.main_array import MainArray
from udec_ia.compiling.cache_folder import cache_folder
from udec_ia.heap.find_lose import find
from udec_ia.heap.probe import probe
from udec_ia.heap.word_scheme import scheme

kept = any(cache_folder().rglob("*.nbc"))
h = MainArray(scheme("i32r64")).h
iad = find(h, g.NVBL)
putr(h, iad, g.KX, 7.5)
print(kept, probe(h, iad), h.ci[g.MFREE] - iad, g.NVBL[1], g.KX[1])
"""


def run_probe(tree: Path, cache: Path) -> tuple[bool, float, int, int, int]:
    """A compiled kernel in a process of its own, on an interpreted store of 7.5 in KX of a block.

    Were kernels in the cache? KX as the kernel reads it; size of a block as the kernel's FIND takes it and
    as the table has it; offset of KX in the table.
    """
    environment = {
        **os.environ,
        "PYTHONPATH": str(tree),
        "UDEC_CACHE": str(cache),
        "PYTHONDONTWRITEBYTECODE": "1",
    }
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT], cwd=tree, env=environment, capture_output=True, text=True, timeout=240
    )
    assert done.returncode == 0, done.stderr
    kept, value, taken, size, kx = done.stdout.split()
    return kept == "True", float(value), int(taken), int(size), int(kx)


def python_in(tree: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run Python in the checkout `tree`."""
    environment = {**os.environ, "PYTHONPATH": str(tree), "PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.run(
        [sys.executable, *arguments],
        cwd=tree,
        env=environment,
        capture_output=True,
        text=True,
        timeout=240,
        check=False,
    )


def test_a_changed_table_is_told_and_changes_the_run_after_it_was_written_out(tmp_path: Path) -> None:
    """With the same cache folder: kernels are kept as long as the table stays, and never a run longer."""
    tree, cache = tmp_path / "tree", tmp_path / "cache"
    here = SOURCE.parent.parent
    for package in ("offsets", "udec_ia"):
        shutil.copytree(here / package, tree / package, ignore=shutil.ignore_patterns("__pycache__"))
    (tree / "udec_ia" / "heap" / "probe.py").write_text(PROBE)
    (tree / "offsets" / "layouts.txt").write_text(released(LAYOUTS.read_text()))
    first = run_probe(tree, cache)
    again = run_probe(tree, cache)
    assert (first[0], again[0]) == (False, True)
    assert first[1:] == again[1:]
    assert first[1] == 7.5
    assert first[2] == first[3]

    table = tree / "offsets" / "groups.table"
    lines = table.read_text().splitlines()
    at = next(i for i, line in enumerate(lines) if line.startswith("KX "))
    following = f"LAYOUT  {TABLE.layout + 1}"
    lines.insert(at, f"KXNEW  real  -  data  m  ours/{TABLE.layout + 1} | a field before KX")
    table.write_text("\n".join(lines) + "\n")
    layout = {path: path.read_bytes() for path in (tree / "udec_ia" / "layout").glob("*.*")}
    for command in (["-c", "from udec_ia import Model"], ["-m", "udec_ia", "run", "no.dat"]):
        refused = python_in(tree, *command)
        assert refused.returncode == 1
        last = refused.stderr.splitlines()[-1]
        assert last.endswith(f"{table} has changed since udec_ia/layout was made: run python -m offsets")
        assert ("Traceback" in refused.stderr) == (command[0] == "-c")
    for check in ([], ["--check"]):
        told = python_in(tree, "-m", "offsets", *check)
        assert told.returncode == 1
        assert f"({following[:6]})" in told.stderr
    table.write_text(table.read_text().replace(f"LAYOUT  {TABLE.layout}\n", f"{following}\n"))
    told = python_in(tree, "-m", "offsets", "--check")
    assert told.returncode == 1
    assert "udec_ia/layout/offsets.py is not current: run python -m offsets" in told.stdout
    assert {path: path.read_bytes() for path in layout} == layout  # nothing is written but by the command
    assert python_in(tree, "-m", "offsets").returncode == 0
    assert python_in(tree, "-m", "offsets", "--check").returncode == 0
    changed = run_probe(tree, cache)
    assert changed[4] == first[4] + 1
    assert changed[3] > first[3]
    assert changed[1] == 7.5
    assert changed[2] == changed[3]
