"""Patterns that are compiled when they are first used."""

import importlib
import re
import sys

import pytest

from grader.base.patterns import on_use
from tests.test_architecture import MODULES


def test_a_pattern_has_the_methods_of_a_compiled_one() -> None:
    """It finds what the pattern of the standard library finds, at the first use and later."""
    late, compiled = on_use(r"(\w)(\d)", re.IGNORECASE), re.compile(r"(\w)(\d)", re.IGNORECASE)
    for _ in range(2):
        assert late.findall("a1 b2") == compiled.findall("a1 b2")
        assert late.sub("x", "a1 b2") == compiled.sub("x", "a1 b2")
    assert (late.pattern, late.flags) == (compiled.pattern, compiled.flags)
    with pytest.raises(AttributeError):
        late.nothing_like_it  # type: ignore[attr-defined]  # noqa: B018


@pytest.mark.slow
def test_each_pattern_is_one() -> None:
    """Every pattern of every module compiles, without a warning."""
    count = 0
    for module in MODULES:
        if module.endswith(("__main__", "on_gradescope")):
            continue
        importlib.import_module(module)
        for value in vars(sys.modules[module]).values():
            if type(value).__name__ == "on_use":
                count += bool(value.pattern)
    assert count > 500
