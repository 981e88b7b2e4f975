"""A xacro document, and short ways to write one."""

from collections.abc import Iterable, Mapping
from typing import Literal, NamedTuple
from xml.sax.saxutils import quoteattr

PATH = "urdf/robot.urdf.xacro"
PACKAGES = {"my_robot": "", "arm_parts": "parts"}
"""The packages of the submission and their folders."""

Dependence = Literal["never", "perhaps", "always"]


class Document(NamedTuple):
    """A document, the files beside it, and the arguments of the command line.

    `undetermined` says whether the result depends on what is outside of the submission, such as an environment
    variable: `always`, and it has to be reported; `perhaps`, and it can be reported.
    """

    text: str
    files: Mapping[str, str | bytes] = {}
    arguments: Mapping[str, str] = {}
    undetermined: Dependence = "never"
    path: str = PATH


Documents = dict[str, Document]


def robot(body: str) -> str:
    """Return a robot in xacro with this body."""
    return f'<?xml version="1.0"?>\n<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n{body}\n</robot>\n'


def part(body: str) -> str:
    """Return an included file with this body."""
    return f'<robot xmlns:xacro="http://www.ros.org/wiki/xacro">{body}</robot>'


def bodies(
    undetermined: Dependence = "never",
    files: Mapping[str, str | bytes] | None = None,
    arguments: Mapping[str, str] | None = None,
    **table: str,
) -> Documents:
    """Return one document for each body; what is given besides belongs to all of them."""
    return {
        name.replace("_", "-"): Document(robot(body), files or {}, arguments or {}, undetermined)
        for name, body in table.items()
    }


def named(name: str, value: str, more: str = "") -> str:
    """Return a property; `more` holds further attributes."""
    return f"<xacro:property name={quoteattr(name)} value={quoteattr(value)} {more}/>"


def shown(*texts: str) -> str:
    """Return an element for each text, which has it as an attribute."""
    return "".join(f"<shown x={quoteattr(text)}/>" for text in texts)


def expressions(
    listed: Iterable[str], before: str = "", undetermined: Dependence = "never"
) -> Documents:
    """Return one document for each expression, which is shown after what stands before it."""
    return {
        expression: Document(robot(before + shown(f"${{{expression}}}")), undetermined=undetermined)
        for expression in listed
    }


def merged(*tables: Documents) -> Documents:
    """Return all documents of several tables; no two have the same name."""
    documents: Documents = {}
    for table in tables:
        for name, document in table.items():
            assert name not in documents, name
            documents[name] = document
    return documents
