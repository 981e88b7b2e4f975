"""The documents on which the grader and xacro have to agree, in tables by rule."""

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tests.xacro.documents.document import PATH, Document, Documents, robot


def _document(row: Mapping[str, Any]) -> Document:
    """Return a row's document: a robot with this body or a whole text, and files beside it, as text or Latin-1."""
    raw = {name: text.encode("latin-1") for name, text in row.get("latin_1", {}).items()}
    return Document(
        robot(row["body"]) if "body" in row else row["text"],
        {**row.get("files", {}), **raw},
        row.get("arguments", {}),
        row.get("undetermined", "never"),
        row.get("path", PATH),
    )


def _documents(path: Path) -> Documents:
    """Return the documents of a table; `like` names a row of `shared` with the files of several documents."""
    rows = tomllib.loads(path.read_bytes().decode())
    shared = rows.pop("shared", {})
    return {
        name: _document({**shared.get(row.get("like"), {}), **row}) for name, row in rows.items()
    }


GROUPS = {path.stem: _documents(path) for path in sorted(Path(__file__).parent.glob("*.toml"))}
