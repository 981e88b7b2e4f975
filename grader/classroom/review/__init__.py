"""Grade criteria manually, in a browser."""
