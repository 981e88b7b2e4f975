"""The generators of hints, in the order in which they are tried.

They yield what may undo a mistake of a robot or a package.

`STAGES` is the list. A stage gets the situation and the criteria that still lose points, and yields
generators of proposals, each of one kind. The search grades all proposals of a stage before it
takes the best, so that a later stage is asked only for what the earlier ones left. Missing links
and joints get hints in words: no edit writes them.
"""

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from decimal import Decimal
from functools import cached_property
from itertools import starmap
from typing import TYPE_CHECKING

from grader.base.patterns import on_use
from grader.base.source import Edit, Edits
from grader.base.text import enumerated, in_backticks, texts_in
from grader.lab.hints.edits import MAX_IN_HINT, FoundHint, Proposal
from grader.lab.hints.robot_difference import MissingPart, Piece, RobotDifference
from grader.lab.hints.robot_draft import Draft
from grader.lab.hints.robot_variants import (
    exchanges,
    in_another_unit,
    leveled_supports,
    of_own,
    of_siblings,
    reversed_joints,
    whole_elements,
    whole_links,
)
from grader.lab.rubric.criterion import Criterion
from grader.lab.submission.submission import Submission
from grader.ros.package.robot_file import Read
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.reader import Reading
from grader.ros.xml.urdf_format import JOINT_TYPES

if TYPE_CHECKING:
    from grader.ros.package.package import Package

_RAW_XACRO = "the URDF contains xacro, but is loaded without xacro"
_MAX_LINKS = 40
_TAG = on_use(r"</?([A-Za-z][\w:]*)")
_MAX_SIMILAR = 2
_Generators = Iterator[Iterable[Proposal]]  # each of one kind
_Criteria = Mapping[str, Criterion]  # by id
_Parts = list[MissingPart]


class Situation:
    """A submission beside the reference solution.

    `draft` is its robot, and `difference` that to the reference's.
    """

    def __init__(
        self,
        submission: Submission,
        wanted: Collection[str],
        reference: Draft | None,
        package: "Callable[[str], Package | None]",
    ) -> None:
        """Take the robots, and the links that the rubric names, `wanted`.

        `reference` and `package` give the robot and packages of the reference solution.
        """
        self.submission = submission
        self.reference_package = package
        self.reading = None
        self.draft = None
        self.difference = None
        if isinstance(submission.urdf, Read):
            self.reading = submission.urdf.loaded
            self.draft = Draft.of(submission.urdf.reading)
        if self.draft and not self.draft.robot.is_foreign(wanted):
            self.difference = RobotDifference(self.draft, reference or self.draft)

    @cached_property
    def exchanges(self) -> list[Piece]:
        """The pieces that exchange ends of joints."""
        if self.difference:
            return exchanges(self.difference)
        return []

    @cached_property
    def has_reversed(self) -> bool:
        """Whether the parent and the child of a joint are exchanged.

        The poses around it are then none to correct.
        """
        return self.difference is not None and bool(reversed_joints(self.difference))

    @property
    def is_whole(self) -> bool:
        """Whether the robot is read from well-formed XML, of which xacro refuses nothing."""
        is_read = self.reading is not None and self.reading.root is not None
        return is_read and self.draft is not None and not self.draft.is_refused

    def is_known(self, link: str) -> bool:
        """Return whether the reference has a link: another one may be any of them."""
        return self.difference is not None and self.difference.reference.robot.has_link(link)

    def own_chain(self, link: object) -> Iterator[str]:
        """Yield a link, and those above it that only the student's robot has."""
        if not self.draft:
            return
        parents = {joint.child: joint.parent for joint in self.draft.robot.joints}
        while isinstance(link, str):
            yield link
            above = parents.pop(link, "")
            link = above if above and not self.is_known(above) else None


_Lost = Sequence[Criterion]
Stage = Callable[[Situation, _Lost], Iterator[Iterable[Proposal]]]


