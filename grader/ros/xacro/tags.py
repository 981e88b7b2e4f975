"""xacro's own tags: one function for each, as `eval_all` of ros/xacro handles it."""

from collections.abc import Mapping
from keyword import iskeyword

from grader.base.names import near
from grader.base.patterns import on_use
from grader.ros.python.values import Undetermined, Value
from grader.ros.xacro import xacro_problems
from grader.ros.xacro.expander import Expander, Handler, Scopes, TagFails
from grader.ros.xacro.macros import (
    Macro,
    MacroError,
    bind_blocks,
    bind_defaults,
    bind_values,
    read_parameters,
)
from grader.ros.xacro.scopes import (
    BOOLEANS,
    IncludedNames,
    Reported,
    UnknownName,
    XacroDefinition,
    XacroScope,
)
from grader.ros.xacro.xacro_files import FileFails
from grader.ros.xacro.xacro_nodes import XacroNode, walk

_MAX_CALLS = 100  # macros that call each other


def _needed(node: XacroNode, name: str) -> str:
    """Return an attribute that xacro requires."""
    if name not in node.attributes:
        given = [other for other in node.attributes if near(other, [name])]
        if len(given) == 1:
            unknown = UnknownName(given[0], {name: None}, "attribute", name)
        else:
            unknown = None
        raise TagFails(f"<{node.tag}> has no attribute {name}", unknown)
    return node.attributes[name]


def _renamed(node: XacroNode, tag: str, without: str) -> XacroNode:
    """Return an element with another tag and without an attribute."""
    other = XacroNode(
        tag, node.place, {name: text for name, text in node.attributes.items() if name != without}
    )
    other.children = node.children
    other.unresolved = node.unresolved
    return other


def _define_macro(expander: Expander, node: XacroNode, _: XacroNode, scopes: Scopes) -> None:
    """Bind a macro to its name; <xacro:macro> itself writes nothing."""
    written = _needed(node, "name")
    name = written.removeprefix("xacro:")
    if name == "call" or "." in name:
        raise TagFails(f"a macro cannot have the name {name}")
    if name != written:
        message = f"the macro is called {name}: write its name without xacro:"
        expander.warn(xacro_problems.XACRO_PREFIXED, message, node.place, "name")
    try:
        parameters = read_parameters(node.attributes.get("params", ""), expander.budget)
    except Undetermined as error:
        expander.texts.names_open = expander.texts.names_open or error  # calls of it are open too
        raise
    macro = Macro(name, node, parameters)
    scopes.macros.bind(
        name, macro, definition=XacroDefinition(name, "", node.place, "name", scopes.symbols)
    )


def _call_macro(expander: Expander, node: XacroNode, out: XacroNode, scopes: Scopes) -> None:
    """Expand a call of a macro by its name: <xacro:wheel prefix="left"/>."""
    _call_by_name(expander, node.tag.removeprefix("xacro:"), node, out, scopes)


def _call_dynamically(expander: Expander, node: XacroNode, out: XacroNode, scopes: Scopes) -> None:
    """Expand a call of a macro whose name is a value: <xacro:call macro="${name}"/>."""
    name = expander.texts.text(_needed(node, "macro"), scopes.symbols)
    call = _renamed(node, f"xacro:{name}", "macro")
    _call_by_name(expander, name, call, out, scopes)


def _call_by_name(
    expander: Expander, name: str, node: XacroNode, out: XacroNode, scopes: Scopes
) -> None:
    macro, around = _find_macro(name, scopes)
    if not macro:
        if expander.texts.names_open:
            raise expander.texts.names_open.with_traceback(None)
        raise MacroError(*expander.texts.unknown("macro", name, scopes.macros, expander.own_tags))
    if len(expander.calls) >= _MAX_CALLS:
        raise Undetermined(f"macros call each other more than {_MAX_CALLS} deep")
    expander.budget.charge(len(macro.parameters))
    inner = Scopes(XacroScope(around.macros), XacroScope(around.symbols))
    left = bind_values(macro, node, scopes.symbols, inner.symbols, expander.texts)
    given = XacroNode(node.tag, node.place)
    expander.content(node, given, scopes)
    if given.open and not given.elements:
        raise Undetermined(given.open)
    bind_blocks(macro, given.elements, left, inner.symbols)
    bind_defaults(macro, left, scopes.symbols, inner.symbols, expander.texts, node.place)
    expander.budget.charge(len(expander.calls))
    before = expander.calls
    expander.calls = (*before, (name, node.place))
    try:
        expander.start(macro.body, inner)  # xacro evaluates the attributes of <xacro:macro> too
        expander.insert(macro.body, out, inner)
    finally:
        expander.calls = before


