"""The deck language: its table, its reader and parser, and the monitor that executes it (Appendix I-1)."""