def _reference_edits(situation: Situation, lost: _Lost) -> _Generators:
    """Yield what undoes a slip, then what differs from elsewhere.

    It first comes from the other side of the robot, then from the reference.
    """
    draft = situation.draft
    difference = situation.difference
    if situation.reading and draft and any(one.check.subject == "urdf" for one in lost):
        yield _repairs(situation.reading)
        yield _with_xacro(situation.submission)
    if draft and difference and any(one.check.is_of_robot for one in lost):
        links = _list_links(lost, difference)
        yield draft.corrections([*difference.names, *JOINT_TYPES])
        yield _proposals(situation, situation.exchanges)
        # Those of the links that criteria name come first: there may be more than can be tried.
        yield _proposals(situation, _pieces_by_link(difference.pieces, links or []), links)
        # these rarely find a mistake
        yield _proposals(situation, in_another_unit(difference))
        yield _proposals(situation, of_siblings(difference, links or ()))


def _package_edits(situation: Situation, lost: _Lost) -> _Generators:
    """The edits of the files of a package, by the kinds of files that checks look at."""
    by_package: dict[str, list[Criterion]] = {}
    for criterion in lost:
        if not criterion.check.is_of_robot:
            by_package.setdefault(criterion.package, []).append(criterion)
    for name, criteria in by_package.items():
        submission = situation.submission.with_package(name) if name else situation.submission
        if submission.package:
            # Late: a robot on its own needs none.
            from grader.lab.hints.package_edits import package_proposals

            wanted = [
                (lost_criterion.check.about.looks_at, lost_criterion.arguments)
                for lost_criterion in criteria
            ]
            reference = situation.reference_package(name)
            yield from package_proposals(submission.package, reference, wanted)
        yield from _name_edits(situation, criteria)


def _name_edits(situation: Situation, lost: _Lost) -> _Generators:
    """Yield edits of names that do not agree, then of parameters, which rarely are the mistake."""
    for check in ("names_agree", "parameter_is"):
        for criterion in lost:
            if criterion.check.name != check:
                continue
            # Late: few rubrics ask for names.
            from grader.lab.hints.name_edits import name_proposals, value_proposals

            if check == "names_agree":
                reference = situation.reference_package(criterion.package)
                yield name_proposals(situation.submission, criterion.arguments["of"], reference)
            else:
                yield value_proposals(situation.submission, criterion.arguments)


def _own_number_edits(situation: Situation, lost: _Lost) -> _Generators:
    """The student's own numbers with another sign, order or unit."""
    if situation.difference:
        of_robot = [criterion for criterion in lost if criterion.check.subject == "robot"]
        links = _list_links(of_robot, situation.difference)
        yield _proposals(situation, of_own(situation.difference, links or ()))
        for criterion in of_robot:
            if criterion.check.name == "stands_level":
                on = criterion.arguments["on"]
                base = criterion.arguments.get("base", "")
                yield _proposals(situation, leveled_supports(situation.difference, on, base))


def _whole_link_edits(situation: Situation, lost: _Lost) -> _Generators:
    """All values of the reference of a link and its joint, or of one element."""
    if situation.difference and any(criterion.check.subject == "robot" for criterion in lost):
        links = _list_links(lost, situation.difference)
        yield _proposals(situation, whole_links(situation.difference), links)
        yield _proposals(situation, whole_elements(situation.difference), links)


# What is tried, in this order; the reference and the package again, after the edits that were
# found.
STAGES = (
    _reference_edits,
    _package_edits,
    _own_number_edits,
    _whole_link_edits,
    _reference_edits,
    _package_edits,
)


def _is_left_out(piece: Piece, situation: Situation, links: Collection[str] | None) -> bool:
    """Return whether a piece is of another link that the robot has, or a pose that is right."""
    if situation.has_reversed and piece.is_pose:
        return True
    return links is not None and piece.link not in links and situation.is_known(piece.link)


def _proposals(
    situation: Situation, pieces: Iterable[Piece], links: Collection[str] | None = None
) -> Iterator[Proposal]:
    """Yield the edits of the text that pieces of these links stand for."""
    draft = situation.draft
    assert draft
    for piece in pieces:
        if _is_left_out(piece, situation, links):
            continue
        shared = draft.shared(piece.sets)
        for way, edits in enumerate(draft.ways(piece.sets)):
            if edits or piece.edits:
                every = edits + piece.edits
                yield Proposal(every, piece.cause, piece.link, piece.rank, way, shared)


