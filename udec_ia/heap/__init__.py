"""The heap: IA(), FIND and LOSE, and the accessors. Nothing above this layer indexes the array itself."""
