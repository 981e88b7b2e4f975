"""The check of the transforms that nodes look up."""

from grader.base.errors import NotDecided
from grader.base.text import quoted
from grader.lab.checks.check import About
from grader.lab.checks.outcome import Outcome, failed, passed
from grader.lab.submission.submission import Submission

ABOUT = {
    "looks_up": About(causes={"exchanged": "the target frame and the source frame are exchanged"})
}


def looks_up(
    submission: Submission, *, target: str, source: str, either_way: bool = False
) -> Outcome:
    """A node looks up the transform from the source frame to the target frame, which is the pose of
    the source frame in the target frame.

    The exchanged frames pass if the file inverts a transform; if it or another file may do so, they
    need manual grading. Names that are parameters are those that the node gets from a launch
    file. A transform that is looked up in other ways needs manual grading.

    Args:
        target: The target frame, the first argument of `lookup_transform`.
        source: The source frame, the second one.
        either_way: Whether the exchanged frames pass in any case.
    """
    from grader.workspace.api import looked_up_transforms  # late: few rubrics ask for it

    submission.needed_package()
    wanted = (target.removeprefix("/"), source.removeprefix("/"))
    lookups, may_be_others = looked_up_transforms(submission.workspace)
    for lookup in lookups:
        if (lookup.target, lookup.source) == wanted:
            return passed(f"{lookup.node} looks up {quoted(source)} in {quoted(target)}")
    exchanged = [lookup for lookup in lookups if (lookup.source, lookup.target) == wanted]
    for lookup in exchanged:
        if either_way or lookup.inverts == "yes":
            shown = f"{quoted(target)} in {quoted(source)}"
            return passed(f"{lookup.node} looks up {shown}, and inverts it")
    if any(lookup.inverts == "perhaps" for lookup in exchanged):
        cause = "cannot determine statically whether the code inverts the transform"
        raise NotDecided(cause)
    if may_be_others:
        cause = "cannot determine statically which transforms are looked up"
        raise NotDecided(cause)
    if exchanged:
        lookup = exchanged[0]
        message = (
            f"{lookup.node} looks up the pose of {quoted(target)} in {quoted(source)}; it "
            f"should be that of {quoted(source)} in {quoted(target)}"
        )
        detail = ": the frames are exchanged"
        return failed(message, lookup.location, detail=detail, cause="exchanged")
    message = f"no node looks up {quoted(source)} in {quoted(target)}"
    known = [f"{quoted(at.source or '')} in {quoted(at.target or '')}" for at in lookups]
    detail = f"; there is {known[0]}" if known else ""
    return failed(message, lookups[0].location if lookups else None, detail=detail)
