"""A run over a class: the batch, its processes, and what a worker does."""
