"""The Python interface: Model, one class with a method for every command of the deck language.

model.py: the methods. model_session.py: the session, which holds the array and all that goes with it.
saved_states.py: SAVE and RESTART. undo.py: how a command is undone. command_log.py: the session as a deck.
history_recorder.py: what was recorded.
"""

from udec_ia.model.model import Model

__all__ = ["Model"]
