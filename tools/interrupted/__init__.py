"""Interrupts inside commands, of processes and of SAVE, for tools/interrupts.py."""
