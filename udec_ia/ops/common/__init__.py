"""What commands share: limits of numbers, walks, memory, ranges, forces after a change."""
