"""Places by name: what the grammar takes, what the heap must have, and that answers can be given back."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.every_group_kind import every_kind

from udec_ia import Model
from udec_ia.cli import main
from udec_ia.errors import UdecError
from udec_ia.heap.accessors import getr, iget
from udec_ia.heap_tools.patch_words import patch
from udec_ia.layout import offsets as g
from udec_ia.layout.field_table import Field
from udec_ia.reader.place_grammar import PlaceError, PlaceName, address_of, find_number, read_place, stretch
from udec_ia.reader.word_map import TABLE, Atlas


@pytest.fixture(scope="module")
def model() -> Model:
    """A deformable block on a rigid one, with a group of every list."""
    m = Model()
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.5, bulk=1e9, g=6e8)
    m.block(0, 0, 0, 2, 2, 2, 2, 0)
    m.split(-1, 1, 3, 1)
    m.generate(0, 2, 1, 2, "automatic", edge=0.9)
    m.fix(0, 2, 0, 1)
    m.gravity(0, -10)
    m.cycle(5)
    return m


@pytest.fixture(scope="module")
def file(model: Model, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return model.save(tmp_path_factory.mktemp("places") / "state.h5")


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("412", ("", 412, "", None)),
        (" block@88 ", ("block", 88, "", None)),
        ("Block@88.kxd", ("block", 88, "KXD", None)),
        ("zone@9.KZG(2)", ("zone", 9, "KZG", 2)),
        ("frac", ("", 0, "FRAC", None)),
        ("AMU(1)", ("", 0, "AMU", 1)),
        ("grid-points@88.KXG", ("gridpoint", 88, "KXG", None)),
    ],
)
def test_one_grammar(text: str, name: tuple[str, int, str, int | None]) -> None:
    assert read_place(text) == PlaceName(*name)


@pytest.mark.parametrize(
    "text",
    [
        *("", "@", "block@", "@88", "block@88.", "block.KXD", "412.KXD", "block@88.KXD.", "block@-1"),
        *("block@88.KZG(a)", "block 88", "1" * 41, "block@88.KZG(1", "\x1b[31m", "block@1e3", "FRAC = 1"),
    ],
)
def test_what_is_no_place(text: str) -> None:
    with pytest.raises(PlaceError):
        read_place(text)


def test_every_group_and_field_is_found_by_its_name(model: Model) -> None:
    atlas = Atlas(model.h)
    for kind, at in atlas.groups.items():
        for iad in at[:: max(len(at) // 5, 1)].tolist():
            span = atlas.span(iad)
            assert address_of(atlas, f"{kind}@{iad}") == iad == address_of(atlas, iad)
            assert stretch(atlas, f"{kind}@{iad}") == (span.first, span.last)
            for word in atlas.words(span):
                name = f"{kind}@{iad}.{word.name}"
                place = find_number(atlas, name)
                assert (place.name, place.kind, place.field) == (name, kind, word.field)
                assert place.value(model.h) == atlas.value(word)
                assert stretch(atlas, name) == (word.first, word.last)
                assert find_number(atlas, str(word.last)) == place


def test_variables(model: Model) -> None:
    atlas = Atlas(model.h)
    assert find_number(atlas, "FRAC").value(model.h) == model.h.cr[g.FRAC]
    assert find_number(atlas, "akn(1)").value(model.h) == 1e8
    assert find_number(atlas, "AKN(1)").unit == "N/m2"


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("contact@{block}", ("no contact at {block}", "block@{block}")),
        ("block@{inner}", ("no block at {inner}", "in block@{block}")),
        ("block@99999999", ("no block at 99999999", "1 to ")),
        ("block@0", ("no block at 0",)),
        ("brick@{block}", ("brick is not a kind of group",)),
        ("block@{block}.KXX", ("KXX is not a field of a block", "KXD")),
        ("block@{block}.KXD(2)", ("KXD has no element 2",)),
        ("block@{block}.KXD(0)", ("KXD has no element 0",)),
        ("zone@{zone}.KZG", ("KZG has 3 elements",)),
        ("AKN(0)", ("AKN has no element 0",)),
        ("KXD", ("KXD is not a variable", "block@88.KXD")),
        ("block@{block}", ("whole group",)),
    ],
)
def test_what_the_heap_does_not_have(model: Model, text: str, parts: tuple[str, ...]) -> None:
    atlas = Atlas(model.h)
    block, zone = int(atlas.groups["block"][0]), int(atlas.groups["zone"][0])
    names = {"block": block, "inner": block + 1, "zone": zone}
    with pytest.raises(PlaceError) as refused:
        find_number(atlas, text.format(**names))
    for part in parts:
        assert part.format(**names) in str(refused.value)
    before = model.h.ia.copy()
    with pytest.raises(UdecError) as error:
        patch(model.array, text.format(**names) + " = 1")
    assert error.value.number == 10
    assert np.array_equal(before, model.h.ia)


@pytest.mark.parametrize("build", ["i32r64", "i16r32", "i64r64"])
def test_paths_are_followed_as_by_hand(build: str) -> None:
    """Random paths through all kinds of groups, word by word with the kernels' own accessors."""
    m, rng = every_kind(build), np.random.default_rng(5)
    atlas, kinds = Atlas(m.h), {}
    for group in TABLE.groups:
        kinds |= dict.fromkeys(m.table(group.name)["address"].tolist(), group)
    many = 0
    for start in rng.choice([*kinds], 300).tolist():
        text, here = f"{kinds[start].name}@{start}", start
        for _ in range(int(rng.integers(1, 5))):
            fields = kinds[here].fields
            pointers = [one for one in fields if one.target and one.count == 1 and iget(m.h, here, at(one))]
            if not pointers:
                break
            step = pointers[int(rng.integers(len(pointers)))]
            text, here = f"{text}.{step.name}", int(iget(m.h, here, at(step)))
        field = next(one for one in kinds[here].fields[::-1] if one.count == 1)
        many += text.count(".") > 1
        value = (getr if field.real else iget)(m.h, here, at(field))
        place = find_number(atlas, f"{text}.{field.name}")
        assert place.name == f"{kinds[here].name}@{here}.{field.name}"
        assert place.value(m.h) == value or value != value
        assert address_of(atlas, f"{text}.{field.name}") == stretch(atlas, place.name)[0]
    assert many > 100


