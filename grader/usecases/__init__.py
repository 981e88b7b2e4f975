"""The work of each command, without typer and without printing: the command passes the functions that print."""
