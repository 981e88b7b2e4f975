"""Regular expressions that are compiled when they are first used.

A command uses a third of the patterns that its modules have, and compiling one costs as much as
loading a small module.
"""

import re
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    on_use = re.compile
else:

    class on_use:  # noqa: N801  called as re.compile() is
        """A pattern with the methods of `re.Pattern`; a mistake in it is found at its first use."""

        def __init__(self, pattern: Any, flags: int = 0) -> None:
            self._given = (pattern, flags)

        def __getattr__(self, name: str) -> Any:
            if name.startswith("_"):
                raise AttributeError(name)
            compiled = re.compile(*self._given)
            # Later uses find the methods of the compiled pattern without this one.
            for method in ("search", "match", "fullmatch", "finditer", "findall", "sub", "split"):
                setattr(self, method, getattr(compiled, method))
            return getattr(compiled, name)
