"""The debugger: a run that can be stopped, looked at, and gone back in.

What has happened is a row of events: a command is one, and each cycle of a run is one. Copies of the array
are kept at some of them; the others are reached from there by going through the cycles once more, which gives
the same words bit for bit. A cycle in question is gone through as Python, on a memory that tells of every
word that is read or written: so each value has a writer, and a reason.
"""

from udec_ia.debug.console import Console, debug
from udec_ia.debug.session import Debugger

__all__ = ["Console", "Debugger", "debug"]
