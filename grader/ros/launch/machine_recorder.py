"""What a launch file asks of the machine on which it runs."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from grader.base.reuse import Answers
    from grader.ros.launch.launch_model import Machine


class MachineRecorder:
    """A machine whose answers are recorded.

    With the same answers, a launch file is evaluated alike.
    """

    def __init__(self, answers: "Answers[Machine]") -> None:
        self._answers = answers

    def open_installed(self, path: str) -> tuple[bytes, str] | None:
        """Return an installed file."""
        return self._answers.ask(lambda machine: machine.open_installed(path))

    def has_package(self, name: str) -> bool:
        """Return whether a package certainly is on the machine."""
        return self._answers.ask(lambda machine: machine.has_package(name))

    def misspelt_package(self, name: str) -> str | None:
        """Return the package of the workspace that a name stands for."""
        return self._answers.ask(lambda machine: machine.misspelt_package(name))

    def files_in(self, folder: str) -> "Sequence[str] | None":
        """Return the names of the installed files in a folder."""
        return self._answers.ask(lambda machine: machine.files_in(folder))

    def has_program(self, package: str, name: str) -> bool | None:
        """Return whether a package has a program."""
        return self._answers.ask(lambda machine: machine.has_program(package, name))
