"""How GENERATE ... AUTOMATIC divides an outline into zones: plain geometry, no heap."""
