"""Model operations: what the commands do to the heap. Each takes a MainArray and raises UdecError."""
