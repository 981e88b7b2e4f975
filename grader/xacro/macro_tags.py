"""The tags of xacro that define macros and call them, and that insert the elements which a call gives."""

from grader.names import near
from grader.python.values import Undetermined
from grader.xacro.expander import Expander, Scopes, TagFails
from grader.xacro.macros import (
    Macro,
    MacroError,
    bind_blocks,
    bind_defaults,
    bind_values,
    find_macro,
    read_parameters,
)
from grader.xacro.nodes import XacroNode
from grader.xacro.scopes import Definition, UnknownName, XacroScope

_MAX_CALLS = 100  # macros that call each other


def needed(node: XacroNode, name: str) -> str:
    """Return an attribute that xacro requires."""
    if name not in node.attributes:
        given = [other for other in node.attributes if near(other, [name])]
        unknown = UnknownName(given[0], {name: None}, "attribute", name) if len(given) == 1 else None
        raise TagFails(f"<{node.tag}> has no attribute {name}", unknown)
    return node.attributes[name]


def renamed(node: XacroNode, tag: str, without: str) -> XacroNode:
    """Return an element with another tag and without an attribute."""
    other = XacroNode(tag, node.place, {name: text for name, text in node.attributes.items() if name != without})
    other.children, other.unresolved = node.children, node.unresolved
    return other


def define_macro(expander: Expander, node: XacroNode, _: XacroNode, scopes: Scopes) -> None:
    """Bind a macro to its name; <xacro:macro> itself writes nothing."""
    name = needed(node, "name").removeprefix("xacro:")
    if name == "call" or "." in name:
        raise TagFails(f"a macro cannot have the name {name}")
    macro = Macro(name, node, read_parameters(node.attributes.get("params", ""), expander.budget))
    scopes.macros.bind(name, macro, definition=Definition(name, "", node.place, "name", scopes.symbols))


def call_macro(expander: Expander, node: XacroNode, out: XacroNode, scopes: Scopes) -> None:
    """Expand a call of a macro by its name: <xacro:wheel prefix="left"/>."""
    _call_by_name(expander, node.tag.removeprefix("xacro:"), node, out, scopes)


def call_dynamically(expander: Expander, node: XacroNode, out: XacroNode, scopes: Scopes) -> None:
    """Expand a call of a macro whose name is a value: <xacro:call macro="${name}"/>."""
    name = expander.texts.text(needed(node, "macro"), scopes.symbols)
    call = renamed(node, f"xacro:{name}", "macro")
    _call_by_name(expander, name, call, out, scopes)


def _call_by_name(expander: Expander, name: str, node: XacroNode, out: XacroNode, scopes: Scopes) -> None:
    macro = find_macro(name, scopes.macros)
    if macro is None:
        if expander.texts.names_open is not None:
            raise expander.texts.names_open.with_traceback(None)
        raise MacroError(*expander.texts.unknown("macro", name, scopes.macros, expander.own_tags))
    if len(expander.calls) >= _MAX_CALLS:
        raise Undetermined(f"macros call each other more than {_MAX_CALLS} deep")
    expander.budget.charge(len(macro.parameters))
    inner = Scopes(XacroScope(scopes.macros), XacroScope(scopes.symbols))
    left = bind_values(macro, node, scopes.symbols, inner.symbols, expander.texts)
    given = XacroNode(node.tag, node.place)
    expander.content(node, given, scopes)
    if given.open and not given.elements:
        raise Undetermined(given.open)
    bind_blocks(macro, given.elements, left, inner.symbols)
    bind_defaults(macro, left, scopes.symbols, inner.symbols, expander.texts)
    expander.budget.charge(len(expander.calls))
    before = expander.calls
    expander.calls = (*before, (name, node.place))
    try:
        expander.start(macro.body, inner)  # xacro evaluates the attributes of <xacro:macro> too
        expander.insert(macro.body, out, inner)
    finally:
        expander.calls = before


def insert_block(expander: Expander, node: XacroNode, out: XacroNode, scopes: Scopes) -> None:
    """Insert an element that a macro call gives, or the children of a property."""
    name = needed(node, "name")
    for key in (f"**{name}", f"*{name}"):
        holder = scopes.symbols.holder(key)
        if holder is not None:
            block = holder.properties[key].value
            break
    else:
        if expander.texts.names_open is not None:
            raise expander.texts.names_open.with_traceback(None)
        expander.budget.charge(len(scopes.symbols.properties))
        known = scopes.symbols.blocks()
        unknown = UnknownName(name, known, "block", near(name, known))
        raise MacroError(f"there is no block {name} at this place", unknown)
    if key.startswith("**"):
        expander.start(block, scopes)
        expander.insert(block, out, scopes)
    else:
        new = expander.start(block, scopes)
        out.children.append(new)
        expander.content(block, new, scopes)
