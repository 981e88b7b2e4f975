"""Edits of the elements in a text, and the text after edits.

Numbers are written as a person writes them.
"""

import re
from collections.abc import Callable, Iterable, Sequence
from math import isclose, isfinite

from grader.base import markup
from grader.base.grouping import StringsByName, group_values
from grader.base.patterns import on_use
from grader.base.source import Edit, Edits, Source

_ESCAPES = (("&", "&amp;"), ("<", "&lt;"), ('"', "&quot;"))
_SAME = 1e-3  # relative: -1.57 is -pi/2
_PIECE = on_use(r"(\s*)(\S+)")


def element_text(source: Source, start: int) -> str:
    """Return the text of the element at an offset."""
    return source.text[start : markup.element_end(source.text, start)]


def with_attribute(source: Source, start: int, attribute: str, value: str) -> Edit:
    """Return the edit that sets an attribute of the start tag at an offset, or adds it."""
    existing = markup.attribute(source.text, start, attribute)
    if not existing:
        end = markup.name_end(source.text, start)
        return source.edit(start, end, f'{source.text[start:end]} {attribute}="{value}"')
    head = source.text[existing.start : existing.value_start]
    tail = source.text[existing.value_end : existing.end]
    return source.edit(existing.start, existing.end, f"{head}{value}{tail}")


def with_child(source: Source, start: int, xml: str) -> Edit:
    """Return the edit that inserts an element as the first child of the one at an offset."""
    text = source.text
    newline = "\r\n" if "\r\n" in source.text else "\n"
    end, is_empty = markup.head_end(text, start)
    indent = markup.child_indentation(text, start)
    child = f"{newline}{indent}{markup.indented(xml, indent, newline)}"
    if not is_empty:
        return source.edit(end, end, child)
    slash = text.rfind("/", start, end)
    name = text[start + 1 : markup.name_end(text, start)].strip()
    closing = f"{newline}{markup.indentation(text, start)}</{name}>"
    return source.edit(start, end, f"{text[start:slash].rstrip()}>{child}{closing}")


def without_element(source: Source, start: int) -> Edit:
    """Return the edit that removes the element at an offset.

    Its line goes too where nothing else is on it.
    """
    end = markup.element_end(source.text, start)
    indent = markup.indentation(source.text, start)
    line = start - len(indent)
    is_alone = source.text[end : end + 2].startswith(("\n", "\r\n")) and (
        line == 0 or source.text[line - 1] == "\n"
    )
    if is_alone:
        return source.edit(line, source.text.find("\n", end) + 1, "")
    return source.edit(start, end, "")


def with_element(source: Source, start: int, xml: str) -> Edit:
    """Return the edit that replaces the element at an offset by another one."""
    newline = "\r\n" if "\r\n" in source.text else "\n"
    indent = markup.indentation(source.text, start)
    return source.edit(
        start, markup.element_end(source.text, start), markup.indented(xml, indent, newline)
    )


def merged(old: str, new: str) -> str:
    """Return a new list of numbers, written as the old text writes them.

    Numbers that stay, and the space between all of them, are as in the old text.
    """
    before = _PIECE.findall(old)
    after = new.split()
    if len(before) != len(after):
        return new
    pieces = zip(before, after, strict=True)
    return "".join(
        (" " if space.strip(" ") else space) + _merge_one(piece, other)
        for (space, piece), other in pieces
    )


def _merge_one(old: str, new: str) -> str:
    """Return the new number, in the old notation if it is the same or only its sign changes."""
    try:
        before = float(old)
        after = float(new)
    except ValueError:
        return new
    if isclose(before, after, rel_tol=_SAME, abs_tol=_SAME / 100):
        return old
    if isclose(before, -after, rel_tol=_SAME):
        if before < 0:
            return old.lstrip("-")
        return f"-{old.lstrip('+')}"
    return new


def edited(text: str, path: str, edits: Iterable[Edit]) -> str | None:
    """Return the text of a file after edits.

    Returns None if they overlap, or if the text is not what they replace.
    """
    source = Source(path, text)
    pieces: list[str] = []
    position = 0
    for start, edit in _offsets(source, edits):
        if start < position or not text.startswith(edit.old, start):
            return None
        pieces += (text[position:start], edit.new)
        position = start + len(edit.old)
    return "".join((*pieces, text[position:]))


