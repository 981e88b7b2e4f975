"""What xacro asks of the files around a URDF."""

from collections.abc import Callable, Collection
from typing import TypeVar, cast

from grader.base.errors import InputError, NotDecided
from grader.base.reuse import Answers
from grader.ros.python.budget import Budget
from grader.ros.python.values import Undetermined
from grader.ros.xacro.xacro_files import SurroundingFiles

_T = TypeVar("_T")


class RecordedFiles:
    """Files around a URDF whose answers are recorded.

    With the same answers, xacro expands it alike.
    """

    def __init__(self, answers: Answers[SurroundingFiles], budget: Budget) -> None:
        self._answers = answers
        self.budget = budget

    @property
    def paths(self) -> Collection[str]:
        """The paths of the files."""
        return self._answers.ask(lambda files: tuple(files.paths))

    @property
    def is_part(self) -> bool:
        """Whether the files may be a part of any package."""
        return self._answers.ask(lambda files: files.is_part)

    @property
    def called(self) -> str:
        """What messages call the files."""
        return self._answers.ask(lambda files: files.called)

    def ask(self, name: str) -> object:
        """Note the name of a file that is looked for."""
        return self._answers.ask(lambda files: files.ask(name))

    def package(self, name: str) -> str | None:
        """Return the folder of a package."""
        return self._answers.ask(lambda files: files.package(name))

    def read(self, path: str) -> bytes:
        """Return the bytes of a file. Raises InputError, NotDecided."""
        return self._try(lambda files: files.read(path))

    def installed(self, package: str, inside: str) -> str | None:
        """Return the file that a build installs at a path in a package. Raises Undetermined."""
        return self._try(lambda files: files.installed(package, inside))

    def _try(self, question: Callable[[SurroundingFiles], _T]) -> _T:
        """Return the answer to a question, or raise what it raises, which is recorded too."""
        raised = []

        def ask(files: SurroundingFiles) -> _T | tuple[type, str]:
            try:
                return question(files)
            except (InputError, NotDecided, Undetermined) as error:
                raised.append(error)
                return type(error), str(error)

        answer = self._answers.ask(ask)
        for error in raised:
            raise error
        return cast("_T", answer)
