"""The parameters of a macro of xacro, while its call is written."""

import re

from lsprotocol import types as lsp

from grader.app.editor.look import Look
from grader.app.editor.places import TextPlace

_CALL = re.compile(r"<xacro:(?P<macro>[\w.-]++)(?P<given>\s[^<>]*+)\Z")
_GIVEN = re.compile(r"(?<![\w.-])(?P<name>[\w.-]++)\s*+=\s*+(?P<value>[\"'])?")


def signature(look: Look, place: TextPlace) -> lsp.SignatureHelp | None:
    """Return the parameters of the macro whose call a place is in; None elsewhere."""
    call = _CALL.search(place.lines.text_before(place.line, place.column))
    macros = look.names.parameters_of_macro(call["macro"]) if call is not None else []
    if call is None or not macros:
        return None
    given = [each["name"] for each in _GIVEN.finditer(call["given"])]
    signatures = []
    for path, parameters in macros:
        label = " ".join([f"xacro:{call['macro']}", *parameters])
        named = [re.split(":=|=|:", parameter)[0].lstrip("*") for parameter in parameters]
        active = named.index(given[-1]) if given and given[-1] in named else None
        shown = [lsp.ParameterInformation(parameter) for parameter in parameters]
        signatures.append(lsp.SignatureInformation(label, path, shown, active))
    return lsp.SignatureHelp(signatures, 0)
