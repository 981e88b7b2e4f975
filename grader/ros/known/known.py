"""What is known of packages that are not submitted, in known.toml with its sources."""

import tomllib
from functools import cache
from pathlib import Path
from typing import Any


@cache
def known() -> dict[str, Any]:
    """Return the table."""
    return tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))
