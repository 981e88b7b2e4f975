"""The budget for reading a workspace: the work of documents, expressions and searches."""

from collections.abc import Collection, Iterable, Iterator
from pathlib import PurePosixPath

from grader.ros.python.values import (
    MAX_BITS,
    MAX_PARTS,
    MAX_TEXT,
    OPAQUE,
    PLAIN,
    SCALARS,
    EvaluationSignal,
    Items,
    Namespace,
    PlainFunction,
    Undetermined,
    Value,
    is_object,
    iterate,
    list_parts,
    refuse,
    too_large,
)

READING = 500_000  # parts that reading one workspace may produce or look at: some 0.5 s
# Parts that reading all files of a workspace and comparing their names may take, besides those for
# each package and one for each byte of text: what is large is no attack.
_OF_WORKSPACE = 400_000
_OF_PACKAGE = 10_000
PYTHON_LIMIT = 128 * 1024  # bytes of a file; a syntax tree takes several hundred times as much
_MAX_TEXT = 512 * 1024  # bytes of a text that count
CHARACTERS, _BITS = 16, 256  # that count as one part
_FOLDER = "the name of a folder on the machine is not known"


class OutOfBudget(EvaluationSignal):
    """The budget of a workspace is spent: nothing more of it can be expanded or evaluated."""


def _is_of_size_one(part: Value, kind: str) -> bool:
    """Return whether a part counts as one, whatever it is, where values of a kind may be."""
    if isinstance(part, PLAIN):
        return True
    # A plain function itself refuses the latter.
    return (
        (kind == "text" and is_object(part))
        or (kind == "holds" and isinstance(part, (*OPAQUE, set)))
        or isinstance(part, Items | Namespace | PlainFunction)
    )


class Budget:
    """How many parts may still be produced or looked at, whatever comes of it.

    They are parts of documents, expressions and values.

    They are charged before the work, and counted, so that a result is the same on every machine.
    `stand_ins` are the texts that stand for folders that are not known: no value may depend on
    them. `whole` is the budget of all files of a workspace, to which all is charged as well.
    """

    def __init__(
        self,
        limit: int = READING,
        stand_ins: Collection[str] = (),
        whole: "Budget | None" = None,
    ) -> None:
        self.limit = self.left = limit
        self.stand_ins = stand_ins
        self.whole = whole
        self.apart = 0  # parts that were charged, and are no part of the cost of other work

    @property
    def used(self) -> int:
        """The parts that were charged."""
        return self.limit - self.left

    @property
    def is_spent(self) -> bool:
        """Whether nothing more can be charged."""
        return self.left < 0 or (self.whole is not None and self.whole.left < 0)

    def grow(self, limit: int) -> None:
        """Set another limit, from which what was charged is taken."""
        self.limit, self.left = limit, limit - self.used

    def charge(self, parts: int, characters: int = 0) -> None:
        """Charge parts and characters. Raises OutOfBudget."""
        parts += characters // CHARACTERS
        self.left -= parts
        if self.whole:
            self.whole.left -= parts
        if self.is_spent:
            raise OutOfBudget(
                f"reading this takes more work than one submission may use ({self.limit:,} parts)"
            )

    def take_of_whole(self, parts: int) -> bool:
        """Charge parts to the budget of the workspace alone; return whether they were left."""
        self._take(0, parts)
        return not self.is_spent

    def _take(self, parts: int, of_whole: int) -> None:
        self.left -= parts
        if self.whole:
            self.whole.left -= of_whole

    def mark(self) -> tuple[int, int]:
        """Return the parts that are left, of this budget and of that of all files.

        What is set apart counts as left.
        """
        whole = self.whole
        return self.left + self.apart, whole.left + whole.apart if whole else 0

    def set_apart(self, cost: tuple[int, int]) -> None:
        """Leave work out of the marks that was charged, as two of them tell.

        Who asks first has it done for all others, so it is no part of what else is done then.
        """
        self.apart += cost[0]
        if self.whole:
            self.whole.apart += cost[1]

    def repeat(self, cost: tuple[int, int]) -> bool:
        """Charge again what was charged for the same work, as two marks tell.

        Returns whether it was left.
        """
        cost_here, of_whole = cost
        if cost_here > self.left or (self.whole and of_whole > self.whole.left):
            return False
        self._take(cost_here, of_whole)
        self.set_apart(cost)
        return True

    def measure(self, value: Value, kind: str = "plain") -> int:
        """Charge a value and return its size: its parts, each as often as it occurs.

        Raises Undetermined.

        `kind` is that of the function that is given the value.
        """
        if isinstance(value, SCALARS):
            size = 1 + self._size_alone(value, kind)
            self.charge(size)
            return size
        pending = [value]
        size = 0
        while pending:
            part = pending.pop()
            size += 1 + self._size_alone(part, kind)
            inside = list_parts(part)
            if size + len(pending) + len(inside) > MAX_PARTS:
                too_large("value")
            self.charge(len(inside))
            pending += inside
        self.charge(size)
        return size

    def checked(self, value: Value, kind: str = "holds") -> Value:
        """Return a value that was produced, once it is charged.

        Raises Undetermined for one that is too large.
        """
        if type(value) not in (float, bool):
            self.measure(value, kind)
        if self.stand_ins and kind == "path":
            self.rooted(value)
        return value

    def rooted(self, value: Value) -> Value:
        """Return a text or path in which a stand-in is at most the beginning.

        Raises Undetermined.
        """
        for text in map(str, value if isinstance(value, tuple) else [value]):
            for stand_in in self.stand_ins:
                rest = text.removeprefix(stand_in)
                if stand_in.strip("/") in rest or (
                    rest != text and not rest.startswith("/") and rest
                ):
                    raise Undetermined(_FOLDER)
        return value

    def items(self, value: Value) -> Iterator[Value]:
        """Return what a loop over a value yields: the letters of a text, if they are known.

        Raises Undetermined.
        """
        if isinstance(value, str):
            self.measure(value)
        return iterate(value)

    def is_below(self, before: Value, after: Value) -> bool:
        """Return whether a path is below the folders that are not known, as another one is."""
        return all(stand_in in str(after) for stand_in in self.stand_ins if stand_in in str(before))

    def _size_alone(self, part: Value, kind: str) -> int:
        """Return the size of a part beyond one.

        Raises Undetermined for one that is too large, or not known.
        """
        if isinstance(part, str):
            return self._size_of_text(part, kind)
        if isinstance(part, int):
            if part.bit_length() > MAX_BITS:
                too_large("number")
            return part.bit_length() // _BITS
        if isinstance(part, PurePosixPath):
            return self._size_of_text(str(part), kind)
        if _is_of_size_one(part, kind):
            return 0
        return refuse(part, f"values of the type {type(part).__name__} are not supported")

    def _size_of_text(self, text: str, kind: str) -> int:
        if len(text) > MAX_TEXT:
            too_large("text")
        if kind == "plain" and any(stand_in in text for stand_in in self.stand_ins):
            raise Undetermined(_FOLDER)
        return len(text) // CHARACTERS


def whole_budget(sizes: Iterable[int], packages: int) -> Budget:
    """Return the budget of all files of a workspace, of texts of these sizes in bytes."""
    fixed = _OF_WORKSPACE + _OF_PACKAGE * packages
    return Budget(fixed + sum(min(size, _MAX_TEXT) for size in sizes))
