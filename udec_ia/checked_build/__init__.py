"""The checked build: kernels that test every address before they use it. Imported only when it is on."""
