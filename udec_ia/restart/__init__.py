"""SAVE and RESTART: the whole state in one file that describes itself.

The state of a run is the heap up to MFREE and the common block. A restart file holds these, bit for bit, and
the table that defines every word. It is an HDF5 file behind a seal, a short text with the checksum of the
rest: a file that is foreign, cut short or changed in any byte is refused before a word of it is used.
docs/restart-format.md is the full description.
"""

from udec_ia.restart.file_summary import info
from udec_ia.restart.restart_reader import deck_in, load, look_into, read_stored_state
from udec_ia.restart.restart_writer import load_to_change, restart_image, save, save_changed
from udec_ia.restart.stage_file import add_stage

__all__ = [
    "add_stage",
    "deck_in",
    "info",
    "load",
    "load_to_change",
    "look_into",
    "read_stored_state",
    "restart_image",
    "save",
    "save_changed",
]
