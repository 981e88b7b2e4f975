"""Convert Word and PDF files in this process, without the limits of a converter's own."""

import io
import sys
import warnings
from types import SimpleNamespace
from unittest.mock import patch

from grader.lab.documents import converter


def convert_here(_documents: object, command: list[str], data: bytes) -> tuple[int, bytes]:
    """Return the exit code and the output of a converter, as `DocumentCollection._run` does."""
    given, output = (SimpleNamespace(buffer=io.BytesIO(each)) for each in (data, b""))
    with (
        patch.object(sys, "argv", command[2:]),
        patch.multiple(sys, stdin=given, stdout=output, stderr=io.StringIO()),
        patch.multiple(converter, _end_with_parent=lambda *_: None, _limit=lambda _: None),
        warnings.catch_warnings(action="ignore"),
    ):
        code = converter.main()
    return code, output.buffer.getvalue()
