"""What to change in the user's deck and on the command line for a setting, statement by statement."""

from __future__ import annotations

from dataclasses import replace

from udec_ia.deck.deck_statements import CONTINUATION, Statement, obeyed
from udec_ia.trade.judge import Row
from udec_ia.trade.levers import Setting
from udec_ia.trade.trade import Price


def changes(price: Price, row: Row) -> list[str]:
    """--build and the lines to change. What stands there is that of the deck as it is, or it is not named."""
    deck, fraction = price.deck, price.fraction
    before = deck.pieces(Setting(row.setting.build), None, fraction)
    numbers = replace(row.numbers, limits=())  # a SOLVE may take as long as it does
    after = deck.pieces(row.setting, numbers, fraction)
    found = [f"--build {row.setting.build}"]
    own = deck.text.splitlines()
    for old, new in zip(before, after, strict=True):
        if old.lines == new.lines:
            continue
        if new.one is None:
            found += [f"after line {new.number}: {line}" for line in new.lines]
        else:
            found.append(_instead(new.one, own, new.lines))
    return found


def _instead(one: Statement, own: list[str], new: list[str]) -> str:
    """The lines with the words of a statement, from the first to the last, and what they have to be."""
    held = {token.line.number for token in one.tokens}
    first, last = min(held), max(held)
    lines = f"line {first}" if first == last else f"lines {first}-{last}"
    old = " ".join(own[number - 1].strip() for number in range(first, last + 1) if number in held)
    begin = first - one.lines[0].number
    texts = (obeyed(text).strip() for text in new[begin : begin + last - first + 1])
    return f"{lines}: {old} -> {' '.join(text.removeprefix(CONTINUATION).strip() for text in texts if text)}"
