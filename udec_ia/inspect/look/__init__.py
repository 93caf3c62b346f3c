"""Looking into a heap, sound or damaged: what each word is, what leads to it, and how full the memory is."""
