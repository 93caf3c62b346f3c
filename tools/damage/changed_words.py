"""Single words of sealed restart files, changed one at a time: RESTART must refuse what it cannot accept.

    python tools/damaged_files.py words --changes 10000 --seed 1 --build i32r64
    python tools/damaged_files.py words --changes 20000 --only pointer head junk count

The file holds groups of every kind that a program makes: blocks of all types, zones in pairs and others, a
block that hangs on a virtual contact, boundary conditions on all that takes one, signals, functions,
histories and junk. A word is drawn and another number is put there. Each change goes through the proof that
RESTART makes; one in TAKEN of those that it takes, and one in REFUSED of the others, are saved in a sealed
file, too, and RESTART must say the same. The field table says what the word is:

    head, pointer, junk    must be refused, whatever it is now
    count                  must be refused
    code                   must be refused if it is out of its range
    real, spare            any number may stand there; spare are words that no field uses

A few pointers may lead elsewhere and the state is as sound as before: LEGAL says which, to what, and why. A
code within its range is another state that the program knows. Both are counted. What is taken and should
not have been is printed, and the exit status is 1.
"""

from __future__ import annotations

import argparse
import tempfile
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from udec_ia import Model
from udec_ia.checker import check, check_links
from udec_ia.checker.checked_state import State
from udec_ia.checker.pointers_and_codes import allowed
from udec_ia.errors import UdecError
from udec_ia.heap.junk_list import JNEXT, JSIZE, JSIZES
from udec_ia.heap.main_array import MainArray
from udec_ia.heap.word_scheme import ALL_SCHEMES, DEFAULT_SCHEME
from udec_ia.layout import offsets
from udec_ia.layout.field_table import Field
from udec_ia.reader.field_reading import TABLE
from udec_ia.restart import load, save
from udec_ia.running.history_series import Series

TAKEN, REFUSED = 5, 100  # one in so many of the changes that are taken or refused goes through a file
PARTS = {"pointer": 0.5, "code": 0.2, "count": 0.08, "head": 0.08, "junk": 0.06, "real": 0.03, "spare": 0.03}
PARTS |= {"note": 0.02}  # shares of the changes, by what the words are
Rng = np.random.Generator
COUNTS = {"NBLK", "NCON", "NDOM", "NVIRT", "NSOFT", "KFNG", "KFNZ", "MFREE", "MTOP"}
NOTES = {"NERR", "IERAD", "NWANT"}  # of what a kernel left behind; CYCLE clears them before it begins


def every_kind(build: str, out: Path) -> Model:
    """A base and six blocks on it, one of which has been deleted from below the last."""
    m = Model(build, out=out)
    m.property(1, density=2000, kn=1e8, ks=1e8, friction=0.3, bulk=1e8, g=5e7)
    m.block(0, -1, 0, 1, 6, 1, 6, -1)
    m.round(0.05)
    m.split(-1, 0, 7, 0)
    for x in range(1, 6):
        m.split(x, -0.5, x, 2)
    m.split(5, 0.5, 7, 0.5)
    m.fix(0, 6, -1, 0)
    m.change(1, 2, 0, 1, type="sdef")
    for x, mixed in ((2, True), (3, False)):
        points = [(x, 0), (x, 1), (x + 1, 1), (x + 1, 0), (x + 0.5, 0.5), (x + 0.5, 1)]
        numbers = [(6, 5, 2), (5, 1, 2), (1, 4, 2), (4, 3, 2), (3, 6, 2)]
        if mixed:
            points, numbers = points[:-1], [(5, 4, 1), (4, 3, 1), (3, 2, 1), (2, 5, 1)]
        m.generate(x, x + 1, 0, 1, "manual", points, numbers, mixed=mixed)
    m.function(3, 0.0, 0.0, 0.001, 1.0, 0.002, -1.0)
    m.function(4, 0.0, 1.0, 1.0, 2.0)
    m.boundary(0, 4, 0.9, 1.1, stress=(0.0, 0.0, -1e5), function=3)
    m.boundary(0, 1, 0, 1, xvel=0.01, sine=(20.0, 1.0))
    m.boundary(1, 2, 0, 1, yforce=-10.0)
    m.boundary(2.4, 2.6, 0.4, 0.6, yvel=0.0)
    m.boundary(3.9, 4.1, -0.1, 1.1, xvel=0.0)
    m.boundary(4.9, 6.1, 0.4, 1.1, viscous=True)
    m.history(10, "kyd", at=[(0.5, 0.5), (5.5, 0.8)])
    m.history(10, "kxdg", at=(3, 1))
    m.history(10, "kinetic")
    m.history(10, "time")
    m.delete(5, 6, 0, 0.5)
    m.cycle(20)
    m.change(4, 5, 0, 1, type="fdef")  # without zones
    return m


