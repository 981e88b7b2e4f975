"""What Canvas and Moodle do with an uploaded file, as small models written from its source or documentation.

A state is the grades in the LMS by assignment, by the id of the student there; an absent grade is an empty text.
"""

import csv
import io
import re
import zipfile
from collections.abc import Mapping
from copy import deepcopy
from decimal import Decimal

State = dict[str, dict[str, str]]


def rows_of(data: bytes, encoding: str = "utf-8") -> list[list[str]]:
    """Return the rows of a file as a CSV reader sees them."""
    return list(csv.reader(io.StringIO(data.decode(encoding), newline="")))


def canvas_import(data: bytes, state: State) -> State:
    """Canvas, lib/gradebook_importer.rb: every cell of an assignment counts, an empty one too; EX is an excuse."""
    header, *rows = rows_of(data)
    assert "Student" in header[0], header
    assert "ID" in header[1], header
    assert "Section" in header
    titles = {
        index: found[1]
        for index, title in enumerate(header)
        if (found := re.fullmatch(r"(.+) \(\d+\)", title))
    }
    after = deepcopy(state)
    for row in rows:
        if "Points Possible" not in row[0] and any(cell.strip() for cell in row):
            for index, title in titles.items():
                cell = row[index].strip()
                after[row[1]][title] = (
                    "EX" if cell.casefold() == "ex" else "" if cell == "-" else cell
                )
    return after


def moodle_import(data: bytes, state: State) -> State:
    """Moodle, mod/assign/feedback/offline: by the participant's number; an empty or equal grade is skipped, a comment is not."""
    header, *rows = rows_of(data, "utf-8-sig")
    after = deepcopy(state)
    for row in rows:
        values = dict(zip(header, row, strict=True))
        grades = after[values["Identifier"].removeprefix("Participant ")]
        assert Decimal(values["Grade"] or 0) <= Decimal(values["Maximum grade"])
        if values["Grade"] and values["Grade can be changed"] == "Yes":
            grades["Lab"] = values["Grade"]
        grades["comment"] = values["Feedback comments"]
    return after


def moodle_feedback(data: bytes, participants: Mapping[str, str]) -> dict[str, dict[str, bytes]]:
    """Moodle, mod/assign/feedback/file/importziplib.php: the files that each participant gets, by student; raises for an ignored one."""
    found: dict[str, dict[str, bytes]] = {}
    for path, content in _files(data).items():
        *folders, file = path.split("/")
        assert not file.startswith((".", "~")), path
        named = [part.split("_", 4) for part in (*folders, file)]
        words = next(
            part
            for part in named
            if len(part) >= 4 and part[1].isdecimal() and part[1] in participants
        )
        assert words[2:4] == ["assignfeedback", "file"], path
        found.setdefault(participants[words[1]], {})[file] = content
    return found


def canvas_comments(
    data: bytes, attachments: Mapping[tuple[str, str], str], groups: Mapping[str, set[str]]
) -> dict[str, bytes]:
    """Canvas, app/models/abstract_assignment.rb: the file in each student's comment; raises for an ignored or a second one.

    `attachments` has the name of each attachment by user and id; a file is shown under that name. `groups` are the members who share
    a comment, by user.
    """
    found: dict[str, bytes] = {}
    for name, content in _files(data).items():
        words = [word for word in name.split("_") if word != "LATE"]
        assert not words[-1].startswith("link"), name
        user, attachment = [word for word in words if word.isdecimal()][:2]
        shown = attachments[user, attachment]
        if shown.endswith(".zip"):  # what a student who opens it sees
            (content,) = _files(content).values()
        for member in groups.get(user, {user}):
            assert member not in found, name
            found[member] = content
    return found


def _files(data: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {info.filename: archive.read(info) for info in archive.infolist()}
