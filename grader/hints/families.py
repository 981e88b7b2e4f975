"""The families of edits that are tried: of the reference, of the package, and of the student's own numbers."""

from collections.abc import Callable, Collection, Iterable, Iterator
from typing import TYPE_CHECKING

from grader.grading.criterion import Criterion
from grader.hints.edits import Proposal
from grader.hints.robot.difference import RobotDifference
from grader.hints.robot.draft import Draft
from grader.hints.robot.elements import Set
from grader.hints.robot.groups import whole_elements, whole_links
from grader.hints.robot.pieces import Piece
from grader.hints.robot.variants import in_another_unit, of_own, of_siblings
from grader.hints.targets import is_another, links_of, own_chain
from grader.hints.trials import Trials
from grader.robot.meant import Word
from grader.robot.reader import Reading
from grader.source import Edit, Edits
from grader.submission.submission import Submission
from grader.submission.urdf import Read
from grader.xml.urdf_format import JOINT_TYPES

if TYPE_CHECKING:
    from grader.package.package import Package

_RAW_XACRO = "the URDF contains xacro, but is loaded without xacro"


class Families:
    """Makes the edits of one submission, whose robot is `draft`; `difference` is that to the reference's."""

    def __init__(self, trials: Trials, reference: Draft | None, package: "Callable[[], Package | None]") -> None:
        """`reference` and `package` are the robot and the package of the rubric's reference solution."""
        self._trials, self._package = trials, package
        urdf = trials.submission.urdf
        self._reading = urdf.loaded if isinstance(urdf, Read) else None
        self.draft = Draft.of(urdf.reading) if isinstance(urdf, Read) else None
        both = (
            self.draft is not None
            and not is_another(self.draft.robot, trials.rubric.links)
            and (reference or self.draft)
        )
        self.difference = RobotDifference(self.draft, both) if self.draft is not None and both else None

    @property
    def is_whole(self) -> bool:
        """Whether the robot is read from well-formed XML, of which xacro refuses nothing."""
        is_read = self._reading is not None and self._reading.root is not None
        return is_read and self.draft is not None and not self.draft.is_refused

    def of_reference(self, lost: list[Criterion]) -> Iterator[Proposal]:
        """Yield what undoes a slip, then what differs from the other side of the robot, and from the reference."""
        subjects = {criterion.check.subject for criterion in lost}
        if self._reading is not None and self.draft is not None and "urdf" in subjects:
            yield from _undone(self._reading)
            yield from _raw_xacro(self._trials.submission)
        if self.difference is not None and self.draft is not None and subjects & {"urdf", "robot"}:
            yield from self.draft.corrections([*self.difference.names, *JOINT_TYPES])
            links = self._links(lost)
            yield from self._proposals(in_another_unit(self.difference))
            yield from self._proposals(of_siblings(self.difference, links or ()))
            yield from self._proposals(self.difference.pieces, links)

    def of_links(self, lost: list[Criterion]) -> Iterator[Proposal]:
        """Yield all values of the reference of a link and its joint."""
        if self.difference is not None and any(criterion.check.subject == "robot" for criterion in lost):
            links = self._links(lost)
            yield from self._proposals(whole_links(self.difference), links)
            yield from self._proposals(whole_elements(self.difference), links)

    def of_own(self, lost: list[Criterion]) -> Iterator[Proposal]:
        """Yield the student's own numbers with another sign, order or unit."""
        if self.difference is not None:
            links = self._links([criterion for criterion in lost if criterion.check.subject == "robot"])
            yield from self._proposals(of_own(self.difference, links or ()))

    def of_package(self, lost: list[Criterion]) -> Iterator[Proposal]:
        """Yield the edits of the files of a package."""
        own = [criterion for criterion in lost if criterion.check.subject not in ("urdf", "robot")]
        if own:
            from grader.hints.package.candidates import package_proposals  # late: a robot on its own needs none

            wanted = [(criterion.check.about.looks_at, criterion.arguments) for criterion in own]
            package = self._trials.submission.package
            yield from package_proposals(package, self._package(), wanted, self._trials.isolated)

    def _proposals(self, pieces: Iterable[Piece], links: Collection[str] | None = None) -> Iterator[Proposal]:
        """Yield the edits of the text that pieces of these links stand for."""
        assert self.draft is not None
        for piece in pieces:
            if links is None or piece.link in links or not self._is_known(piece.link):
                shared = self.draft.shared(piece.sets)
                for way, edits in enumerate(self.draft.ways(piece.sets)):
                    if edits or piece.edits:
                        yield Proposal((*edits, *piece.edits), piece.cause, piece.link, piece.rank, way, shared)

    def chain(self, link: object) -> Iterable[str]:
        """Return a link, and those above it that only the student's robot has."""
        return own_chain(link, self.draft.robot, self._is_known) if self.draft is not None else ()

    def _is_known(self, link: str) -> bool:
        """Return whether the reference has a link: another one may be any of them."""
        return self.difference is not None and self.difference.reference.robot.has_link(link)

    def _links(self, lost: Iterable[Criterion]) -> list[str] | None:
        """Return the links on which criteria depend; None if all may."""
        assert self.difference is not None
        return links_of(lost, self.difference.draft.robot, self.difference.reference.robot)


def _undone(reading: Reading) -> Iterator[Proposal]:
    """Yield the edits of the tags and of the words for which ROS 2 or xacro rejects a file."""
    if reading.verdict == "rejected" and not reading.undone:
        from grader.xml.repair import repair  # late: its patterns take long

        repaired = repair(reading.source.text)
        if not repaired.is_lossy:
            edits = tuple(reading.source.edit(*change) for change in repaired.changes)
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


def _raw_xacro(submission: Submission) -> Iterator[Proposal]:
    """Yield edits that let xacro expand the URDF, where it is xacro that is loaded without it."""
    urdf = submission.urdf
    if not isinstance(urdf, Read) or urdf.as_it_stands is None:
        return
    from grader.hints.package.python_file import with_xacro  # late: most URDFs are no such file

    for path in submission.package.launch_files if submission.package is not None else ():
        source = submission.source(submission.package.path(path)) if submission.package is not None else None
        for edits in with_xacro(source) if source is not None else ():
            yield Proposal(edits, _RAW_XACRO)
    folder, slash, name = urdf.path.rpartition("/")
    renamed = f"{folder}{slash}{name.removesuffix('.urdf')}.urdf.xacro"
    yield Proposal((Edit(urdf.path, 1, 1, "", "", renamed),), _RAW_XACRO)
