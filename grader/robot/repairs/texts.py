"""Edits of a text that is no XML for ROS 2, or no robot: each makes TinyXML2 read on."""

import re
from collections.abc import Iterable, Iterator
from itertools import islice

from grader.edits import Proposal
from grader.names import closest
from grader.problems import Kind
from grader.robot import catalogue
from grader.robot.edits.draft import Draft
from grader.robot.reader import Reading
from grader.robot.repairs.closing import closing_proposals, early_end_proposals
from grader.robot.repairs.pieces import Piece, Tree, pieces_of
from grader.robot.repairs.tags import tag_proposals
from grader.source import Edit, Source
from grader.xml import catalogue as xml_catalogue
from grader.xml.tinyxml2.tags import REFERENCE
from grader.xml.urdf_format import ATTRIBUTES

_LOST = re.compile(rf"(?<![<\w/:.\-\"'=])(/?)({'|'.join(sorted(ATTRIBUTES, key=len, reverse=True))})\b(?=[^<>]*>)")
_NEARLY_CLOSED = re.compile(r"[-\u2013\u2014]+\s*!?\s*>|[-\u2013\u2014]{2,}(?=\s*\n)")
_INSERTED = ('"', ">", "/>", "<", "=", "/", "'", " ")
_DECLARATION = re.compile(r"""<\?xml\s+version\s*=\s*["']1\.[0-9]["']\s*(encoding\s*=\s*["'][^"']*["']\s*)?\?>""")
_MAX_PLACES = 6
_XACRO = "http://www.ros.org/wiki/xacro"


def text_proposals(reading: Reading, reference: Draft | None) -> Iterator[Proposal]:
    """Yield edits of a text that ROS 2 cannot read; what has no name may get one of the reference."""
    source = reading.source
    tree = Tree.of(source.text)
    kinds = {problem.kind for problem in reading.problems}
    if not kinds.isdisjoint((catalogue.NO_ROBOT, catalogue.NO_LINKS)):
        yield from _robot(source, tree, (reference.root.get("name") if reference is not None else None) or "robot")
    if not kinds.isdisjoint((xml_catalogue.SEVERAL_ROOTS, xml_catalogue.IGNORED_REST, catalogue.NO_LINKS)):
        yield from early_end_proposals(source)
    is_strict = any(kind.is_before_ros for kind in kinds)  # xacro, which reads XML only
    if is_strict:
        yield from _well_formed(source, tree)
    if xml_catalogue.MISPLACED_DECLARATION in kinds or is_strict:
        yield from _declarations(source, tree.pieces, "" if is_strict else " \t\r\n")
    if xml_catalogue.UNTERMINATED in kinds or reading.root is None:
        yield from _comments(source, tree.pieces)
    yield from _with_brackets(source)
    if reading.root is None:
        yield from tag_proposals(source)
        links = [link.name for link in reference.robot.links] if reference is not None else []
        yield from closing_proposals(source, tree, links)
        yield from _stray(source, tree, kinds)


def fallback_proposals(source: Source) -> Iterator[Proposal]:
    """Yield the insertion or deletion of one token where TinyXML2 stops: for mistakes that nobody foresaw."""
    text = source.text
    tree = Tree.of(text)
    at = min(tree.reached, len(text))
    broken = next((piece for piece in tree.pieces if piece.start <= at <= piece.end and piece.error is not None), None)
    if broken is not None and broken.form != "other":
        edit = source.edit(broken.start, max(broken.end, broken.start + 1), "")
        yield Proposal((edit,), "text that is no tag", "remove the text")
    starts = [at, broken.start, broken.end] if broken is not None else [at]
    ends = (found.end() for found in re.finditer(r"[\w.\-]+", text[starts[-1] : starts[-1] + 80]))
    places = dict.fromkeys((*starts, *(starts[-1] + end for end in islice(ends, _MAX_PLACES))))
    for place in places:
        for token in _INSERTED:
            yield Proposal((source.edit(place, place, token),), f"a {token} is missing", f"insert {token}")
        if place < len(text):
            yield Proposal((source.edit(place, place + 1, ""),), "an extra character", "remove the character")
        if place > 0:
            yield Proposal((source.edit(place - 1, place, ""),), "an extra character", "remove the character")
    line = text.rfind("\n", 0, at) + 1
    end = text.find("\n", at)
    yield Proposal((source.edit(line, end if end >= 0 else len(text), ""),), "a line that is no XML", "remove the line")


def _robot(source: Source, tree: Tree, name: str) -> Iterator[Proposal]:
    """Name the root robot, or add it."""
    text = source.text
    tags = [piece for piece in tree.pieces if piece.form != "other"]
    root = next((piece for piece in tags if piece.name), None)
    if root is None:
        return
    if closest(root.name, ["robot"]) or root.name.lower() in ("robot", "model", "urdf"):
        edits = [
            source.edit(end - len(root.name), end, "robot")
            for piece in tags
            if piece.name == root.name and (end := text.index(root.name, piece.start) + len(root.name))
        ]
        yield Proposal(tuple(edits), "the name of the root tag", "name the root robot")
    if not any(piece.name == "robot" and piece.form == "open" for piece in tags):
        edits = [source.edit(root.start, root.start, f'<robot name="{name}">\n')]
        if not any(piece.name == "robot" and piece.form == "close" for piece in tags):
            edits.append(source.edit(len(text.rstrip()), len(text.rstrip()), "\n</robot>"))
        yield Proposal(tuple(edits), "the tag <robot> is missing", "add <robot>")


