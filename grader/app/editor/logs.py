"""What the files of an editor explain of an output of a terminal."""

from collections.abc import Iterable

from grader.app.editor.session import EditorSession, SupersededError
from grader.base.errors import GraderError
from grader.report.inspection import NO_FAILURE, log_line
from grader.workspace.api import LogAnswer, explain_log

EXPLAIN = "grader.explain"  # the command of the server


def explain(sessions: Iterable[EditorSession], log: str) -> list[str]:
    """Return what the folders of an editor say of a log, a line for each message.

    Lines begin with the whole path of a file that explains something. Where no folder explains a
    message, each says that it is not explained, once.
    """
    explained: dict[str, None] = {}
    others: dict[str, None] = {}
    data = log.encode("utf-8", "replace")
    for session in sessions:
        try:
            look = session.look(ends_anyway=True)
        except (GraderError, SupersededError):
            continue
        for answer in explain_log(look.opened, look.problems, data):
            lines = explained if answer.location else others
            lines[_line(session, answer)] = None
    return [*explained, *others] or [NO_FAILURE]


def _line(session: EditorSession, answer: LogAnswer) -> str:
    at = answer.location
    if at:
        path = (session.files.root / at.path).as_posix()
        answer = answer._replace(location=at._replace(path=path))
    return log_line(answer)
