"""What each command does, without typer and without printing: warnings go to a function that the command passes."""

from collections.abc import Callable

Warn = Callable[[str], None]
