"""Edits of the files of a workspace such as people make: of a word, a line, a file."""

import random
import re
from pathlib import Path

from grader.files.opening import open_tree
from grader.files.reading import URDF_LIMIT

Files = dict[str, bytes]
_WORD = re.compile(rb"[\w.]+")
_MAX_REPEATED = 3


def files_of(folder: Path) -> Files:
    """Return the files of a folder, by their paths in it."""
    tree = open_tree(folder)
    assert tree is not None
    return {path: file.read(URDF_LIMIT) for path, file in tree.files.items()}


def edited_text(data: bytes, draw: random.Random) -> bytes:
    """Return a text after an edit of a word or a line."""
    words = [found.span() for found in _WORD.finditer(data)] or [(0, 0)]
    start, end = draw.choice(words)
    other, after = draw.choice(words)
    lines = data.splitlines(keepends=True) or [b""]
    number = draw.randrange(len(lines))
    without = b"".join(lines[:number] + lines[number + 1 :])
    repeated = b"".join(lines[: number + 1] + lines[number:])
    return draw.choice(
        (
            data[:start] + data[end:],
            data[:start] + data[other:after] + data[end:],
            data[:start] + data[start:end][::-1] + data[end:],
            data[:start],
            without,
            repeated,
        )
    )


def edited_files(files: Files, draw: random.Random) -> Files:
    """Return the files after an edit of one of them; now and then one is deleted or copied."""
    path = draw.choice(sorted(files))
    match draw.randrange(8):
        case 0:
            return {name: text for name, text in files.items() if name != path} or files
        case 1:
            other = draw.choice(sorted(files))
            return {
                **files,
                f"{path}.backup": files[path],
                f"{path[:-5]}x{path[-5:]}": files[other],
            }
        case _:
            return {**files, path: edited_text(files[path], draw)}
