"""The deck language: its table, its reader and parser, and the monitor that obeys it (Appendix I-1)."""
