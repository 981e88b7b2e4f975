"""What does not agree in a workspace, as problems.

docs/examples/ref.toml explains their kinds.
"""

from collections.abc import Iterable, Sequence

from grader.base.problems import Problem
from grader.base.text import in_quotes
from grader.ros.package.package import MANIFEST
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.name_fixes import NameFixes
from grader.workspace.rules.names import (
    Mismatch,
    Mismatches,
)
from grader.workspace.rules.reading import read_agreement
from grader.workspace.rules.rule_table import (
    UNUSED,
    Rule,
)

_FILE_USED = Rule(
    "file-used",
    "files",
    UNUSED,
    "Another file names each file of the robot.",
    why=(
        "No program loads the file, so an edit of it changes nothing. Parameters keep their "
        "defaults, and what the file describes is missing in the robot."
    ),
    wrong="Node(package='turtlesim', executable='turtlesim_node'),",
    right="""
Node(
    package='turtlesim',
    executable='turtlesim_node',
    parameters=[os.path.join(share, 'config', 'speed.yaml')],
),
""",
    beside={
        "speed.yaml": """
/**:
  ros__parameters:
    background_r: 100
""",
    },
    at="config/speed.yaml",
)


def name_problems(workspace: Workspace) -> tuple[Problem, ...]:
    """Return what does not agree as problems with their fixes, in the order of files and lines.

    The packages that one package.xml lacks are one problem.
    """
    agreement = read_agreement(workspace)
    name_fixes = NameFixes(workspace)
    problems = []
    for wrong in _with_one_for_a_manifest(workspace, agreement.mismatches):
        problem = wrong.rule.problem(wrong.message, wrong.location, is_certain=wrong.is_certain)
        problem = problem._replace(
            related=wrong.related,
            fixes=name_fixes.of(wrong),
            cause=wrong.cause,
            names=(*wrong.names, wrong.word),
        )
        place = name_fixes.place_of_word(wrong)
        if place:
            problem = problem._replace(location=place, around=wrong.location)
        problems.append(problem)
    for at in agreement.unused:
        problems.append(_FILE_USED.problem("no other file of the workspace names this file", at))
    # Of a macro of xacro that several robots call, each place once.
    by_place: dict[tuple[object, ...], Problem] = {}
    for problem in problems:
        at = problem.location
        by_place.setdefault((problem.message, at.path, at.line, at.column), problem)
    return tuple(by_place.values())


def _with_one_for_a_manifest(workspace: Workspace, mismatches: Iterable[Mismatch]) -> Mismatches:
    """Yield mismatches, of the packages that one package.xml lacks only the first, which has all.

    Those of which it is certain that nothing else installs them are apart from the others, and so
    are those that CMake needs.
    """
    lacked: dict[tuple[object, ...], list[Mismatch]] = {}
    every = list(_without_repeated_packages([*mismatches]))
    for mismatch in every:
        if mismatch.lacked:
            lacked.setdefault(_make_group(mismatch), []).append(mismatch)
    for mismatch in every:
        of_manifest = lacked.get(_make_group(mismatch), [])
        if not mismatch.lacked:
            yield mismatch
        elif mismatch is of_manifest[0]:
            names = tuple(each.lacked for each in of_manifest)
            message = _lacked_text(workspace, of_manifest)
            yield mismatch._replace(message=message, names=names)


def _without_repeated_packages(mismatches: Sequence[Mismatch]) -> Mismatches:
    """Yield mismatches without those that say of a package what another one says.

    Of a package that nothing has, it drops that package.xml does not declare it; of a misspelt
    dependency that a file uses, it drops that rosdep does not know it.
    """
    absent = {mismatch.word for mismatch in mismatches if mismatch.rule.name == "package-exists"}
    misspelt = set()
    for mismatch in mismatches:
        if mismatch.rule.name == "dependency-declared":
            misspelt |= {correction.new for correction in mismatch.corrections}
    for mismatch in mismatches:
        is_absent = mismatch.rule.name == "dependency-declared" and mismatch.word in absent
        is_misspelt = mismatch.rule.name == "rosdep-key" and mismatch.word in misspelt
        if not is_absent and not is_misspelt:
            yield mismatch


def _make_group(mismatch: Mismatch) -> tuple[object, ...]:
    """Return what the packages that are said together have in common."""
    return mismatch.related, mismatch.rule.name, mismatch.is_certain, mismatch.tag


def _lacked_text(workspace: Workspace, mismatches: Sequence[Mismatch]) -> str:
    """Return which packages a package.xml does not declare, and the tags to add."""
    names = [mismatch.lacked for mismatch in mismatches]
    tag = mismatches[0].tag
    tags = " ".join(f"<{tag}>{name}</{tag}>" for name in names)
    used = "which is used here" if len(names) == 1 else "which its files use"
    if not mismatches[0].is_certain:
        used += ", and which only packages that it declares bring"
    manifest = mismatches[0].related
    owner = ""
    for package in workspace.packages:
        if manifest and package.path(MANIFEST) == manifest.path:
            owner = package.name
    return f"package.xml of {owner!r} does not declare {in_quotes(names)}, {used}: add {tags}"
