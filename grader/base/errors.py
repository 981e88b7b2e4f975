"""The exceptions that a user can see. Each prints as one line."""

import errno

from grader.base.grouping import Strings

# Why a file itself cannot be opened. Other errors, such as EIO, EMFILE and ESTALE, are faults of
# the machine.
_OF_FILES = (
    None,
    errno.EACCES,
    errno.EINVAL,
    errno.EISDIR,
    errno.ELOOP,
    errno.ENAMETOOLONG,
    errno.ENODEV,
    errno.ENOENT,
    errno.ENOTDIR,
    errno.ENXIO,
    errno.EILSEQ,
    errno.EOPNOTSUPP,
    errno.EPERM,
)
_ADVICE = "a fault of this machine's disk or network: try again"


class GraderError(Exception):
    """An error that stops a command before it has graded: exit code 2. The message is for people.

    >>> import grader
    >>> grader.grade("absent.urdf")
    Traceback (most recent call last):
    grader.base.errors.NotThereError: absent.urdf does not exist (relative to the current folder)
    """


class InputError(GraderError):
    """A path that cannot be read: missing, a folder without a URDF, too large, not a file."""


class NotThereError(InputError):
    """A path of the command line that does not exist; `hint` may name the one that is meant."""

    def __init__(self, path: str, hint: str) -> None:
        super().__init__(path, hint)
        self.path = path
        self.hint = hint

    def __str__(self) -> str:
        return f"{self.path} does not exist{self.hint}"


class FileError(InputError):
    """A file that cannot be read.

    The message is its path and the reason: `a.zip` and `is encrypted`.
    """

    def __init__(self, path: str, reason: str) -> None:
        super().__init__(path, reason)
        self.path = path
        self.reason = reason

    def __str__(self) -> str:
        return f"{self.path} {self.reason}"


class RecordingError(InputError):
    """Why a recording of `ros2 bag record` cannot be read.

    With `is_limit`, a program that reads more might read it, so a person has to look.
    """

    def __init__(self, message: str, *, is_limit: bool = False) -> None:
        super().__init__(message)
        self.is_limit = is_limit


class MachineError(GraderError):
    """A fault of the machine while a submission is read, as of its disk.

    It says nothing about the submission.
    """

    @classmethod
    def check(cls, error: BaseException | None, shown: str) -> None:
        """Raise MachineError for the error of a file or archive if the file is not the cause."""
        while error is not None:
            if isinstance(error, OSError) and error.errno not in _OF_FILES:
                raise cls(f"cannot read {shown}: {error.strerror} ({_ADVICE})") from None
            error = error.__context__  # zipfile raises BadZipFile for a file that cannot be read


class RubricError(GraderError):
    """A rubric that cannot be used. `complaints` has one line for each mistake in it.

    >>> import grader
    >>> grader.load_rubric("lab66")
    Traceback (most recent call last):
    grader.base.errors.RubricError: there is no rubric 'lab66'; did you mean 'lab6'? ...
    """

    def __init__(self, complaints: Strings) -> None:
        super().__init__("\n".join(complaints))
        self.complaints = complaints


class OutOfTime(BaseException):
    """The processor time of a command is used up.

    Like Ctrl-C it passes the handlers of faults in files and checks.
    """


class NotDecided(LookupError):
    """Something that cannot be determined statically, and needs manual grading.

    The message says why.

    `cause` is the reason without what differs between students, such as the names of their files;
    default: the message.
    """

    def __init__(self, message: str, cause: str = "") -> None:
        super().__init__(message)
        self.cause = cause or message


class MissingElement(LookupError):
    """Something that a check needs does not exist.

    This is, for example, a link, a shape, a chain of joints, or a defined pose.

    `kind` and `name` are equal for checks that fail for the same reason; the kinds `URDF` and
    `package` are those of work that a submission lacks, where evidence may take its place. `known`
    lists the names that exist; `location` is a Location or LazyLocation in the file, or None. The
    text is the message and the detail, which is what differs between students who made the same
    mistake; `mistake` is the message alone. `problem`, `absent` and `cause` are those of an
    Outcome. What fails for the same reason later is skipped, or with `costs_once` not deducted.

    >>> MissingElement("link", "lidra", ("base_link", "lidar"))
    MissingElement("there is no link 'lidra'; the file has: 'base_link', 'lidar'")
    """

    def __init__(
        self,
        kind: str,
        name: str,
        known: Strings = (),
        *,
        message: str = "",
        detail: str = "",
        location: object = None,
        problem: str = "",
        costs_once: bool = False,
        absent: str = "",
        cause: str = "missing",
    ) -> None:
        self.kind = kind
        self.name = name
        self.known = known
        self.location = location
        self.problem = problem
        self.costs_once = costs_once
        self.absent = absent
        self.cause = cause
        self.mistake = message or f"there is no {kind} {name!r}"
        if not message:
            detail = f"; the file has: {', '.join(map(repr, known[:20])) or 'none'}"
        super().__init__(self.mistake + detail)