def at(field: Field) -> Any:
    """The offset of a field, as kernels take it."""
    return getattr(g, field.name)


@pytest.mark.parametrize(
    ("text", "step"),
    [
        ("block@{block}.KP.KXX", "KXX"),
        ("block@{block}.KX.KXP", "KX.KXP"),
        ("block@{rigid}.KBEX.KS111", "KBEX.KS111"),
        ("block@{block}.KP.KNB.KZG(2).KXG", "KZG(2).KXG"),
        ("zone@{zone}.KZG.KXG", "KZG.KXG"),
        ("FRAC.KX", "FRAC.KX"),
        ("corner@{block}.KL.KXP", "corner@{block}.KL.KXP"),
    ],
)
def test_a_caret_is_at_the_step_that_fails(model: Model, text: str, step: str) -> None:
    blocks, zone = model.table("block"), int(model.table("zone")["address"][0])
    rigid = int(blocks["address"][blocks["KBEX"] == 0][0])
    names = {"block": int(blocks["address"][0]), "rigid": rigid, "zone": zone}
    text = text.format(**names)
    with pytest.raises(PlaceError) as refused:
        find_number(Atlas(model.h), text)
    _, line, caret = str(refused.value).split("\n")
    assert line.strip() == text
    assert line[caret.index("^") :] == step.format(**names)
    with pytest.raises(UdecError) as error:
        patch(model.array, f"{text} = 1")
    assert str(error.value).splitlines()[2].index("^") == caret.index("^")


