"""How much a hint tells."""

from typing import Literal, get_args

Level = Literal["none", "place", "cause", "edit"]
LEVELS: tuple[Level, ...] = get_args(Level)  # each tells more than the one before
