"""The calculation cycle: order of the passes, damping, time-step limits, the end of a run."""
