"""Tags that are not closed, closed twice, or closed by another tag."""

import re
from collections.abc import Iterator, Sequence

from grader import markup
from grader.edits import Proposal
from grader.names import closest
from grader.robot.repairs.pieces import LEAVES, Piece, Tree, pieces_of
from grader.source import Edit, Source
from grader.xml.urdf_format import ATTRIBUTES, CHILDREN

_MISSING = ("a closing tag is missing", "add the closing tag")


def closing_proposals(source: Source, tree: Tree, links: Sequence[str] = ()) -> Iterator[Proposal]:
    """Yield edits that give each tag its closing tag, the most plausible first; `links` are names that a link may get."""
    if tree.mismatch is not None:
        yield from _mismatch(source, tree, tree.mismatch, links)
    if tree.open_tags:
        yield from _misplaced(source, tree)
        if tree.mismatch is None:
            yield from _unclosed(source, tree)


def _mismatch(source: Source, tree: Tree, closing: Piece, links: Sequence[str]) -> Iterator[Proposal]:
    *above, top = tree.open_tags
    outer = {piece.name for piece in above}
    is_known, top_is_known = closing.name in ATTRIBUTES, top.name in ATTRIBUTES
    if closing.name not in outer and (not is_known or closest(closing.name, [top.name])) and top_is_known:
        yield _renamed_closing(source, top, closing)
    if is_known and not top_is_known:
        edit = source.edit(*_name_span(source.text, top), closing.name)
        yield Proposal((edit,), "the name of a tag", "correct the name of the tag")
    if closing.name in outer:
        yield from _not_closed(source, tree, top, closing)
    else:
        yield from _closes_nothing(source, tree, top, closing, links)
    yield _renamed_closing(source, top, closing)


def _renamed_closing(source: Source, top: Piece, closing: Piece) -> Proposal:
    edit = source.edit(closing.start, closing.end, f"</{top.name}>")
    return Proposal((edit,), "the name of a closing tag", "correct the closing tag")


def _name_span(text: str, piece: Piece) -> tuple[int, int]:
    end = markup.name_end(text, piece.start)
    return end - len(piece.name), end


def _not_closed(source: Source, tree: Tree, top: Piece, closing: Piece) -> Iterator[Proposal]:
    """Yield edits of the tag that is open where an outer one is closed."""
    text = source.text
    if top.name in LEAVES:
        alike = [piece for piece in tree.pieces if _is_unclosed_leaf(text, piece)]
        edits = tuple(edit for piece in alike for edit in _self_closed(source, piece).edits)
        yield _self_closed(source, top)._replace(edits=edits)
        yield _self_closed(source, top)
    if not top.has_attributes and top.name in {piece.name for piece in tree.open_tags[:-1]}:
        edit = source.edit(top.start, top.end, f"</{top.name}>")
        yield Proposal((edit,), "the / of a closing tag is missing", "add the /")
        yield Proposal((source.edit(top.start, top.end, ""),), "a duplicate tag", "remove one")
    own = [piece for piece in _inside(tree, top) if piece.name == top.name and not piece.has_attributes]
    for piece in own[-1:]:
        edit = source.edit(piece.start, piece.end, f"</{top.name}>")
        yield Proposal((edit,), "the / of a closing tag is missing", "add the /")
    yield Proposal((_closed_before(source, top, closing.start),), *_MISSING)
    if top.name not in LEAVES and not text[top.end : closing.start].strip():
        yield _self_closed(source, top)
    yield Proposal((source.edit(closing.start, closing.end, ""),), "an extra closing tag", "remove the closing tag")
    yield Proposal((source.edit(top.start, top.end, ""),), "a tag that is not closed", "remove the tag")


def _is_unclosed_leaf(text: str, piece: Piece) -> bool:
    """Return whether a tag that contains nothing is open, and the next one does not close it."""
    following = text.find("<", piece.end)
    return piece.form == "open" and piece.name in LEAVES and not text.startswith(f"</{piece.name}", following)


def _self_closed(source: Source, piece: Piece) -> Proposal:
    head = piece.text_in(source.text)[:-1].rstrip()
    blank = " " if " />" in source.text and not source.text.count('"/>') > source.text.count('" />') else ""
    edit = source.edit(piece.start, piece.end, f"{head}{blank}/>")
    return Proposal((edit,), "the / of a tag without content is missing", "end the tag with />")


def _closed_before(source: Source, piece: Piece, offset: int) -> Edit:
    """Return the edit that closes a tag after what is before an offset."""
    text = source.text
    end = len(text[:offset].rstrip())
    indent = markup.indentation(text, piece.start)
    newline = "\r\n" if "\r\n" in text else "\n"
    is_one_line = "\n" not in text[piece.start : end]
    return source.edit(end, end, f"</{piece.name}>" if is_one_line else f"{newline}{indent}</{piece.name}>")


def _inside(tree: Tree, top: Piece) -> list[Piece]:
    """Return the tags that are open inside a tag, or next to it, and those that are empty."""
    return [piece for piece in tree.open_tags if piece.start > top.start]


