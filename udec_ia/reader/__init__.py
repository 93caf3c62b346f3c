"""Reading the heap: lists, tables of groups, what each word is, conditions on groups, and places by name."""
