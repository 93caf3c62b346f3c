"""The debugger: stops a run, shows its state, and goes back in it.

A run is a sequence of events: each command is one, and each cycle is one. Copies of the array are kept at
some events. The others are reached by repeating the cycles after a copy, which gives the same words bit for
bit. A cycle is examined by repeating it as Python on a memory that reports every access: so each value has a
writer and an origin.
"""

from udec_ia.debug.debugged_run import Debugger
from udec_ia.debug.debugger_prompt import Console, debug, replay
from udec_ia.debug.recording import read_recording

__all__ = ["Console", "Debugger", "debug", "read_recording", "replay"]
