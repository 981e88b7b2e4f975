"""A fault of the disk in one folder of a class."""

import errno
import os
from pathlib import Path

import pytest

from grader.classroom.intake.listing import FolderListing
from grader.errors import MachineError


def test_only_the_top_folder_stops_a_class(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A folder below it is not taken for an empty one."""
    (tmp_path / "ann").mkdir()
    listing = FolderListing(tmp_path)

    def broken(_: str) -> None:
        raise OSError(errno.EIO, "Input/output error")

    monkeypatch.setattr(os, "scandir", broken)
    assert listing.children("ann").refused == [("", "cannot be read: Input/output error")]
    assert listing.first("ann")
    with pytest.raises(MachineError):
        listing.children("")
