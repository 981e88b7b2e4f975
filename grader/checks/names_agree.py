"""The check of names: those that files of the packages use are defined in one of them."""

from grader.checks.outcome import Outcome, failed, passed
from grader.errors import NotDecided
from grader.source import Location
from grader.submission.submission import Submission
from grader.text import first_lines
from grader.workspace.names import Family, place_text

_MAX_NAMED = 3  # mistakes in a message


def names_agree(submission: Submission, *, of: Family) -> Outcome:
    """The names that files of the packages use are defined: files, frames, parameters, programs and so on.

    A name fails only where everything that could define it was read. One that a package which is not submitted may
    define is not wrong. Names that other packages of the submission use do not count.

    Args:
        of: What is named: files, frames, controllers, parameters, arguments, programs, topics or dependencies.
    """
    from grader.workspace.reading import read_agreement, wrong_names  # late: few rubrics ask for it

    submission.needed_package()
    wrong, undecided = wrong_names(submission, of), read_agreement(submission).undecided
    if wrong:
        places: dict[str, Location] = {}
        for it in wrong:  # one mistake may be at several places
            places.setdefault(it.message, it.location)
        (message, at), *others = places.items()
        texts = [f"{place_text(place)}: {text}" for text, place in others]
        return failed("; ".join([message, *first_lines(texts, _MAX_NAMED - 1)]), at, mistake=message)
    if of in undecided:
        reason = undecided[of]
        cause = f"cannot determine statically whether the names of {of} agree"
        raise NotDecided(f"{cause}: {reason}", cause)
    return passed(f"the names of {of} agree")
