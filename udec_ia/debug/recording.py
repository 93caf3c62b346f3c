"""A recording of a debugged run in one file, to be looked at elsewhere: `record`, `udec debug --replay`.

The file is a zip archive: the deck, recording.json, and the copies of states that the debugger has
(cycle_snapshots.py). From these all other states follow, by repeating cycles, in the same version of the
program with the same field table and the same laws. So another version is refused, and laws of the user are
given again: the file holds their names and checksums, and no program.
"""

from __future__ import annotations

import io
import json
import zipfile
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from udec_ia.debug.cycle_snapshots import BUDGET, CommandSpan, StateCopy, Timeline, copy_state
from udec_ia.errors import UdecError
from udec_ia.file_replacement import put_in_place
from udec_ia.heap.word_scheme import ALL_SCHEMES, Scheme
from udec_ia.layout import offsets as g
from udec_ia.ops.laws.registered_laws import LawBook
from udec_ia.printable_text import printable
from udec_ia.version import __version__

CONTENTS, DECK = "recording.json", "deck.dat"
LARGEST = 20 * BUDGET  # bytes of all states in a recording; the debugger keeps two or more, however large
ORIGIN = {"program": "udec_ia", "version": __version__, "field table": g.DIGEST}
DAMAGED = "make it again with `record` in the debugger"
NOT_READABLE = (
    zipfile.BadZipFile,
    zlib.error,
    KeyError,
    TypeError,
    ValueError,
    OverflowError,
    EOFError,
    RuntimeError,  # an archive with a password
    OSError,  # a seek before its beginning
    NotImplementedError,
)
COMMON = (("ci", g.NCOMI), ("cr", g.NCOMR), ("cd", g.NCOMD))


class Recording(NamedTuple):
    """What a recording holds. deck: its lines; name: its file; values: of its variables, as they were given.

    laws: file and checksum by the name of each. build: word scheme. now: the last event.
    """

    name: str
    deck: list[str]
    values: dict[str, str]
    build: str
    laws: dict[str, tuple[str, str]]
    spans: list[CommandSpan]
    now: int
    copies: dict[int, StateCopy]

    def timeline(self, laws: LawBook) -> Timeline:
        """The events, to be repeated with some laws. Error 9 if these are not those of the recording."""
        for law, (origin, digest) in self.laws.items():
            if law not in laws.given:
                detail = f"{law} of {printable(origin)}, with which the recording was made, is not given"
                raise UdecError(9, detail, f"give it again: --constitutive {printable(origin)}")
            if laws.given[law].digest != digest:
                detail = f"{law} of {laws.given[law].origin} is not that of the recording"
                raise UdecError(9, detail, f"give the former {printable(origin)}")
        timeline = Timeline(self.copies[min(self.copies)].array(), laws)
        timeline.restore(self.spans, self.copies, self.now)
        return timeline


