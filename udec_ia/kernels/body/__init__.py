"""What a block does: law of motion, zones, laws, boundary conditions, loads (report 2.6, 2.9)."""
