"""Runs of cycles: time-step, CYCLE and SOLVE, recording, replay, scaled masses, static relaxation."""
