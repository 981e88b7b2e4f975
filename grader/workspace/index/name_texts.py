"""What an editor says of a name besides where it is defined."""

from collections.abc import Iterator

from grader.base.errors import NotDecided
from grader.workspace.graph.graph import make_graph
from grader.workspace.index.written_names import WrittenName
from grader.workspace.model.workspace import Workspace

_MAX_ENDS = 10
_MAX_FIELDS = 20


def list_texts(workspace: Workspace, name: WrittenName) -> Iterator[str]:
    """Yield what is known of a topic, service, action or type of messages, a fact each."""
    if name.kind in ("topic", "service", "action"):
        rows = {}
        try:
            rows.update(dict.fromkeys(_ends(workspace, name.owner)))
        except NotDecided:
            return
        yield from list(rows)[:_MAX_ENDS]
    elif name.kind == "message type":
        yield from _fields(workspace, name.name)


def _ends(workspace: Workspace, full: str) -> Iterator[str]:
    """Yield the nodes that have an end of a full name after a launch."""
    for graph in make_graph(workspace).launched:
        for node in graph.nodes:
            for end in node.ends:
                if end.name == full:
                    kind = f" ({end.type})" if end.type else ""
                    yield f"{end.kind}: {node.label}{kind}"


def _fields(workspace: Workspace, full: str) -> Iterator[str]:
    """Yield the fields of an own message, service or action."""
    package, _, name = full.partition("/")
    interfaces = workspace.code.interfaces.get(package)
    if not interfaces or name.replace("/", ".") not in interfaces.types:
        return
    sections = interfaces.types[name.replace("/", ".")].interface.sections
    fields = [field for section in sections for field in section.fields.items()]
    for field, about in fields[:_MAX_FIELDS]:
        kind = about.type.full_name.replace(".", "/")
        yield f"{field}: {kind}{'[]' if about.type.is_list else ''}"
