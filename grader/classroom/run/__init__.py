"""Grade a class in worker processes, and keep the results."""