def _pieces_by_link(pieces: Iterable[Piece], links: Sequence[str]) -> list[Piece]:
    """Return the pieces in the order of these links; those of other links are last."""
    order = {link: index for index, link in enumerate(links)}
    return sorted(pieces, key=lambda piece: order.get(piece.link, len(order)))


def _list_links(criteria: Iterable[Criterion], difference: RobotDifference) -> list[str] | None:
    """Return the links whose joints and shapes decide criteria, with all above them.

    It is None if all may.
    """
    links: dict[str, None] = {}
    robot = difference.draft.robot
    reference = difference.reference.robot
    posed = Configuration(robot)
    for criterion in criteria:
        if not criterion.check.is_of_robot:
            continue
        in_arguments = map(posed.selected_or_name, texts_in(criterion.arguments))
        named = [name for name in in_arguments if reference.has_link(name) or robot.has_link(name)]
        if not named:
            return None
        for name in named:
            link: str | None = name
            while link is not None and link not in links:
                links[link] = None
                joint = posed.parent_joints.get(link)
                link = joint.parent if joint else None
    return list(links)[:_MAX_LINKS]


def _repairs(reading: Reading) -> Iterator[Proposal]:
    """Yield the edits of the tags for which ROS 2 or xacro rejects a file."""
    if reading.verdict != "rejected":
        return
    from grader.ros.xml.repair import repair  # late: its patterns take long

    repaired = repair(reading.source.text)
    if not repaired.is_lossy:
        edits = tuple(starmap(reading.source.edit, repaired.changes))
        yield Proposal(edits, _syntax_in_words(edits))


def _syntax_in_words(edits: Edits) -> str:
    """Return what is wrong with the tags that edits change, remove or add."""
    texts = [edit.old.strip() or edit.new.strip() for edit in edits]
    if any(text.startswith("<<<<<<<") for text in texts):
        return "an unresolved merge conflict"
    tags: dict[str, None] = {}
    for text in texts:
        tags |= dict.fromkeys(_TAG.findall(text)[:1])
    if tags:
        return f"the syntax of {enumerated([f'<{tag}>' for tag in tags], MAX_IN_HINT)}"
    return f"the syntax of {in_backticks(texts)}"


def _with_xacro(submission: Submission) -> Iterator[Proposal]:
    """Yield edits that let xacro expand the URDF, where it is xacro that is loaded without it."""
    urdf = submission.urdf
    if not isinstance(urdf, Read) or not urdf.as_it_stands:
        return
    from grader.ros.python.python_file import with_xacro  # late: most URDFs are no such file

    package = submission.package
    if package:
        for path in package.launch_files:
            source = submission.source(package.path(path))
            if source:
                yield from (Proposal(edits, _RAW_XACRO) for edits in with_xacro(source))
    if not urdf.path.endswith(".xacro"):
        renamed = f"{urdf.path.removesuffix('.urdf')}.urdf.xacro"
        yield Proposal((Edit(urdf.path, 1, 1, "", "", renamed),), _RAW_XACRO)


def leaves_others(
    shared: Collection[str], passing: Iterable[Criterion], lost: Collection[Criterion]
) -> bool:
    """Return whether a criterion of one call of a macro fails for another one.

    It passes for the first call.
    """
    functions = {criterion.check.function for criterion in passing} if shared else set()
    return any(
        criterion.check.function in functions and criterion.arguments.get("link") in shared
        for criterion in lost
    )


