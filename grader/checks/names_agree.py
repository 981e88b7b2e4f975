"""The check of names: those that files of the packages use are defined in one of them."""

from grader.checks.outcome import Outcome, failed, passed
from grader.errors import NotDecided
from grader.submission.submission import Submission
from grader.text import first_lines
from grader.workspace.names import Agreement, Family, Mismatch, place_text

_MAX_NAMED = 3  # mistakes in a message


def names_agree(submission: Submission, *, of: Family) -> Outcome:
    """The names that files of the packages use are defined: files, frames, parameters, programs and so on.

    A name fails only where everything that could define it was read. One that a package which is not submitted may
    define is not wrong. Names that other packages of the submission use do not count.

    Args:
        of: What is named: files, frames, controllers, parameters, arguments, programs, topics or dependencies.
    """
    submission.needed_package()
    wrong, undecided = wrong_names(submission, of), _agreement(submission).undecided
    if wrong:
        texts = [f"{place_text(it.location)}: {it.message}" for it in wrong[1:]]
        message = "; ".join([wrong[0].message, *first_lines(texts, _MAX_NAMED - 1)])
        return failed(message, wrong[0].location, mistake=wrong[0].message)
    if of in undecided:
        reason = undecided[of]
        cause = f"cannot determine statically whether the names of {of} agree"
        raise NotDecided(f"{cause}: {reason}", cause)
    return passed(f"the names of {of} agree")


def wrong_names(submission: Submission, family: Family) -> list[Mismatch]:
    """Return what certainly does not agree in the packages that are graded."""
    packages = submission.lab_packages.values()
    own = [it for it in _agreement(submission).mismatches if it.family == family and it.is_sure]
    return [it for it in own if any(package.holds(it.location.path) for package in packages)]


def _agreement(submission: Submission) -> Agreement:
    from grader.workspace.reading import read_agreement  # late: few rubrics ask for it

    return read_agreement(submission)
