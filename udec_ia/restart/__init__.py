"""SAVE and RESTART: the whole state in one file that describes itself.

The state of a run is the heap up to MFREE and the common block, so that is what a restart file holds,
bit for bit, next to the table that says what every word means. A restart file is an HDF5 file behind a
seal, a short text that holds the checksum of the rest: a file that is foreign, cut short or changed in
any byte is refused before a word of it is believed. `docs/restart-format.md` is the full description.
"""

from udec_ia.restart.file_summary import info
from udec_ia.restart.restart_reader import deck_in, load, look_into, read_stored_state
from udec_ia.restart.restart_writer import load_to_change, save, save_changed

__all__ = [
    "deck_in",
    "info",
    "load",
    "load_to_change",
    "look_into",
    "read_stored_state",
    "save",
    "save_changed",
]
