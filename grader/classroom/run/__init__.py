"""A run over a class: the batch, its worker processes, and the work that they do."""
