"""How much a hint tells.

It is a module of its own because the command line needs it before anything is read.
"""

from typing import Literal, get_args

HintLevel = Literal["none", "place", "cause", "edit"]
LEVELS: tuple[HintLevel, ...] = get_args(HintLevel)  # each tells more than the one before
