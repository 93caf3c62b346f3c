"""What is done to a good restart file to make it hostile, for tools/hostile.py."""
