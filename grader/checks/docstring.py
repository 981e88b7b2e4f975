"""What the docstring of a check says: the fact that it tests, and the meaning of each argument (Google style)."""

import inspect
import re
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

_SECTION = re.compile(r"^(Args|Arguments|Examples?|Notes?|Raises|Returns):\s*$", re.MULTILINE)
_ARGUMENT = re.compile(r"^\*{0,2}(\w+)(?:\s*\([^)]*\))?:\s+")


class Documentation(NamedTuple):
    """The paragraphs of a docstring before its first section, a fact first; the meaning of each argument."""

    paragraphs: tuple[str, ...]
    arguments: Mapping[str, str]

    @property
    def fact(self) -> str:
        """The first paragraph, in one line."""
        return self.paragraphs[0] if self.paragraphs else ""


def documentation(function: Callable[..., Any]) -> Documentation:
    """Return what the docstring of a function says; a function without one, or without `Args:`, has empty parts."""
    text, *sections = _SECTION.split(inspect.getdoc(function) or "")
    named = dict(zip(sections[::2], sections[1::2], strict=True))
    paragraphs = tuple(_one_line(paragraph) for paragraph in text.split("\n\n") if paragraph.strip())
    return Documentation(paragraphs, _arguments(inspect.cleandoc(named.get("Args", named.get("Arguments", "")))))


def _arguments(section: str) -> dict[str, str]:
    """Return the entries of an `Args:` section by name; an entry continues on lines that are indented further."""
    entries = (_ARGUMENT.split(entry) for entry in re.split(r"\n(?=\S)", section))
    return {found[1]: _one_line(found[2]) for found in entries if len(found) == 3}


def _one_line(text: str) -> str:
    return " ".join(text.split())
