"""The corner tables of Appendix IV-2, as printed, and the same by counting words on one's fingers."""

from __future__ import annotations

# Offsets used in the program: integers count from 0, reals from 1. (page 66)
TWO_INTEGERS_TO_A_REAL = {
    "<head code>": 0,
    "KL": 1,
    "KR": 2,
    "KNB": 3,
    "KXP": 3,
    "KYP": 4,
    "KXCP": 5,
    "KYCP": 6,
    "KRAD": 7,
    "KXDP": 8,
    "KYDP": 9,
    "KGP": 18,
}
ONE_INTEGER_TO_A_REAL = {
    "<head code>": 0,
    "KL": 1,
    "KR": 2,
    "KNB": 3,
    "KXP": 5,
    "KYP": 6,
    "KXCP": 7,
    "KYCP": 8,
    "KRAD": 9,
    "KXDP": 10,
    "KYDP": 11,
    "KGP": 11,
}


def count_words(fields: list[tuple[str, bool, int]], ratio: int) -> tuple[dict[str, int], int]:
    """Offsets of (name, is real, how many), and the size of the group, filling one word after the other.

    Every word of the group is a list entry; a real begins only where a whole number of reals has gone
    before, and the group ends only there too, so pads are put in until that is so.
    """
    words: list[str] = []
    offset = {}
    for name, is_real, count in fields:
        while is_real and len(words) % ratio != 0:
            words.append("pad")
        offset[name] = len(words) // ratio + 1 if is_real else len(words)
        words.extend([name] * (count * ratio if is_real else count))
    while len(words) % ratio != 0:
        words.append("pad")
    return offset, len(words)