def missing_hints(
    difference: RobotDifference | None,
    written: Draft | None,
    criteria: _Criteria,
    lost: Mapping[str, Decimal],
) -> dict[str, FoundHint]:
    """Return a hint in words for each missing link with its joint.

    It is at the costliest criterion that the link costs.

    `difference` is that of the robot after all edits, `written` is the robot before them.
    """
    if not difference or not written or difference.draft is difference.reference:
        return {}
    hints = _hints_of_links(difference, written, criteria, lost)
    loading = [name for name in lost if criteria[name].check.subject == "urdf"]
    joints = _missing_joints(difference)
    if not loading or not joints:
        return hints
    if len(joints) == 1:
        # The URDF does not load without it: one criterion says so, no other one.
        hints = {name: hint for name, hint in hints.items() if hint.proposal.link != joints[0].link}
    hints[loading[0]] = _hint_of_joints(written, joints)
    return hints


def _hints_of_links(
    difference: RobotDifference,
    written: Draft,
    criteria: _Criteria,
    lost: Mapping[str, Decimal],
) -> dict[str, FoundHint]:
    """Return a hint for each missing link with its joints, by the criterion that shows it."""
    hints = {}
    # links first, each with its joints
    left = sorted(difference.missing, key=lambda part: part.tag, reverse=True)
    while left:
        link = left[0].link
        is_link = left[0].tag == "link"
        parts = [part for part in left if part.link == link or (is_link and part.parent == link)]
        left = [part for part in left if part not in parts]
        about_link = _criteria_about(link, [name for name in lost if name not in hints], criteria)
        if about_link:
            hints[max(about_link, key=lambda name: lost[name])] = _hint_of_parts(written, parts)
    return hints


def _criteria_about(link: str, names: Sequence[str], criteria: _Criteria) -> list[str]:
    """Return the criteria of the robot that examine a link, else those that name it anywhere."""
    of_robot = [name for name in names if criteria[name].check.subject == "robot"]
    about_link = [name for name in of_robot if criteria[name].arguments.get("link") == link]
    if about_link:
        return about_link
    return [name for name in of_robot if link in texts_in(criteria[name].arguments)]


def _hint_of_joints(written: Draft, joints: _Parts) -> FoundHint:
    """Return the hint on missing joints without which the URDF does not load."""
    if len(joints) == 1:
        return _hint_of_parts(written, joints)
    lacking = enumerated([repr(part.link) for part in joints], MAX_IN_HINT)
    cause = f"the joints of {lacking} are missing"
    return FoundHint(Proposal((), cause), {}, words=f"add the joints of {lacking}")


def _missing_joints(difference: RobotDifference) -> _Parts:
    """Return the missing joints between links that exist."""
    has_link = difference.draft.robot.has_link
    return [part for part in difference.missing if has_link(part.link) and has_link(part.parent)]


def _hint_of_parts(written: Draft, parts: _Parts) -> FoundHint:
    first = parts[0].link if parts[0].tag == "link" else ""
    causes = enumerated([_cause_of_part(part, first) for part in parts])
    parts_in_words = enumerated(map(_part_in_words, parts))
    words = f"add {parts_in_words}{_lines_of_similar(written, parts)}"
    verb = "is" if len(parts) == 1 else "are"
    return FoundHint(Proposal((), f"{causes} {verb} missing", parts[0].link), {}, words=words)


def _cause_of_part(part: MissingPart, first: str) -> str:
    """Return words for a part; the joint of the first link is its joint."""
    if part.tag == "link":
        return f"the link {part.link!r}"
    if part.link == first:
        return "its joint"
    return f"the joint of {part.link!r}"


def _part_in_words(part: MissingPart) -> str:
    if part.tag == "link":
        return f"a link {part.link!r}"
    return f"a {part.joint_type} joint from {part.parent!r} to {part.link!r}"


def _lines_of_similar(draft: Draft, parts: _Parts) -> str:
    """Return where the first elements like the missing ones are."""
    lines = set()
    for part in parts:
        if part.tag == "link":
            like = next(draft.links(), None)
        else:
            joints = (joint for joint in draft.joints() if joint.get("type") == part.joint_type)
            like = next(joints, None)
        if like is not None:
            lines.add(draft.line(like))
    if not lines:
        return ""
    numbers = [str(line) for line in sorted(lines)[:_MAX_SIMILAR]]
    return f", as in line{'s' if len(numbers) > 1 else ''} {enumerated(numbers)}"