def _find_macro(name: str, scopes: Scopes) -> tuple[Macro | None, Scopes]:
    """Return the macro of a name, and the scopes that its body is evaluated in.

    The macro may be in namespaces (arms.left).
    """
    macro = scopes.macros.bound(name)
    if macro is None:
        *namespaces, name = name.split(".")
        for namespace in namespaces:
            macros = scopes.macros.bound(namespace)
            names = scopes.symbols.bound(namespace)
            if not isinstance(macros, XacroScope) or not isinstance(names, IncludedNames):
                return None, scopes
            scopes = Scopes(macros, names.scope)
        macro = scopes.macros.bound(name)
    return macro if isinstance(macro, Macro) else None, scopes


def _insert_block(expander: Expander, node: XacroNode, out: XacroNode, scopes: Scopes) -> None:
    """Insert an element that a macro call gives, or the children of a property."""
    name = _needed(node, "name")
    for key in (f"**{name}", f"*{name}"):
        holder = scopes.symbols.holder(key)
        if holder:
            block = holder.properties[key].value
            break
    else:
        if expander.texts.names_open:
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


_PATTERN = on_use(r"[*\[?]")
_NAME = on_use(r"[^\W\d][\w.-]*(?::[^\W\d][\w.-]*)?")


def _boolean(value: Value, text: str) -> bool:
    """Return the boolean that a condition has as its value."""
    if not isinstance(value, str):
        return bool(value)
    try:
        if value in BOOLEANS:
            return BOOLEANS[value]
        return bool(int(value))
    except ValueError:
        raise TagFails(
            f'the condition "{text}" gives "{value}", which is neither true nor false'
        ) from None


def _flag(node: XacroNode, name: str, default: str, expander: Expander, scopes: Scopes) -> bool:
    text = node.attributes.get(name) or default
    return _boolean(expander.texts.evaluate(text, scopes.symbols), text)


def _property(expander: Expander, node: XacroNode, _: XacroNode, scopes: Scopes) -> None:
    symbols = scopes.symbols
    texts = expander.texts
    given = node.attributes
    name = _property_name(texts.text(_needed(node, "name"), symbols))
    is_removed = _flag(node, "remove", "false", expander, scopes)
    _check_ways(expander, node, name, is_removed=is_removed)
    if is_removed and texts.is_bound(name, symbols):
        texts.check_name(name, node.place)
        symbols.remove(name)
        return
    attribute = "default" if "default" in given else "value"
    if attribute == "default" and texts.is_bound(name, symbols):
        return
    text = given.get(attribute)
    is_lazy = _flag(node, "lazy_eval", "true", expander, scopes)
    is_lazy = is_lazy and given.get("scope") not in ("global", "parent")
    if text is None:
        name = f"**{name}"
    target = _target(given.get("scope"), name, symbols)
    texts.check_name(name, node.place)
    if text is None:
        target.bind(name, node, is_lazy=True, definition=None)
    elif is_lazy:
        definition = XacroDefinition(name, text, node.place, attribute, target)
        target.bind(name, text, is_lazy=True, definition=definition)
    else:
        texts.bind(target, name, text, symbols, node.place, attribute)


def _check_ways(expander: Expander, node: XacroNode, name: str, *, is_removed: bool) -> None:
    """Fail for a property that is defined in several ways, and warn of a scope without effect."""
    given = node.attributes
    if "default" in given and "scope" in given:
        message = "xacro warns that a property with default has the scope local only"
        expander.warn(xacro_problems.XACRO_ATTRIBUTE, message, node.place, "scope")
    ways = [key for key in ("value", "default") if key in given]
    if len(ways) > 1 or (ways and is_removed):
        raise TagFails(f"the property {name} has more than one of value, default and remove")


def _property_name(name: str) -> str:
    if not name.isidentifier() or iskeyword(name):
        raise TagFails(f"the name of a property must be a Python identifier, not {name!r}")
    if name.startswith("__"):
        raise TagFails(f"the name of a property must not begin with two underscores: {name}")
    return name


def _target(scope: str | None, name: str, symbols: XacroScope) -> XacroScope:
    """Return the scope in which a property is defined."""
    if scope == "global":
        return symbols.top
    if scope != "parent":
        return symbols
    if not symbols.caller:
        raise TagFails(f"the property {name} has the scope parent, but is outside of every macro")
    return symbols.caller


def _if(expander: Expander, node: XacroNode, out: XacroNode, scopes: Scopes) -> None:
    text = _needed(node, "value")
    try:
        keep = _boolean(expander.texts.evaluate(text, scopes.symbols), text)
    except Undetermined as error:
        _leave_names_open(expander, node, scopes.symbols, error)
        raise
    if keep == (node.tag == "xacro:if"):
        expander.insert(node, out, scopes)


