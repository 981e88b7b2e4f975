"""What each command does, without typer and without printing."""
