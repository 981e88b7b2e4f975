"""What the docstring of a check says, however a plug-in writes it."""

import pytest

from grader.lab.checks.check import Documentation, documentation

pytestmark = pytest.mark.slow

WHOLE = """A robot has wheels.

    They may be
    small.

    Args:
        link: The link.
        tolerance (float, optional): How far it may be off,
            in metres: 0.1 is much.

        *names: The names.

    Returns:
        nothing: at all.
    """
FACT = "A robot has wheels."


@pytest.mark.parametrize(
    ("docstring", "paragraphs", "arguments"),
    [
        (
            WHOLE,
            (FACT, "They may be small."),
            {
                "link": "The link.",
                "tolerance": "How far it may be off, in metres: 0.1 is much.",
                "names": "The names.",
            },
        ),
        ("A robot\n    has wheels.\n    ", (FACT,), {}),
        (
            "\n    Arguments:\n      link:   The link.\n      - not: one\n    ",
            (),
            {"link": "The link."},
        ),
        (f"{FACT}\n\n    Args:\n    ", (FACT,), {}),
        (f"{FACT}\n\n    Args: of what?", (FACT, "Args: of what?"), {}),
        ("", (), {}),
        (None, (), {}),
    ],
)
def test_a_docstring_is_split(
    docstring: str | None, paragraphs: tuple[str, ...], arguments: dict[str, str]
) -> None:
    """The fact, the other paragraphs and the arguments are found; other sections are none of them."""

    def check() -> None: ...

    check.__doc__ = docstring
    assert documentation(check) == Documentation(paragraphs, arguments)
    assert documentation(check).fact == next(iter(paragraphs), "")