def _leave_names_open(
    expander: Expander, node: XacroNode, symbols: XacroScope, error: Undetermined
) -> None:
    """Note that what an element would define, if it were kept, may have any value."""
    for inner in walk(node):
        name = inner.attributes.get("name", "")
        if (
            inner.tag == "xacro:property"
            and "value" in inner.attributes
            and "scope" not in inner.attributes
        ):
            symbols.bind(name, "")
            symbols.properties[name].failure = error
        elif inner.tag.startswith("xacro:") and inner.tag not in ("xacro:if", "xacro:unless"):
            expander.texts.names_open = error


def _arg(expander: Expander, node: XacroNode, _: XacroNode, scopes: Scopes) -> None:
    name = _needed(node, "name")
    default = _needed(node, "default")
    if name not in expander.texts.arguments and expander.texts.other_arguments == "unknown":
        expander.texts.arguments[name] = None
    if name not in expander.texts.arguments:
        expander.texts.arguments[name] = expander.texts.text(default, scopes.symbols)
        expander.texts.defaults[name] = XacroDefinition(
            name, default, node.place, "default", scopes.symbols
        )


def _element(expander: Expander, node: XacroNode, out: XacroNode, scopes: Scopes) -> None:
    name = expander.texts.evaluate(_needed(node, "xacro:name"), scopes.symbols)
    _check_name(name, node, expander)
    holder = XacroNode("", node.place)
    holder.children.append(_renamed(node, name, "xacro:name"))
    expander.content(holder, out, scopes)


def _attribute(expander: Expander, node: XacroNode, out: XacroNode, scopes: Scopes) -> None:
    """Set an attribute of the element around, which is lost where that is a tag of xacro."""
    texts = expander.texts
    name = texts.text(_needed(node, "name"), scopes.symbols)
    value = texts.text(_needed(node, "value"), scopes.symbols)
    _check_name(name, node, expander)
    expander.set(out, name, value)


def _check_name(name: Value, node: XacroNode, expander: Expander) -> None:
    if not isinstance(name, str) or not _NAME.fullmatch(name):
        raise TagFails(
            f"<{node.tag}> needs a name that XML allows, not {expander.texts.written(name)[:60]!r}"
        )


def _include(expander: Expander, node: XacroNode, out: XacroNode, scopes: Scopes) -> None:
    texts = expander.texts
    if node.elements:
        message = "xacro ignores the elements inside <xacro:include>"
        expander.warn(xacro_problems.XACRO_CHILDREN, message, node.place)
    if node.attributes.get("ns"):
        inner = _namespace(
            expander, texts.text(node.attributes["ns"], scopes.symbols), scopes, node
        )
    else:
        inner = scopes
    optional = node.attributes.get("optional")
    is_optional = optional is not None and _boolean(optional, optional)
    try:
        path = expander.files.path(texts.text(_needed(node, "filename"), scopes.symbols))
        _insert_file(expander, path, out, inner)
        expander.files.followed.setdefault((node.place.source.path, node.place.tag), []).append(
            path
        )
    except FileFails as error:
        if is_optional:
            return
        texts.names_open = texts.names_open or Reported(str(error))
        raise
    except Undetermined as error:
        if not isinstance(texts.names_open, Undetermined):
            texts.names_open = error
        raise


_OF_XACRO = frozenset(
    ("parent", "root", "depth", "unevaluated", "recursive", "top")
)  # attributes of its scopes


def _namespace(expander: Expander, name: str, scopes: Scopes, node: XacroNode) -> Scopes:
    """Return the scopes of an included file with a namespace, which `name` stands for.

    It sees no macros around.
    """

    def find(wanted: str) -> Value:
        if wanted in _OF_XACRO:
            raise Undetermined(f"{name}.{wanted} is not supported")
        return expander.texts.find(wanted, inner.symbols)

    inner = Scopes(XacroScope(is_namespace=True), XacroScope(scopes.symbols, is_namespace=True))
    scopes.macros.bind(name, inner.macros)
    expander.texts.check_name(name, node.place)
    scopes.symbols.bind(name, IncludedNames(name, find, inner.symbols))
    return inner


def _insert_file(expander: Expander, path: str, out: XacroNode, scopes: Scopes) -> None:
    if _PATTERN.search(path):
        raise Undetermined("a pattern that names several files is not supported")
    root = expander.files.nodes(path)
    expander.files.open.append(path)
    try:
        expander.start(root, scopes)
        expander.insert(root, out, scopes)
    finally:
        expander.files.open.pop()


HANDLERS: Mapping[str, Handler] = {
    "xacro:property": _property,
    "xacro:macro": _define_macro,
    "xacro:call": _call_dynamically,
    "xacro:insert_block": _insert_block,
    "xacro:if": _if,
    "xacro:unless": _if,
    "xacro:arg": _arg,
    "xacro:element": _element,
    "xacro:attribute": _attribute,
    "xacro:include": _include,
}
CALL: Handler = _call_macro
