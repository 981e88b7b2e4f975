"""grader lsp: a language server, which an editor starts."""

from typing import Annotated

from grader.app.cli.options import rubric_option
from grader.base.errors import GraderError

_RUBRIC = (
    "Show the criteria that fail under this rubric, an id or a .toml file, as well; default: the "
    "key rubric of grader.toml, if it is there."
)


def lsp(
    rubric: Annotated[str, rubric_option(_RUBRIC)] = "",
) -> None:
    """Show in an editor, as you type, what inspect and grade find.

    An editor starts this command and talks to it on standard input and output, by the Language
    Server Protocol. It lists problems, also of text that is not saved, says what a name is and
    where it is defined and used, completes names, corrects problems, and renames what can be
    renamed without making anything wrong. It needs the extra editor: pip install
    'urdf-grader[editor]'.

    Examples:

      grader lsp

      grader lsp --rubric lab6
    """
    try:
        from grader.app.editor.server import serve
    except ModuleNotFoundError as error:
        if error.name not in ("pygls", "lsprotocol"):
            raise
        message = "grader lsp needs the extra editor: pip install 'urdf-grader[editor]'"
        raise GraderError(message) from None
    serve(rubric)