@pytest.mark.parametrize(
    ("text", "step"), [("block@1.KP.KXX", "KXX"), ("block@$B.KX.KXP", "KX.KXP"), ("FRAC.KX", "FRAC.KX")]
)
def test_the_caret_in_a_deck(text: str, step: str, tmp_path: Path) -> None:
    deck = f"START\nDEFAULT B=1\nBLOCK 0,0 0,2 2,2 2,0\nPATCH FRAC = 0.1, {text} = 1 * it is wrong\n"
    with pytest.raises(UdecError) as refused:
        Model(out=tmp_path).run(deck)
    assert refused.value.source is not None
    assert refused.value.source[(refused.value.column or 0) - 1 :].startswith(f"{step} = 1")


def test_a_path_that_a_damaged_heap_breaks() -> None:
    m = every_kind()
    block = m.table("block")[0]
    domain = int(m.table("domain")["address"][0])
    array = m.array.copy()
    array.h.ia[int(block["address"]) - 1 + g.KP[1]] = domain
    with pytest.raises(PlaceError, match=f"leads to {domain}.*no corner"):
        find_number(Atlas(array.h), f"block@{block['address']}.KP.KXP")


def test_a_path_is_patched(model: Model) -> None:
    array = model.array.copy()
    zone = model.table("zone")[0]
    done = patch(array, f"zones@{zone['address']}.KZG(2).KXG = 0.25", force=True)
    point = int(zone["KZG"][1])
    assert done.former[0].what == f"gridpoint@{point}.KXG"
    assert getr(array.h, point, g.KXG) == 0.25


def test_a_variable_has_no_address(model: Model) -> None:
    for ask in (address_of, stretch):
        with pytest.raises(PlaceError):
            ask(Atlas(model.h), "FRAC")


@pytest.mark.parametrize("kind", ["contact", "block", "zone", "domain"])
def test_what_the_commands_print_they_take(
    model: Model, file: Path, kind: str, capsys: pytest.CaptureFixture[str]
) -> None:
    def udec(*args: object) -> tuple[int, str, str]:
        status = main([*map(str, args)])
        printed = capsys.readouterr()
        return status, printed.out, printed.err

    iad = int(Atlas(model.h).groups[kind][-1])
    asked: list[tuple[str, ...]] = [("what",), ("who",), ("dump",), ("graph",), ("find", "--points-to")]
    if kind != "zone":
        asked.append(("walk", kind) if kind in ("block", "domain") else ("walk", "KC"))
    for verb, *before in asked:
        by_name, by_address = (udec(verb, file, *before, place) for place in (f"{kind}@{iad}", iad))
        assert by_name[0] == by_address[0] == 0
        if verb == "dump":
            assert len(by_name[1].splitlines()) > len(by_address[1].splitlines())
        else:
            assert by_name[1] == by_address[1]
        status, _, printed = udec(verb, file, *before, f"corner@{iad}")
        assert status == 2
        assert f"there is no corner at {iad}" in " ".join(printed.split())


def test_names_of_files_cannot_steer_a_terminal(
    model: Model, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    name = "a\x1b[31m"
    model.save(tmp_path / f"{name}.h5")
    for words in (
        ["map", f"{name}.h5", "--out", f"{name}.png"],
        ["graph", f"{name}.h5", "1", "--out", f"{name}.dot"],
        ["view", f"{name}.h5", "--out", f"{name}.html"],
        ["check", f"{name}.h5"],
        ["info", f"{name}.h5"],
        ["what", f"{name}.h5", f"{name}@1"],
    ):
        main(words)
        printed = capsys.readouterr()
        assert "\x1b" not in printed.out + printed.err, words
        assert printed.out + printed.err


@pytest.mark.parametrize("words", [["run", "--x\x1b[31m"], ["run", "a.dat", "b\x1b[31m"], ["x\x1b[31m"]])
def test_arguments_cannot_steer_a_terminal(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(words)
    message = capsys.readouterr().err
    assert "\\x1b[31m" in message
    assert "\x1b" not in message
