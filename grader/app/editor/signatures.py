"""The parameters of a macro of xacro, while its call is written."""

from lsprotocol import types as lsp

from grader.app.editor.completions import typed_place
from grader.app.editor.look import Look
from grader.app.editor.places import TextPlace

_PREFIX = "xacro:"


def signature(look: Look, place: TextPlace) -> lsp.SignatureHelp | None:
    """Return the parameters of the macro whose call a place is in; None elsewhere."""
    typed = typed_place(place)
    holder = typed.holder if typed else None
    if not holder or not holder.name.startswith(_PREFIX) or not holder.slot:
        return None
    signatures = []
    for path, parameters in look.names.parameters_of_macro(holder.name.removeprefix(_PREFIX)):
        names = [
            parameter.lstrip("*").partition(":")[0].partition("=")[0] for parameter in parameters
        ]
        active = names.index(holder.slot) if holder.slot in names else None
        shown = [lsp.ParameterInformation(parameter) for parameter in parameters]
        label = " ".join([holder.name, *parameters])
        signatures.append(lsp.SignatureInformation(label, path, shown, active))
    return lsp.SignatureHelp(signatures, 0) if signatures else None
