"""What a failed criterion came to, in words that are the same for all who made the same mistake."""

import re

from grader.checks.outcome import Outcome

_REASON = re.compile(
    r" \([A-Z]+[0-9]{3}: .*\)$|; the (?:file|package|robot) (?:has|have)[: ].*$|; did you mean .*$", re.DOTALL
)
_JOINT = re.compile(r"""(?<!no )\bjoint (?:'(?:[^'\\]|\\.)*+'|"(?:[^"\\]|\\.)*+")""")  # as Python quotes a name
_PLACE = re.compile(r", in line \d+|of line \d+")
_MOST = 200


def kind_of_miss(outcome: Outcome) -> str:
    """What was measured and expected, as the message says it, without what differs from one student to the next.

    That is the names of joints, line numbers, why ROS 2 sees it so, and what else there is in the file.
    """
    said = _REASON.sub("", outcome.message)
    return _PLACE.sub("", _JOINT.sub("the joint", said))[:_MOST]
