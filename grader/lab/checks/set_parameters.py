"""The check of what nodes do when their parameters are set."""

from grader.base.errors import NotDecided
from grader.lab.checks.check import About
from grader.lab.checks.outcome import Outcome, failed, passed
from grader.lab.submission.submission import Submission

ABOUT = {"takes_parameters": About(causes={"accepts": "a callback accepts all values"})}


def takes_parameters(submission: Submission, *, refuses: bool = False) -> Outcome:
    """A node is told when its parameters are set at run time, by a callback or by a handler of
    parameter events.

    A node that reads its parameters without being told may do so again and again, and needs manual
    grading.

    Args:
        refuses: Whether it has to refuse values: by a callback whose result is not always
            successful, or by a range or `read_only` in the descriptor of a parameter.
    """
    from grader.workspace.api import parameter_callbacks  # late: few rubrics ask for it

    submission.needed_package()
    callbacks = parameter_callbacks(submission.workspace)
    if refuses:
        does = "refuses values of its parameters"
        at = callbacks.refuses
        reason = "a library may check them" if callbacks.is_generated else ""
        if callbacks.may_refuse:
            reason = "a condition may decide that its result is successful"
    else:
        does = "is told when its parameters are set"
        at = callbacks.told
        is_open = callbacks.is_generated or callbacks.is_read
        reason = "code may read them again and again" if is_open else ""
    if at:
        return passed(f"a node {does}")
    if reason:
        cause = f"cannot determine statically whether a node {does}"
        raise NotDecided(f"{cause}: {reason}", cause)
    if callbacks.told:
        detail = ": its callback accepts all"
        return failed(f"no node {does}", callbacks.told, detail=detail, cause="accepts")
    return failed(f"no node {does}")