def _closes_nothing(source: Source, tree: Tree, top: Piece, closing: Piece, links: Sequence[str]) -> Iterator[Proposal]:
    """Yield edits of a closing tag without an opening one."""
    text = source.text
    between = [piece for piece in tree.pieces if top.end <= piece.start < closing.start]
    empty = [piece for piece in between if piece.form == "empty" and piece.name == closing.name]
    for piece in empty[-1:]:
        head = piece.text_in(text)[:-1].rstrip().removesuffix("/").rstrip()
        edit = source.edit(piece.start, piece.end, f"{head}>")
        yield Proposal((edit,), "the / of a tag with content is too much", "remove the /")
    allowed, inner = CHILDREN.get(closing.name, ()), _descendants(closing.name)
    tags = [piece for piece in between if piece.form != "other"]
    for piece in tags:
        if piece.name in allowed and all(other.name in inner for other in tags if other.start >= piece.start):
            unused = [
                name
                for name in links
                if closing.name == "link" and not re.search(rf"<link\s[^>]*\b{re.escape(name)}\b", text)
            ]
            named = f' name="{unused[0]}"' if unused else ""
            edit = source.edit(piece.start, piece.start, f"<{closing.name}{named}>")
            yield Proposal((edit,), "a tag is missing", "add the tag")
            break
    yield Proposal((_without(source, closing),), "an extra closing tag", "remove the closing tag")


def _descendants(tag: str) -> set[str]:
    children = CHILDREN.get(tag, ())
    return set(children).union(*map(_descendants, children))


def _without(source: Source, piece: Piece) -> Edit:
    """Return the edit that removes a tag, with its line where nothing else is on it."""
    text = source.text
    start = piece.start - len(markup.indentation(text, piece.start))
    end = text.find("\n", piece.end) + 1
    if end and not text[piece.end : end].strip() and text[start - 1 : start] in ("", "\n"):
        return source.edit(start, end, "")
    return source.edit(piece.start, piece.end, "")


def _misplaced(source: Source, tree: Tree) -> Iterator[Proposal]:
    """Close what is open before the first tag that may not be in it: a <link> in a <visual>."""
    open_tags: list[Piece] = []
    for piece in tree.pieces:
        if piece.form in ("open", "empty"):
            fits = [index for index, outer in enumerate(open_tags) if piece.name in CHILDREN.get(outer.name, ())]
            if fits and fits[-1] < len(open_tags) - 1 and _is_lost(open_tags[fits[-1] + 1 :], tree):
                text = "".join(
                    _closed_before(source, inner, piece.start).new for inner in reversed(open_tags[fits[-1] + 1 :])
                )
                end = len(source.text[: piece.start].rstrip())
                yield Proposal((source.edit(end, end, text),), *_MISSING)
                return
        if piece.form == "open":
            open_tags.append(piece)
        elif piece.form == "close" and open_tags:
            open_tags.pop()
        if piece is tree.mismatch:
            return


def _is_lost(inner: list[Piece], tree: Tree) -> bool:
    """Return whether one of these tags is still open at the error."""
    return any(piece in tree.open_tags for piece in inner)


def _unclosed(source: Source, tree: Tree) -> Iterator[Proposal]:
    """Close at the end of the file what is open there: a file that was cut off."""
    text = source.text
    end = len(text.rstrip())
    newline = "\r\n" if "\r\n" in text else "\n"
    lines = (f"{newline}{markup.indentation(text, piece.start)}</{piece.name}>" for piece in reversed(tree.open_tags))
    yield Proposal((source.edit(end, end, "".join(lines)),), "the file is truncated", "close all open tags")
    last = tree.open_tags[-1]
    for piece in tree.pieces:
        if piece.name == tree.open_tags[0].name and piece.form == "open" and piece is not tree.open_tags[0]:
            yield Proposal((_without(source, piece),), "a duplicate tag", "remove one copy of the tag")
    if not last.has_attributes:
        edit = source.edit(last.start, last.end, f"</{last.name}>")
        yield Proposal((edit,), "the / of a closing tag is missing", "add the /")


def early_end_proposals(source: Source) -> Iterator[Proposal]:
    """Yield edits where the robot is closed before its last link or joint: a </robot> in the middle, <robot .../>."""
    pieces = list(pieces_of(source.text))
    robots = [piece for piece in pieces if piece.name == "robot"]
    last = max((piece.start for piece in pieces if piece.name in ("link", "joint", "material")), default=-1)
    opened, closed = ([piece for piece in robots if piece.form == form] for form in ("open", "close"))
    if len(opened) > 1 and len(closed) > 1 and opened[1].start < closed[0].start:
        edits = (_without(source, opened[1]), _without(source, closed[-1]))
        yield Proposal(edits, "a duplicate tag", "remove one copy of the tag")
    for piece in robots:
        if piece.form == "empty":
            head = piece.text_in(source.text)[:-1].rstrip().removesuffix("/").rstrip()
            edit = source.edit(piece.start, piece.end, f"{head}>")
            yield Proposal((edit,), "the / of a tag with content is too much", "remove the /")
        elif piece.form == "close" and piece.start < last:
            moved: tuple[Edit, ...] = (_without(source, piece),)
            if not any(other.form == "close" and other.start > last for other in robots):
                end = len(source.text.rstrip())
                moved = (*moved, source.edit(end, end, "\n</robot>"))
            yield Proposal(moved, "a </robot> before the end of the robot", "move </robot> to the end")
