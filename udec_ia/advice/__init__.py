"""Advice on runs: warnings before and during a run, and the diagnosis of how a SOLVE ended."""
