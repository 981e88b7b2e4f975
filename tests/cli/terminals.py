"""Pseudo-terminals, which a container or a changed root may lack."""

import os
import pty

import pytest


def _can_open() -> bool:
    """Tell whether the machine gives a program a pseudo-terminal."""
    try:
        ends = pty.openpty()
    except OSError:
        return False
    for end in ends:
        os.close(end)
    return True


needs_terminal = pytest.mark.skipif(
    not _can_open(), reason="needs a pseudo-terminal: is /dev/pts mounted?"
)
