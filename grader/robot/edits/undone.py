"""The edits that write a rejected file as it is read: tags closed, or words that surely stand for others."""

from collections.abc import Iterator

from grader.edits import Proposal
from grader.robot.edits.draft import Draft
from grader.robot.edits.elements import Set
from grader.robot.meant import Word
from grader.robot.reader import Reading
from grader.source import Edits


def undone_proposals(reading: Reading) -> Iterator[Proposal]:
    """Yield the edits of the tags and of the words for which ROS 2 or xacro rejects a file."""
    if reading.verdict == "rejected" and not reading.undone:
        from grader.xml.tinyxml2.recovery import Recovery  # late: its patterns take long

        recovery = Recovery(reading.source.text)
        recovery.run()
        edits = tuple(reading.source.edit(*change) for change in recovery.changes if not recovery.is_lossy)
        yield Proposal(edits, "the syntax of tags")
    draft = Draft.of(reading)
    if draft is not None and reading.undone:
        edits = tuple(edit for word in reading.undone for edit in _of_word(draft, word))
        yield Proposal(edits, "the spelling of a word" if len(reading.undone) == 1 else "the spelling of words")


def _of_word(draft: Draft, word: Word) -> Edits:
    """Return the edits of a word: of a tag, of an attribute's name, or of its value."""
    element, attribute = word.element, word.attribute
    if attribute is None:
        return draft.rename_tag(element, word.tag)
    if attribute in word.attributes:
        return next(iter(draft.ways([Set(element, "", attribute, word.attributes[attribute])])), ())
    new = next(name for name in word.attributes if name not in element.attrib)
    return draft.rename_attribute(element, attribute, new)
