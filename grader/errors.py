"""The exceptions that a user can meet. Each prints as one clear line."""


class GraderError(Exception):
    """Anything that stops a command before it has graded: exit code 2."""


class InputError(GraderError):
    """What was named cannot be read: missing, a folder without a URDF, too large, not a file."""


class FileError(InputError):
    """A file that cannot be read; the message is its path and the reason: `a.zip` and `is encrypted`."""

    def __init__(self, path: str, reason: str) -> None:
        super().__init__(path, reason)
        self.path = path
        self.reason = reason

    def __str__(self) -> str:
        return f"{self.path} {self.reason}"


class RubricError(GraderError):
    """A rubric that cannot be used. `complaints` holds one line for each mistake in it."""

    def __init__(self, complaints: tuple[str, ...]) -> None:
        super().__init__("\n".join(complaints))
        self.complaints = complaints


class NotDecided(LookupError):
    """What a question asks cannot be told by the grader: a person has to look. The message says why."""


class MissingElement(LookupError):
    """Something that a question needs is not there: a link, a shape, a chain of joints, a defined pose.

    `kind` and `name` are alike for questions that fail for the same reason; `known` names what there is instead;
    `location` is the spot in the file to look at, or None. The text is the message and the detail, which is what differs
    between students who made the same mistake; `mistake` is the message alone.
    """

    def __init__(
        self,
        kind: str,
        name: str,
        known: tuple[str, ...] = (),
        *,
        message: str = "",
        detail: str = "",
        location: object = None,
    ) -> None:
        self.kind = kind
        self.name = name
        self.known = known
        self.location = location
        self.mistake = message or f"there is no {kind} {name!r}"
        if not message:
            detail = f"; the file has: {', '.join(map(repr, known[:20])) or 'none'}"
        super().__init__(self.mistake + detail)