def _well_formed(source: Source, tree: Tree) -> Iterator[Proposal]:
    """Write what XML needs and TinyXML2 does not: the namespace of xacro, a correct declaration, &amp; for &."""
    text = source.text
    root = next((piece for piece in tree.pieces if piece.name == "robot"), None)
    if root is not None and "xmlns:xacro" not in root.text_in(text):
        end = root.start + len("<robot")
        edit = source.edit(root.start, end, f'<robot xmlns:xacro="{_XACRO}"')
        yield Proposal((edit,), "the namespace of xacro is missing", "declare xmlns:xacro")
    for piece in tree.pieces:
        if piece.name == "<?" and not _DECLARATION.fullmatch(piece.text_in(text)):
            edit = source.edit(piece.start, piece.end, '<?xml version="1.0"?>')
            yield Proposal((edit,), "the XML declaration", 'write <?xml version="1.0"?>')
    ampersands = tuple(source.edit(found.start(), found.end(), "&amp;") for found in REFERENCE.finditer(text))
    yield Proposal(ampersands, "an & that is not escaped", "write &amp; for &")


def _declarations(source: Source, pieces: list[Piece], blank: str) -> Iterator[Proposal]:
    """Move an XML declaration to the top, before which only blank text may be; remove a second one, as of a pasted file."""
    text = source.text
    found = [piece for piece in pieces if piece.name == "<?"]
    kept = next((piece for piece in found if not text[: piece.start].strip(f"\ufeff{blank}")), None)
    edits = tuple(_without_line(source, piece) for piece in found if piece is not kept)
    start = int(text.startswith("\ufeff"))
    if kept is None and found and found[0] is pieces[0]:
        before = source.edit(start, found[0].start, "")
        yield Proposal((before, *edits[1:]), "text before the XML declaration", "remove the text")
    if kept is None and found:
        top = source.edit(start, start, f"{found[0].text_in(text)}\n")
        yield Proposal((top, *edits), "the place of the XML declaration", "move the XML declaration to the top")
    yield Proposal(edits, "an XML declaration that is not at the top", "remove the XML declaration")


def _without_line(source: Source, piece: Piece) -> Edit:
    """Return the edit that removes a declaration, with the end of its line."""
    end = piece.end
    while source.text[end : end + 1] in ("\r", "\n") and end < piece.end + 2:
        end += 1
        if source.text[end - 1] == "\n":
            break
    return source.edit(piece.start, end, "")


def _comments(source: Source, pieces: list[Piece]) -> Iterator[Proposal]:
    """End a comment or declaration that is not ended, or that contains the start of another comment."""
    text = source.text
    for piece in pieces:
        body = text[piece.start + 2 : piece.end]
        if piece.form != "other" or not (piece.error is not None or piece.name in body):
            continue
        closing = {"<!--": "-->", "<![CDATA[": "]]>", "<?": "?>", "<!": ">"}[piece.name]
        what = {"<!--": "the end of a comment", "<?": "the end of the XML declaration"}.get(
            piece.name, "the end of a section"
        )
        limit = text.find("<", piece.start + 4)
        limit = limit if limit >= 0 else len(text)
        near = (_NEARLY_CLOSED if piece.name == "<!--" else re.compile(r"\s*[/?]?>")).search(
            text, piece.start + 4, limit
        )
        cause, action = f"{what} is missing", f"write {closing} at {what}"
        if near is not None:
            yield Proposal((source.edit(*near.span(), closing),), cause, action)
        end = len(text[: min(limit, text.find("\n", piece.start) % (len(text) + 1))].rstrip())
        yield Proposal((source.edit(end, end, f" {closing}" if piece.name == "<!--" else closing),), cause, action)


def lost_brackets(text: str) -> list[int]:
    """Return the offsets of what looks like a tag without its < in the text between tags."""
    if text.count(">") <= text.count("<"):
        return []
    pieces = list(pieces_of(text))
    ends = [0, *(piece.end for piece in pieces)]
    starts = [*(piece.start for piece in pieces), len(text)]
    return [match.start() for gap in zip(ends, starts, strict=True) for match in _LOST.finditer(text, *gap)]


def _with_brackets(source: Source) -> Iterator[Proposal]:
    """Write the < of what looks like a tag in the text between tags."""
    edits = tuple(source.edit(at, at, "<") for at in lost_brackets(source.text))
    if edits:
        yield Proposal(edits, "the < of a tag is missing", "begin the tag with <")


def _stray(source: Source, tree: Tree, kinds: Iterable[Kind]) -> Iterator[Proposal]:
    """Remove what is after the last tag: a command, the end of a code block."""
    if xml_catalogue.STRAY_TEXT in kinds and tree.pieces:
        end = tree.pieces[-1].end
        text = source.text[end:]
        start = end + len(text) - len(text.lstrip())
        edit = source.edit(start, len(source.text.rstrip()), "")
        yield Proposal((edit,), "the text after the robot", "remove the text")