class Word(NamedTuple):
    """One word of the file. place: its index in IA(), or in the integers of the common block.

    field: None for words of junk groups and for those that no field uses. group: kind and address.
    """

    what: str
    place: int
    field: Field | None = None
    kind: str = "common"
    group: int = 0


def words(state: State) -> list[Word]:
    """All words below MFREE, and the integers of the common block."""
    found = [
        Word(_what(field), getattr(offsets, field.name), field) for field in TABLE.common if not field.real
    ]
    taken: set[int] = set()
    for kind, addresses in state.address.items():
        for address in addresses.tolist():
            for field in TABLE.group(kind).fields:
                k = state.layout[kind].offset[field.name]
                width = field.count * (state.ratio if field.real else 1)
                first = address - 1 + ((k - 1) * state.ratio if field.real else k)
                found += [Word(_what(field), first + i, field, kind, address) for i in range(width)]
                taken.update(range(first, first + width))
    for group, links in _junk(state):
        found += [Word("junk", group - 1 + k, None, "junk", group) for k in links]
        taken.update(group - 1 + k for k in links)
    spare = set(range(state.free - 1)) - taken
    return found + [Word("spare", place) for place in sorted(spare)]


def _what(field: Field) -> str:
    if field.role == "head" and field.target is None:
        return "head"
    if field.real:
        return "real"
    if field.target is not None or field.name == "JUNK":
        return "pointer"
    return "note" if field.name in NOTES else "count" if field.name in COUNTS else "code"


def _junk(state: State) -> list[tuple[int, list[int]]]:
    """Address of each junk group, and which of its words have a meaning."""
    found = []
    first = state.common("JUNK")
    ratio = state.ratio.bit_length() - 1
    following, size, sizes = (offset[ratio] for offset in (JNEXT, JSIZE, JSIZES))
    while first:
        group = first
        while group:
            found.append((group, [following, size, sizes] if group == first else [following, size]))
            group = int(state.h.ia[group - 1 + following])
        first = int(state.h.ia[first - 1 + sizes])
    return found


def another(rng: Rng, state: State, word: Word, was: int) -> int:
    """A number for the word that is not what was there."""
    top = int(np.iinfo(state.h.ia.dtype).max)
    same = state.address.get(word.field.target or "", ()) if word.field is not None else ()
    bases = same if len(same) and rng.random() < 0.5 else np.concatenate(list(state.address.values()))
    if word.kind != "common" and word.field is not None and not word.field.real and rng.random() < 0.2:
        choices = state.column(word.kind, word.field.name).tolist()  # what it is in another group
    else:
        choices = [0, 1, -1, -was, was + 1, was - 1, top, -top, int(rng.integers(2, 60)), state.free]
        choices += [int(rng.choice(bases)) for _ in range(len(choices))]
    others = [value for value in choices if value != was and -top <= value <= top]
    return int(rng.choice(others)) if others else 0 if was else 1


Rule = Callable[[State, int, int], bool]  # state, address of the group, the new value


def _of_block(kind: str) -> Rule:
    """The target is a group of `kind` of the block that the condition acts on."""

    def rule(state: State, bound: int, value: int) -> bool:
        row = int(state.rows(kind, np.array([value]))[0])
        return row >= 0 and int(state.owner[kind][row]) == state.get(bound, "KUB")

    return rule


def _other_end(state: State, bound: int, value: int) -> bool:
    """A corner ends two edges. The edge's own other end has a condition that names this one: 0 is none."""
    corner = state.get(bound, "KUP")
    return value != 0 and (state.get(value, "KR") == corner or state.get(corner, "KR") == value)


def _block(state: State, bound: int, value: int) -> bool:
    return state.rows("block", np.array([value]))[0] >= 0 and not state.get(bound, "KUP")