def edit_files(
    read: Callable[[str], bytes | None], edits: Iterable[Edit]
) -> dict[str, bytes | None] | None:
    """Return the files that edits change, by path; None where the edits do not fit.

    `read` returns a file as it is. A file that is renamed is None at its old path.
    """
    files: dict[str, bytes | None] = {}
    for path, of_file in _group_by_file(edits).items():
        text = (read(path) or b"").decode("utf-8", "surrogateescape")
        renamed = next((edit.renamed for edit in of_file if edit.renamed), "")
        after = edited(text, path, [edit for edit in of_file if not edit.renamed])
        if after is None:
            return None
        if renamed:
            files[path] = None
        files[renamed or path] = after.encode("utf-8", "surrogateescape")
    return files


def edits_before(
    read: Callable[[str], bytes | None], earlier: Iterable[Edit], later: Iterable[Edit]
) -> Edits | None:
    """Return edits of files after earlier ones as edits of the files before them.

    None where they change what the earlier ones wrote. `read` returns a file as it is.
    """
    by_file = _group_by_file(earlier)
    moved = []
    for edit in later:
        if edit.path not in by_file:
            moved.append(edit)
            continue
        before = Source(edit.path, (read(edit.path) or b"").decode("utf-8", "surrogateescape"))
        start = _offset_before(before, by_file[edit.path], edit)
        if start is None:
            return None
        moved.append(before.edit(start, start + len(edit.old), edit.new))
    return tuple(moved)


def _offset_before(before: Source, earlier: Sequence[Edit], edit: Edit) -> int | None:
    """Return where an edit of a text begins in the text before earlier ones.

    None where it changes what these wrote.
    """
    after = Source(before.path, edited(before.text, before.path, earlier) or "")
    start = after.start_offset(edit)
    moved = 0  # how far the earlier edits moved the text
    for offset, one in _offsets(before, earlier):
        if offset + moved + len(one.new) <= start:
            moved += len(one.new) - len(one.old)
        elif offset + moved < start + len(edit.old):
            return None
    return start - moved


def _group_by_file(edits: Iterable[Edit]) -> dict[str, list[Edit]]:
    return group_values((edit.path, edit) for edit in edits)


def _offsets(source: Source, edits: Iterable[Edit]) -> list[tuple[int, Edit]]:
    return sorted(((source.start_offset(edit), edit) for edit in edits), key=lambda pair: pair[0])


def format_numbers(values: Iterable[float]) -> str:
    """Return numbers as a URDF contains them."""
    return " ".join(map(format_number, values))


def format_number(value: float) -> str:
    """Return a number in as few characters as a robot that a person writes needs."""
    if not isfinite(value):
        return repr(value)
    text = f"{round(value, 6) + 0.0:.6g}"
    if text == "0" and abs(value) > 1e-12:  # an inertia
        return f"{value:.6g}"
    if "e" not in text:
        return text
    return f"{value:.6f}".rstrip("0").rstrip(".")


def tag_edits(source: Source, start: int, old: str, new: str) -> Edits:
    """Return the edits of the start tag of the element at an offset, and of its end tag if any.

    Returns none if its tag is another one.
    """
    if source.text[start : markup.name_end(source.text, start)] != f"<{old}":
        return ()
    edits = [source.edit(start, start + len(old) + 1, f"<{new}")]
    end = markup.element_end(source.text, start)
    closing = re.search(rf"</{re.escape(old)}\s*>\Z", source.text[start:end])
    if closing:
        edits.append(source.edit(start + closing.start(), end, f"</{new}>"))
    return tuple(edits)


def renamed_tag(source: Source, start: int, new: str) -> Edits:
    """Return the edits that give the element at an offset another tag, at its start and its end."""
    text = source.text
    end = markup.name_end(source.text, start)
    edits: Edits = (source.edit(start, end, f"<{new}"),)
    tail = markup.element_end(text, start)
    closing = text.rfind("</", start, tail)
    if not markup.head_end(text, start)[1] and closing >= 0:
        edits += (source.edit(closing, tail, f"</{new}>"),)
    return edits


def renamed_attribute(source: Source, start: int, old: str, new: str) -> Edits:
    """Return the edit that gives an attribute of the start tag at an offset another name.

    There is none where the attribute is not written there.
    """
    written = markup.attribute(source.text, start, old)
    if not written:
        return ()
    rest = source.text[written.start + len(old) : written.end]
    return (source.edit(written.start, written.end, f"{new}{rest}"),)


def empty_element(tag: str, attributes: StringsByName) -> str:
    """Return the text of an element without content."""
    return f"<{tag}{attributes_text(attributes)}/>"


def attributes_text(attributes: StringsByName) -> str:
    """Return attributes as they stand behind the name of a tag."""
    return "".join(f' {name}="{escaped(value)}"' for name, value in attributes.items())


def escaped(value: str) -> str:
    """Return a text as an attribute contains it."""
    for character, entity in _ESCAPES:
        value = value.replace(character, entity)
    return value
