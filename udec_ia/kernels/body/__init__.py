"""Motion and deformation of blocks: law of motion, zones, boundary conditions, loads (report 2.6, 2.9)."""
