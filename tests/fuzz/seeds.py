"""Seeds that tests of the readers have already: small URDFs, xacro documents, expressions, XML."""

import re
from collections.abc import Iterable, Iterator, Mapping

from tests.hints.broken_urdfs import BROKEN
from tests.urdf.edge_cases import EDGE_CASES
from tests.urdf.problem_samples import SAMPLES
from tests.xacro.documents import GROUPS
from tests.xacro.documents.document import Document
from tests.xacro.hostile import HOSTILE

_EXPRESSION = re.compile(r"\$\{([^{}]+)\}")


def urdfs() -> Iterator[bytes]:
    """Yield a small URDF for each problem, and those whose verdict is compared with ROS 2's."""
    yield from (
        _bytes(text)
        for text in (*(case.text for case in EDGE_CASES), *(sample.data for sample in SAMPLES))
    )


def broken() -> Iterator[bytes]:
    """Yield XML with one error."""
    yield from (one.text.encode() for one in BROKEN)


def xacro() -> Iterator[bytes]:
    """Yield the documents on which the grader and xacro agree, and hostile ones, each with its files."""
    yield from (
        joined({document.path: document.text, **document.files}) for document in _documents()
    )


def expressions() -> Iterator[bytes]:
    """Yield the expressions in them."""
    texts = (found for document in _documents() for found in _EXPRESSION.findall(document.text))
    yield from (text.replace("&lt;", "<").replace("&quot;", '"').encode() for text in texts)


def yaml_files() -> Iterator[bytes]:
    """Yield the YAML files beside them."""
    files = (file for document in _documents() for file in document.files.items())
    yield from dict.fromkeys(_bytes(content) for path, content in files if path.endswith(".yaml"))


def _documents() -> Iterator[Document]:
    tables: Iterable[Mapping[str, Document]] = (*GROUPS.values(), HOSTILE)
    yield from (document for table in tables for document in table.values())


def joined(files: Mapping[str, str | bytes]) -> bytes:
    """Return files as one input that holds several."""
    return b"\n".join(
        b"=== %b\n%b" % (path.encode(), _bytes(content)) for path, content in files.items()
    )


def _bytes(text: str | bytes) -> bytes:
    return text.encode("utf-8", "surrogateescape") if isinstance(text, str) else text
