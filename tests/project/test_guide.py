"""The documents keep up with the program: names of 1980, places in the source, links, and the README."""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path

import pytest

from udec_ia import Model
from udec_ia.errors import MESSAGES
from udec_ia.layout.field_table import read_table

ROOT = Path(__file__).parents[2]
GUIDE = ROOT / "docs" / "program-guide.md"
FAITHFULNESS = ROOT / "docs" / "faithfulness.md"
README = ROOT / "README.md"
DOCS = ROOT / "docs"
PAGES = [README, *sorted(DOCS.rglob("*.md"))]

# Appendix III-3, in its order; the scan prints MAKEB as MANCO, TIDY as TILE, ICALB as ICAGS.
FUNCTIONS = """
    ACCUM APLOT ARC FRED BRIDGE CC CE CHANGE CL1 COORD CRAD CREATE CVEL CVELFD CYCLE DAMP DELB DELC DELLST
    FDC FDE FDEF FIND FIX FORD GEN GEO GETR HALT ICALB IDOMP IGET IGETGP IMSG INERT INI INSECT IO IVAR
    JUMPB LOSE MAKEB MAKEC MAKEP MATCH MON MOTION MOVE MVBAK MVFOR NEXTCP NEXTD NEXTDS NEXTP OUTCP OUTFDG
    OUTFDZ OUTG OUTSD PLOTS POP PRINT PROP PUTFCE PUTFDF PUTI PUSH PUTP PUTR PUTSTR PVEL PVELFD QBC QUERY
    RANGE REL1 REL2 RVAR SEP SPLIT SPLI START STRAIN STRESS TIDY TOLSET TRUE UDEC UPDATE UPDT VAR XYCOR
    XYFD ZCS ZSTRS
"""
# Named by the calling map, Appendix III-4, only.
CALLED = "CL2 CL3 CL4 CL5 CLJ2 CLJ3 CLJ4 CLJ5 GPMOT QTEST"
# Appendix III-1.
VARIABLES = """
    LINE LINE1 LPNT RAFLAG PPFLAG ERFLAG STFLAG COFLAG NCFLAG JMPSAV NERR JUNK MFREE IBLOCK IDOM ISTACK
    NCYC MCTOT TDEL FRAC IROUTE NLINE NPAGE JMPGEN ALPHA BETA CON1 CON2 ALPB C1B C2B DEGRAD PI PSCALE ATOL
    BTOL CTOL DTOL DTOL2 ETOL FTOL GTOL HTOL IBPNT ICPNT IDPNT IODPNT AKN AKS AMU COH DENS BULK SHEAR
    ALAM1 ALAM2 IA
"""
# Appendix III-2, apart from the offsets.
PARAMETERS = "LUNIF LUNOF LUNG LUNP MTOP NMAT NCONS NTYP"

ROW = re.compile(r"^\| ([A-Z][A-Z0-9, ]*) \| .+ \| (.+) \|$", re.MULTILINE)
PLACE = re.compile(r"`([a-z_/]+\.py):([\w.]+)`")
FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def rows(text: str) -> dict[str, str]:
    """What the last column of the guide's tables says of each name in the first."""
    return {name: row[1] for row in ROW.findall(text) for name in row[0].split(", ")}


def section(start: str, end: str) -> str:
    """The part of the guide from the heading `start` to the heading `end`."""
    return GUIDE.read_text().partition(f"## {start}")[2].partition(f"\n## {end}")[0]


@cache
def defined(path: Path) -> frozenset[str]:
    """Functions, classes, methods and constants that the source file `path` defines."""
    found = set()
    for node in ast.parse(path.read_text()).body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            found.add(node.name)
        if isinstance(node, ast.ClassDef):
            found |= {f"{node.name}.{sub.name}" for sub in node.body if isinstance(sub, ast.FunctionDef)}
        if isinstance(node, ast.Assign):
            found |= {target.id for target in node.targets if isinstance(target, ast.Name)}
    return frozenset(found)


def test_every_subroutine_of_1980_is_in_the_guide() -> None:
    assert set(rows(section("Subroutines", "What is new"))) == {*FUNCTIONS.split(), *CALLED.split()}


def test_every_variable_of_1980_is_in_the_guide() -> None:
    assert set(rows(section("Variables", "Parameters"))) == set(VARIABLES.split())
    assert set(rows(section("Parameters", "the end"))) == set(PARAMETERS.split())


def test_the_guide_knows_what_is_in_the_common_block() -> None:
    common = {field.name for field in read_table().common if not field.ours}
    in_guide = rows(section("Variables", "Parameters"))
    assert common - {"GRAVX", "GRAVY"} == {n for n, s in in_guide.items() if s.startswith("table")} | {"MTOP"}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_places_in_the_source_exist(page: Path) -> None:
    wrong = []
    for file, name in PLACE.findall(page.read_text()):
        path = ROOT / file if file.startswith("offsets/") else ROOT / "udec_ia" / file
        if not path.is_file() or name not in defined(path):
            wrong.append(f"{file}:{name}")
    assert wrong == []


def test_the_guide_names_places() -> None:
    assert len(PLACE.findall(GUIDE.read_text())) > 80


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_links_lead_somewhere(page: Path) -> None:
    targets = re.findall(r"\]\(([^)#:]+)\)", page.read_text())
    assert [target for target in targets if not (page.parent / target).exists()] == []


def test_the_index_lists_every_page() -> None:
    """The index and the navigation of the site."""
    there = {page.relative_to(DOCS).as_posix() for page in DOCS.rglob("*.md")}
    listed = re.findall(r"^\| \[[^]]+\]\(([^)]+)\)", (DOCS / "index.md").read_text(), re.MULTILINE)
    assert sorted(listed) == sorted(there - {"index.md"})
    site = set(re.findall(r"^ +- .*: (\S+\.md)$", (ROOT / "mkdocs.yml").read_text(), re.MULTILINE))
    assert {name for name in site if not name.startswith("checkout/")} == there


def test_faithfulness_knows_our_fields_and_errors() -> None:
    text = FAITHFULNESS.read_text()
    table = read_table()
    ours = {
        field.name for group in table.groups for field in group.fields if field.ours and field.role != "head"
    }
    ours |= {field.name for field in table.common if field.ours} | {"FTOL", "GTOL", "HTOL"}
    words = set(re.findall(r"\w+", text))
    assert ours - words == set()
    assert [number for number in MESSAGES if number > 26 and f"| {number} |" not in text] == []


def test_the_readme_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    blocks = FENCE.findall(README.read_text())
    assert [language for language, _ in blocks] == ["deck", "python"]
    monkeypatch.chdir(tmp_path)
    model = Model(out="out")
    printed = model.run(blocks[0][1])
    assert printed is not None
    assert re.findall("^ [A-Z]+: no .*", printed, re.MULTILINE) == []
    rows = model.table("block")
    falling = rows[rows["KYD"].argmin()]
    assert (round(float(falling["KY"]), 2), round(float(falling["KYD"]), 2)) == (10.56, -8.14)
    assert (tmp_path / "out" / "restart.h5").exists()
    exec(compile(blocks[1][1], "README.md", "exec"), {})
    assert (tmp_path / "floor.h5").exists()