def write_recording(
    timeline: Timeline, path: str, name: str, deck: Sequence[str], values: Mapping[str, Any], build: str
) -> Path:
    """Write the run so far to the file `path`, which may replace another recording only. Error 31."""
    image, target = io.BytesIO(), Path(path)
    copies = timeline.copies | {timeline.now: copy_state(timeline.at(timeline.now))}
    if sum(copy.size for copy in copies.values()) > LARGEST:
        detail = f"{printable(path)} would hold states of more than {LARGEST >> 20} MB"
        raise UdecError(31, detail, "hand over the deck, or SAVE a state")
    about = {
        "origin": ORIGIN,
        "name": name,
        "values": {name: str(value) for name, value in values.items()},
        "build": build,
        "laws": timeline.laws.record(),
        "spans": [asdict(one) for one in timeline.spans],
        "now": timeline.now,
        "copies": {event: [copy.scheme.name, copy.fixed] for event, copy in copies.items()},
    }
    with zipfile.ZipFile(image, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(CONTENTS, json.dumps(about, indent=1))
        archive.writestr(DECK, "".join(f"{line}\n" for line in deck))
        for event, copy in copies.items():
            for part, numbers in zip(("ia", "ci", "cr", "cd"), (copy.words, *copy.common), strict=True):
                archive.writestr(f"{event}/{part}", numbers.astype(numbers.dtype.newbyteorder("<")).tobytes())
    put_in_place(target, image.getvalue(), _judge)
    return target


def _judge(front: bytes, _: int) -> str:
    return "" if CONTENTS.encode() in front[:64] else "exists, but is not a recording of the debugger"


def read_recording(path: str | Path) -> Recording:
    """What the file `path` holds. Error 29 if it is damaged, no recording, or one of another version."""
    try:
        with zipfile.ZipFile(path) as archive:
            if CONTENTS not in archive.namelist():
                raise _wrong(path, "is not a recording of the debugger", "record in the debugger writes one")
            if sum(one.file_size for one in archive.infolist()) > LARGEST:
                raise _wrong(path, f"holds more than {LARGEST >> 20} MB, which no recording does", DAMAGED)
            about = json.loads(archive.read(CONTENTS))
            _require_same(path, about["origin"])
            return _recording(archive, about)
    except (FileNotFoundError, PermissionError, IsADirectoryError):
        raise
    except NOT_READABLE as error:
        raise _wrong(path, f"is damaged or no recording of the debugger: {error}", DAMAGED) from error


def _wrong(path: str | Path, what: str, advice: str) -> UdecError:
    return UdecError(29, f"{printable(str(path))} {what}", advice)


def _require_same(path: str | Path, origin: dict[str, str]) -> None:
    """Error 29 unless the recording was made by this version of the program."""
    if origin == ORIGIN:
        return
    made = printable(str(origin["version"]))
    by = f"was made by udec_ia {made}, and this is udec_ia {__version__}"
    if made == __version__:
        by = f"was made by another state of udec_ia {made}, with another field table"
    raise _wrong(
        path, by, f"replay it with that one, or run its deck again: unzip {printable(str(path))} {DECK}"
    )


def _recording(archive: zipfile.ZipFile, about: dict[str, Any]) -> Recording:
    spans = [CommandSpan(**one) for one in about["spans"]]
    copies = {
        int(event): _copy(archive, event, ALL_SCHEMES[build], bool(fixed))
        for event, (build, fixed) in about["copies"].items()
    }
    now = int(about["now"])
    follow_each_other = all(one.last == two.first for one, two in pairwise(spans))
    if not copies or now not in copies or not follow_each_other or (spans and spans[-1].last != now):
        raise ValueError("its events do not fit each other")
    laws = {str(law): (str(origin), str(digest)) for law, (origin, digest) in about["laws"].items()}
    values = {str(name): str(value) for name, value in about["values"].items()}
    deck = archive.read(DECK).decode("utf-8").splitlines()
    return Recording(
        str(about["name"]), deck, values, ALL_SCHEMES[about["build"]].name, laws, spans, now, copies
    )


def _copy(archive: zipfile.ZipFile, event: str, scheme: Scheme, fixed: bool) -> StateCopy:
    """The state at an event. ValueError if its parts do not have the sizes of a state of `scheme`."""

    def part(name: str, kind: Any) -> Any:
        little = np.frombuffer(archive.read(f"{event}/{name}"), kind.newbyteorder("<"))
        return little.astype(kind)

    words = part("ia", scheme.int_type)
    kinds = np.dtype(np.int64), scheme.real_type, np.dtype(np.float64)
    common = tuple(part(name, kind) for (name, _), kind in zip(COMMON, kinds, strict=True))
    if [len(one) for one in common] != [size for _, size in COMMON]:
        raise ValueError("its common block is of another size")
    if not (len(words) == common[0][g.MFREE] - 1 and len(words) <= common[0][g.MTOP] <= LARGEST):
        raise ValueError("its memory is of another size")
    return StateCopy(scheme, fixed, words, common)
