"""Faults of the system at every call that a command makes: see `python -m tests.faults --help`."""
