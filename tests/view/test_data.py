"""What stands in the page: words and tables, read again with nothing but the standard library."""

from __future__ import annotations

import base64
import json
import re
import struct
import textwrap
import zlib
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.every_group_kind import GROUPS, every_kind

from udec_ia import Model
from udec_ia.cli import main
from udec_ia.errors import UdecError
from udec_ia.heap.word_scheme import ALL_SCHEMES
from udec_ia.reader.word_map import Atlas
from udec_ia.view import Page, view_page

INTS = {16: "h", 32: "i", 64: "q"}
REALS = {32: "f", 64: "d"}


class Parts(HTMLParser):
    """The scripts of a page: (attributes, text) of each; and the attributes of all other elements."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.scripts: list[tuple[dict[str, str | None], str]] = []
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.inside = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.inside = tag
        self.elements.append((tag, dict(attrs)))
        if tag == "script":
            self.scripts.append((dict(attrs), ""))

    def handle_endtag(self, tag: str) -> None:
        self.inside = ""

    def handle_data(self, data: str) -> None:
        if self.inside == "script":
            attributes, text = self.scripts[-1]
            self.scripts[-1] = attributes, text + data


def held(text: str) -> tuple[Any, list[Any]]:
    """The field table and the states of a page."""
    scripts = Parts(text).scripts
    (table,) = (json.loads(inner) for attributes, inner in scripts if attributes.get("id") == "table")
    return table, [json.loads(inner) for attributes, inner in scripts if attributes.get("class") == "state"]


def unpack(packed: str, letter: str) -> list[Any]:
    data = zlib.decompress(base64.b64decode(packed))
    return list(struct.unpack(f"<{len(data) // struct.calcsize(letter)}{letter}", data))


def groups(table: Any, state: Any) -> dict[str, list[int]]:
    """Addresses by kind of span."""
    found: dict[str, list[int]] = {name: [] for name in table["spans"]}
    at = 1
    for size, kind in zip(unpack(state["sizes"], "d"), unpack(state["kinds"], "B"), strict=True):
        found[table["spans"][kind]].append(at)
        at += int(size)
    return found


def value(table: Any, state: Any, kind: str, address: int, field: Any, element: int) -> Any:
    """What a field holds, from the bytes of the words."""
    data = zlib.decompress(base64.b64decode(state["words"]))
    real = field["type"] == "real"
    ratio = state["reals"] // state["ints"]
    word = table["layouts"][str(ratio)][kind]["words"][field["place"]] + element * (ratio if real else 1)
    letter = REALS[state["reals"]] if real else INTS[state["ints"]]
    return struct.unpack_from(f"<{letter}", data, (address - 1 + word) * state["ints"] // 8)[0]


def text_of(*models: Model) -> str:
    pages = Page()
    for k, model in enumerate(models):
        pages.add(model.array, f"state {k}", model.session.log.lines)
    return pages.text()


@pytest.mark.parametrize("build", ALL_SCHEMES)
def test_every_field_of_every_group(build: str) -> None:
    m = every_kind(build)
    table, (state,) = held(text_of(m))
    there = groups(table, state)
    used = int(m.h.ci[view_page.MFREE]) - 1
    assert (state["scheme"], state["used"], state["shown"]) == (build, used, used)
    for group in GROUPS:
        rows = m.table(group.name)
        assert there[group.name] == sorted(rows["address"].tolist())
        for row in rows[:: max(len(rows) // 5, 1)]:
            for field in table["kinds"][group.name]["fields"]:
                for element, expected in enumerate(np.atleast_1d(row[field["name"]]).tolist()):
                    found = value(table, state, group.name, int(row["address"]), field, element)
                    assert found == expected, (group.name, field["name"])


def test_the_common_block() -> None:
    m = every_kind("i32r32")
    table, (state,) = held(text_of(m))
    ci, cr, cd = (unpack(part, letter) for part, letter in zip(state["common"], "qfd", strict=True))
    assert (ci, cr, cd) == (m.h.ci.tolist(), m.h.cr.tolist(), m.h.cd.tolist())
    places = {field["name"]: field["place"] for field in table["common"]}
    assert ci[places["NBLK"]] == 7
    assert cr[places["AKN"]] == 1e8


def test_spans_are_those_of_the_atlas() -> None:
    m = every_kind()
    table, (state,) = held(text_of(m))
    names = [table["spans"][kind] for kind in unpack(state["kinds"], "B")]
    spans = list(Atlas(m.array.h).spans())
    assert names == [span.kind for span in spans]
    assert unpack(state["sizes"], "d") == [span.last - span.first + 1 for span in spans]


def test_what_there_is_no_room_for_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    m = every_kind()
    monkeypatch.setattr(view_page, "LIMIT", 2000)
    pages = Page()
    pages.add(m.array, "one")
    pages.add(m.array, "two")
    assert (
        pages.left_out()[1]
        == f"two has {int(m.h.ci[view_page.MFREE]) - 1} words in use: those beyond 1000 are left out"
    )
    for state in held(pages.text())[1]:
        sizes = unpack(state["sizes"], "d")
        assert 900 < state["shown"] <= 1000
        assert state["shown"] == sum(sizes)
        assert len(unpack(state["words"], "i")) == state["shown"]


def test_an_empty_model_and_one_block() -> None:
    m = Model()
    _, (state,) = held(text_of(m))
    assert (state["shown"], unpack(state["sizes"], "d")) == (0, [len(m.h.ia)])
    m.block(0, 0, 0, 1, 1, 1, 1, 0)
    table, (state,) = held(text_of(m))
    assert len(groups(table, state)["corner"]) == 4
    assert state["faults"] == []


def test_the_checker_has_its_say() -> None:
    m = every_kind()
    array = m.array.copy()
    block = int(m.table("block")["address"][2])
    array.h.ia[block + 1] = 1
    pages = Page()
    pages.add(array, "damaged")
    _, (state,) = held(pages.text())
    assert any(f"block@{block}" in message for _, message in state["faults"])


HOSTILE = "</script><script>pwned=1</script><!--<script>&\u202e\x1b[31m"


def test_nothing_that_a_file_says_leaves_its_place() -> None:
    m = every_kind()
    pages = Page()
    pages.add(m.array, HOSTILE, [HOSTILE, "<img src=x onerror=pwned=2>"])
    text = pages.text()
    parts = Parts(text)
    assert [sorted(attributes) for attributes, _ in parts.scripts] == [["id", "type"], ["class", "type"], []]
    assert "pwned" not in parts.scripts[-1][1]
    assert "img" not in [tag for tag, _ in parts.elements]
    assert not any(name.startswith("on") for _, attributes in parts.elements for name in attributes)
    assert not {"\u202e", "\x1b"} & {*text}
    assert text.count("pwned") == text.count("pwned=") == 5  # title, heading, name, and twice in the deck


def test_nothing_is_fetched() -> None:
    parts = Parts(text_of(every_kind()))
    names = {"src", "href", "action", "srcset", "data"}
    assert not any(names & attributes.keys() for _, attributes in parts.elements)
    (policy,) = (one["content"] for _, one in parts.elements if one.get("http-equiv"))
    assert policy is not None
    assert policy.startswith("default-src 'none'; style-src 'sha256-")
    assert "unsafe" not in policy


def test_scripts_build_on_those_before() -> None:
    """They become one script: what they import stands before them, and no name is given twice."""
    assert {path.name for path in view_page.WEB.glob("*.js")} == {*view_page.SCRIPTS}
    known: dict[str, str] = {}
    for script in view_page.SCRIPTS:
        text = (view_page.WEB / script).read_text()
        for names, source in re.findall(r"^import \{([^}]*)\} from \"\./(.*?)\";$", text, re.M):
            for name in filter(None, map(str.strip, names.split(","))):
                assert known[name] == source
                assert len(re.findall(rf"\b{name}\b", text)) > 1, (script, name)
                assert re.search(rf"^export .*\b{name}\b", (view_page.WEB / source).read_text(), re.M)
        for name in re.findall(
            r"^(?:export )?(?:async )?(?:const|let|class|function) \[?(\$|\w+)", text, re.M
        ):
            assert known.setdefault(name, script) == script, name
    assert not re.search(r"^(import|export)\b", view_page.script(view_page.SCRIPTS), re.M)


def test_model_view(tmp_path: Path) -> None:
    m = every_kind()
    target = m.view(tmp_path / "new" / "page.html")
    first = target.read_text()
    assert held(first)[1][0]["name"].endswith("cycle 0")
    assert held(first)[1][0]["deck"] == m.session.log.lines
    m.view(target)  # over a view of ours
    assert target.read_text() == first
    target.write_text("<!doctype html>\n<title>mine</title>")
    with pytest.raises(UdecError, match="is not a view") as refused:
        m.view(target)
    assert refused.value.number == 31
    assert "mine" in target.read_text()
    with pytest.raises(ValueError, match="at least one state"):
        Page().write(target)


def test_the_page_of_a_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As the documentation writes it."""
    text = (Path(__file__).parents[2] / "docs" / "workshop.md").read_text()
    (lines,) = re.findall(r"^    from udec_ia.view import Page\n(?:    .*\n|\n)+", text, re.M)
    monkeypatch.chdir(tmp_path)
    exec(textwrap.dedent(lines), {"model": every_kind()})
    _, states = held(Path("page.html").read_text())
    assert [state["name"] for state in states] == [f"after {cycles} cycles" for cycles in range(10, 101, 10)]


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    m = every_kind()
    files = [str(m.save(tmp_path / name)) for name in ("a.h5", "<b>&.h5")]
    out = str(tmp_path / "page.html")
    assert main(["view", *files, "--out", out]) == 0
    assert capsys.readouterr().out == f"{out}: open it in a browser\n"
    text = Path(out).read_text()
    _, states = held(text)
    assert [state["name"] for state in states] == ["a.h5", "<b>&.h5"]
    assert states[0]["deck"] == m.session.log.lines
    assert main(["view", *files, "--out", out, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["head"] == [f"{out}: open it in a browser"]
    assert main(["view", *files, "--out", out, "--python"]) == 0
    program = capsys.readouterr().out
    Path(out).unlink()
    exec(compile(program, "program", "exec"), {})
    assert capsys.readouterr().out == f"{out}: open it in a browser\n"
    assert Path(out).read_text() == text


def test_what_cannot_be_viewed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["view", str(tmp_path / "none.h5"), "--out", str(tmp_path / "page.html")]) == 1
    assert "error 29" in capsys.readouterr().err
    assert not (tmp_path / "page.html").exists()
    file = str(every_kind().save(tmp_path / "a.h5"))
    assert main(["view", file, "--out", file]) == 1
    assert "error 31" in capsys.readouterr().err
    assert main(["check", file]) == 0