LEGAL: dict[str, tuple[Rule, str]] = {
    "KP": (
        lambda state, block, value: value in state.address["corner"][state.owner["corner"] == block],
        "any corner of the block may be the first of its list",
    ),
    "KDLOOP": (
        lambda state, domain, value: domain in (state.get(value, "KD1"), state.get(value, "KD2")),
        "any contact on the loop may be the one that the domain knows",
    ),
    "KUB": (_block, "a load or a velocity on one block is one on another, if that takes it"),
    "KUG": (_of_block("gridpoint"), "a load on one grid-point is one on another"),
    "KUP": (_of_block("corner"), "a load on one corner is one on another, if the edge ends there"),
    "KUQ": (_other_end, "a load on a corner may count for the edge on its other side"),
    "KUS": (
        lambda state, _, value: not value or state.rows("signal", np.array([value]))[0] >= 0,
        "a condition may follow any signal, or none",
    ),
    "KHG": (
        lambda state, _, value: not value or any(value in at for at in state.address.values()),
        "any group that has the field may be recorded; 0 when it has gone",
    ),
}


def wanted(state: State, word: Word, value: int) -> str:
    """Why `value` may be taken there; empty if it must be refused."""
    if word.what == "count" and word.place == offsets.MTOP and value >= state.free - 1:
        return "IA() has as many words as the file says, if they hold all that are in use"
    if word.what in ("real", "spare", "note"):
        return f"any number: {word.what}"
    if word.what == "code" and word.field is not None:
        return "another code in its range" if allowed(word.field, np.array([value]))[0] else ""
    if word.what == "pointer" and word.field is not None and word.field.name in LEGAL:
        rule, why = LEGAL[word.field.name]
        return why if rule(state, word.group, value) else ""
    return ""


def restart_refuses(array: MainArray, series: Sequence[Series], file: Path) -> bool:
    """True if RESTART does not take the array from a sealed file."""
    save(array, file, series=series)
    try:
        load(file)
    except UdecError as error:
        return error.number == 29
    return False


def damage(model: Model, changes: int, seed: int, file: Path, only: Sequence[str] = ()) -> list[str]:
    """Print what became of the changes, by what the words are. Returns those wrongly taken.

    only: keys of PARTS; all if there are none.
    """
    rng, array, series = np.random.default_rng(seed), model.array, model.histories()
    state = State(array)
    by_what: dict[str, list[Word]] = {}
    for word in words(state):
        by_what.setdefault(word.what, []).append(word)
    parts = {what: share for what, share in PARTS.items() if not only or what in only}
    shares = np.array([*parts.values()]) / sum(parts.values())
    tried: Counter[str] = Counter()
    refused: Counter[str] = Counter()
    named: Counter[str] = Counter()
    taken: Counter[tuple[str, str]] = Counter()
    faults: list[str] = []
    for number in range(changes):
        what = str(rng.choice(list(parts), p=shares))
        word = by_what[what][int(rng.integers(len(by_what[what])))]
        name = word.field.name if word.field is not None else what
        changed = array.copy()
        memory = changed.h.ci if word.kind == "common" and word.field is not None else changed.h.ia
        was = int(memory[word.place])
        value = another(rng, state, word, was)
        memory[word.place] = value
        tried[what] += 1
        broken = bool(check_links(changed))
        if word.kind == "common" and name == "MTOP":  # to this the file itself is the only witness
            broken = restart_refuses(changed, series, file)
        elif number % (REFUSED if broken else TAKEN) == 0:
            unsound = broken or bool(check(changed))  # RESTART makes all proofs
            assert unsound == restart_refuses(changed, series, file), (word, was, value)
        if broken:
            refused[what] += 1
            continue
        why = wanted(state, word, value)
        taken[name if what in ("pointer", "code", "count") else what, why] += 1
        named[what] += bool(check(changed))
        if not why:
            faults.append(f"{name} of {word.kind}@{word.group} {was} -> {value} was taken")
    print("| word | changed | refused | taken | of these named by check |\n|---|---|---|---|---|")
    for what in parts:
        print(f"| {what} | {tried[what]} | {refused[what]} | {tried[what] - refused[what]} | {named[what]} |")
    for (name, why), count in sorted(taken.items()):
        print(f"taken {count} times: {name}: {why or 'SHOULD HAVE BEEN REFUSED'}")
    return faults


def main() -> int:
    """Print the table and the faults; 1 if there are any."""
    parser = argparse.ArgumentParser(description="Change single words of restart files; see them refused.")
    parser.add_argument("--changes", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--build", choices=list(ALL_SCHEMES), default=DEFAULT_SCHEME)
    parser.add_argument("--only", nargs="+", choices=[*PARTS], default=[], help="words of these kinds alone")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        model = every_kind(options.build, Path(folder))
        found = model.check()
        faults = damage(model, options.changes, options.seed, Path(folder) / "damaged.h5", options.only)
    print(*found, *faults, sep="\n")
    return 1 if faults or found else 0
