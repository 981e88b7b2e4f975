"""A run over a class: the batch, the work of a worker process, and a Dask cluster."""
