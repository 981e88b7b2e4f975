"""The folder or zip with the submissions of a class. Nothing is extracted."""

import os
from pathlib import Path

from grader.errors import InputError
from grader.files.class_folder import ClassDirectory
from grader.files.class_zip import ClassZip
from grader.files.opening import archive_kind
from grader.files.reading import not_there, read_start
from grader.text import printable_path

ClassListing = ClassDirectory | ClassZip


def listing_of(path: Path) -> ClassListing:
    """Return the listing of a class folder or zip; raises InputError if it is neither."""
    shown = printable_path(path)
    try:
        if path.is_dir():
            return ClassDirectory(path)
        exists = os.path.lexists(path)
    except (OSError, ValueError) as error:
        raise InputError(f"cannot read {shown}: {error}") from None
    if not exists:
        raise not_there(path)
    if archive_kind(read_start(path, 512)) != "zip":
        raise InputError(
            f"{shown} is neither a folder nor a zip: name the folder that holds the class's submissions"
            " (`grader grade` grades a single one)"
        )
    return ClassZip(path)
