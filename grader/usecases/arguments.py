"""The arguments of xacro that a user gives."""

from collections.abc import Sequence

from grader.errors import GraderError


def read_arguments(texts: Sequence[str]) -> dict[str, str]:
    """Return the values that `--arg` gives arguments of xacro, by their names. Raises GraderError."""
    arguments: dict[str, str] = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if not equals or not name.removesuffix(":"):
            raise GraderError(f"--arg takes NAME=VALUE, an argument of the xacro file, not {text!r}")
        arguments[name.removesuffix(":")] = value  # NAME:=VALUE, as xacro takes it
    return arguments
