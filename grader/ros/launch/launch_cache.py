"""The launch files that were read last, each with what it was answered about the machine."""

from operator import methodcaller
from typing import TYPE_CHECKING, NamedTuple

# Only for types: a rubric makes a cache, and a URDF on its own needs no reader of launch files.
if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from grader.ros.launch.launch_model import Launch, Machine

    # What a launch file is read from: its bytes, its path in the submission, its path below the
    # prefix, and its launch arguments.
    LaunchKey = tuple[bytes, str, str, tuple[tuple[str, str], ...]]

_MAX_KEPT = 4  # launch files


class MachineRecorder:
    """A machine that records what is asked of it. With the same answers, a launch file is
    evaluated alike.
    """

    def __init__(self, machine: "Machine") -> None:
        self._machine = machine
        self._answers: list[tuple[Callable[[Machine], object], object]] = []

    def open_installed(self, path: str) -> tuple[bytes, str] | None:
        """Return an installed file."""
        file = self._machine.open_installed(path)
        self._answers.append((methodcaller("open_installed", path), file))
        return file

    def has_package(self, name: str) -> bool:
        """Return whether a package certainly is on the machine."""
        has_package = self._machine.has_package(name)
        self._answers.append((methodcaller("has_package", name), has_package))
        return has_package

    def misspelt_package(self, name: str) -> str | None:
        """Return the submitted package that a name stands for."""
        meant = self._machine.misspelt_package(name)
        self._answers.append((methodcaller("misspelt_package", name), meant))
        return meant

    def files_in(self, folder: str) -> "Sequence[str] | None":
        """Return the names of the installed files in a folder."""
        names = self._machine.files_in(folder)
        self._answers.append((methodcaller("files_in", folder), names))
        return names

    def has_program(self, package: str, name: str) -> bool | None:
        """Return whether a package has a program."""
        has_program = self._machine.has_program(package, name)
        self._answers.append((methodcaller("has_program", package, name), has_program))
        return has_program

    def is_equal(self, other: "Machine") -> bool:
        """Return whether another machine answers alike."""
        return all(question(other) == answer for question, answer in self._answers)


class KeptLaunch(NamedTuple):
    """A launch file that was read, what it was answered about the machine, and the work that it
    took.
    """

    machine: MachineRecorder
    launch: "Launch"
    cost: int


class LaunchCache:
    """The results of the last launch files of a lab.

    A rubric owns one, which all packages share that are read for it: students hand in the launch
    file of a handout again, and the search for hints reads the same file for each edit.
    """

    def __init__(self) -> None:
        self._kept: dict[LaunchKey, KeptLaunch] = {}

    def find(self, key: "LaunchKey", machine: "Machine") -> KeptLaunch | None:
        """Return the result of a launch file on a machine that answers alike, if it is kept."""
        kept = self._kept.get(key)
        if kept is not None and kept.machine.is_equal(machine):
            return kept
        return None

    def keep(self, key: "LaunchKey", kept: KeptLaunch) -> None:
        """Keep a result, in place of the oldest one."""
        self._kept.pop(key, None)
        if len(self._kept) >= _MAX_KEPT:
            del self._kept[next(iter(self._kept))]
        self._kept[key] = kept
