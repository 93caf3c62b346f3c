"""What the checker goes through by brute force: it shares no routine with what it judges."""
