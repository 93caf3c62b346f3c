"""What the debugger costs: a run that is recorded over one that is not, and how long it takes to go back.

python tools/bench.py debugger examples/collapse.dat --words 40
"""

from __future__ import annotations

import argparse
import io
import re
import tempfile
import time
from pathlib import Path

import numpy as np

from udec_ia import Model
from udec_ia.debug.debugged_run import Debugger
from udec_ia.debug.stop_conditions import WordChange
from udec_ia.debug.word_history import explain_write, find_last_hit
from udec_ia.deck.command_monitor import Monitor
from udec_ia.deck.deck_statements import statements
from udec_ia.heap.word_scheme import ALL_SCHEMES, DEFAULT_SCHEME
from udec_ia.layout import offsets as g
from udec_ia.reader.place_grammar import find_number
from udec_ia.reader.word_map import KINDS, TABLE, Atlas

QUIET = re.compile(r"(PLOT|PRINT|SAVE|STOP|END)\b.*", re.IGNORECASE)  # commands that do not run


def plain(text: str, build: str, out: Path) -> float:
    """Seconds that the deck takes."""
    start = time.perf_counter()
    Monitor(Model(build, out=out), io.StringIO()).run(text.splitlines(), "deck")
    return time.perf_counter() - start


def recorded(text: str, build: str, out: Path) -> tuple[float, Debugger]:
    """The same under the debugger."""
    debugger = Debugger(Model(build, out=out), io.StringIO(), lambda told: None)
    start = time.perf_counter()
    debugger.run(list(statements(text.splitlines(), "deck")))
    return time.perf_counter() - start, debugger


def seconds_back(debugger: Debugger, words: int, seed: int) -> dict[str, list[float]]:
    """Seconds of going back: a step from anywhere, to the last change of words, and to who wrote them."""
    timeline, rng = debugger.timeline, np.random.default_rng(seed)
    found: dict[str, list[float]] = {
        "a step back": [],
        "to the last change of a word": [],
        "who wrote it": [],
    }
    for _ in range(words):
        event = int(rng.integers(timeline.now // 2, timeline.now + 1))
        atlas = Atlas(timeline.at(event).h)
        kind = str(rng.choice([kind for kind in KINDS if len(atlas.groups[kind])]))
        field = TABLE.group(kind).fields[int(rng.integers(len(TABLE.group(kind).fields)))]
        word = find_number(atlas, f"{kind}@{int(rng.choice(atlas.groups[kind]))}.{field.name}")
        jobs = (
            lambda event=event: timeline.at(event - 1),
            lambda event=event, word=word: find_last_hit(timeline, event, WordChange(word)),
            lambda event=event, word=word: list(explain_write(timeline, event, word)),
        )
        for name, job in zip(found, jobs, strict=True):
            start = time.perf_counter()
            job()
            found[name].append(time.perf_counter() - start)
    return found


def main() -> int:
    """Measure, and print a table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("deck", type=Path)
    parser.add_argument("--build", choices=ALL_SCHEMES, default=DEFAULT_SCHEME)
    parser.add_argument("--words", type=int, default=40, help="words that are gone back for")
    parser.add_argument("--runs", type=int, default=7, help="runs of each kind, the fastest counts")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    lines = [line for line in options.deck.read_text().splitlines() if not QUIET.match(line)]
    text = "\n".join(lines)
    with tempfile.TemporaryDirectory() as folder:
        both = []
        for _ in range(options.runs + 1):  # the first ones compile
            seconds, debugger = recorded(text, options.build, Path(folder))
            both.append((plain(text, options.build, Path(folder)), seconds))
        bare, told = (min(column) for column in zip(*both[1:], strict=True))
        timeline = debugger.timeline
        size = sum(copy.size for copy in timeline.copies.values())
        print(
            f"{options.deck.name}, {options.build}: {int(debugger.array.h.ci[g.MCTOT])} cycles, {bare:.3f} s"
        )
        print(f"recorded: {told / bare:.3f} of that, {len(timeline.copies)} copies of {size / 2**20:.1f} MB")
        for name, times in seconds_back(debugger, options.words, options.seed).items():
            print(f"{name}: median {np.median(times):.3f} s, at most {max(times):.3f} s")
    return 0
