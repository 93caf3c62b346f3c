"""Scenes at the extremes, one study a file: docs/stability.md."""
