"""Studies of decks: sweeps, what accuracy costs (trade), problems with exact answers, two runs compared."""
