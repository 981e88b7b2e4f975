"""How much a hint tells."""

from typing import Literal, get_args

HintLevel = Literal["none", "place", "cause", "edit"]
LEVELS: tuple[HintLevel, ...] = get_args(HintLevel)  # each tells more than the one before
