"""The documents on which the grader and xacro have to agree, in groups by rule."""

from tests.xacro.documents import (
    arguments,
    conditions,
    elements,
    expressions,
    includes,
    macros,
    properties,
    robots,
    yaml_files,
)
from tests.xacro.documents.document import Documents

GROUPS: dict[str, Documents] = {
    "arguments": arguments.DOCUMENTS,
    "conditions": conditions.DOCUMENTS,
    "elements": elements.DOCUMENTS,
    "expressions": expressions.DOCUMENTS,
    "includes": includes.DOCUMENTS,
    "macros": macros.DOCUMENTS,
    "properties": properties.DOCUMENTS,
    "robots": robots.DOCUMENTS,
    "yaml": yaml_files.DOCUMENTS,
}
