"""Random documents of two grammars, in turn: the grader's expansion against that of xacro 2.1.1."""

from collections.abc import Iterator

from tests.differential.compared import Compared
from tests.xacro import collisions, grammar, oracle
from tests.xacro.comparing import difference

_GRAMMARS = (grammar, collisions)


def compare(numbers: range) -> Iterator[Compared]:
    """Compare the expansions of the documents of some seeds."""
    for number in numbers:
        document = _GRAMMARS[number % len(_GRAMMARS)].document(number // len(_GRAMMARS))
        expected = oracle.expand(document)
        try:
            text = difference(document, expected)
        except Exception as error:  # noqa: BLE001 - an expansion never raises, so this is a difference
            text = f"{type(error).__name__}: {error}"
        yield Compared(
            number, "accepted" if isinstance(expected, oracle.Accepted) else "refused", text
        )
