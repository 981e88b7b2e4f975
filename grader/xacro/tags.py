"""xacro's own tags: one function for each, as `eval_all` of ros/xacro handles it."""

import re
from collections.abc import Mapping
from keyword import iskeyword

from grader.python.values import Undetermined, Value
from grader.xacro.expander import Expander, Handler, Scopes, TagFails
from grader.xacro.files import FileFails
from grader.xacro.macro_tags import call_dynamically, call_macro, define_macro, insert_block, needed, renamed
from grader.xacro.nodes import XacroNode
from grader.xacro.scopes import BOOLEANS, Definition, Reported, XacroScope

_PATTERN = re.compile(r"[*\[?]")
_NAME = re.compile(r"[^\W\d][\w.-]*(?::[^\W\d][\w.-]*)?")


def _boolean(value: Value, text: str) -> bool:
    """Return the boolean that a condition has as its value."""
    if not isinstance(value, str):
        return bool(value)
    try:
        return BOOLEANS[value] if value in BOOLEANS else bool(int(value))
    except ValueError:
        raise TagFails(f'the condition "{text}" gives "{value}", which is neither true nor false') from None


def _flag(node: XacroNode, name: str, default: str, expander: Expander, scopes: Scopes) -> bool:
    text = node.attributes.get(name) or default
    return _boolean(expander.texts.evaluate(text, scopes.symbols), text)


def _property(expander: Expander, node: XacroNode, _: XacroNode, scopes: Scopes) -> None:
    symbols, texts, given = scopes.symbols, expander.texts, node.attributes
    name = _property_name(texts.text(needed(node, "name"), symbols))
    is_removed = _flag(node, "remove", "false", expander, scopes)
    if ("value" in given) + ("default" in given) + is_removed > 1:
        raise TagFails(f"the property {name} has more than one of value, default and remove")
    if is_removed and texts.is_bound(name, symbols):
        symbols.remove(name)
        return
    if "default" in given and texts.is_bound(name, symbols):
        return
    attribute = "default" if "default" in given else "value"
    text = given.get(attribute)
    value: Value = text
    if text is None:
        name, value = f"**{name}", node
    is_lazy = _flag(node, "lazy_eval", "true", expander, scopes) and given.get("scope") not in ("global", "parent")
    target = _target(given.get("scope"), name, symbols)
    if is_lazy or text is None:
        definition = Definition(name, text, node.place, attribute, target) if text is not None else None
        target.bind(name, value, is_lazy=True, definition=definition)
    else:
        texts.bind(target, name, text, symbols, node.place, attribute)


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
    if symbols.parent is None:
        raise TagFails(f"the property {name} has the scope parent, but is outside of every macro")
    return symbols.parent


def _if(expander: Expander, node: XacroNode, out: XacroNode, scopes: Scopes) -> None:
    text = needed(node, "value")
    keep = _boolean(expander.texts.evaluate(text, scopes.symbols), text)
    if keep == (node.tag == "xacro:if"):
        expander.insert(node, out, scopes)


def _arg(expander: Expander, node: XacroNode, _: XacroNode, scopes: Scopes) -> None:
    name, default = needed(node, "name"), needed(node, "default")
    if name not in expander.texts.arguments:
        expander.texts.arguments[name] = expander.texts.text(default, scopes.symbols)
        expander.texts.defaults[name] = Definition(name, default, node.place, "default", scopes.symbols)


def _element(expander: Expander, node: XacroNode, out: XacroNode, scopes: Scopes) -> None:
    name = expander.texts.evaluate(needed(node, "xacro:name"), scopes.symbols)
    _check_name(name, node, expander)
    holder = XacroNode("", node.place)
    holder.children.append(renamed(node, name, "xacro:name"))
    expander.content(holder, out, scopes)


def _attribute(*_: object) -> None:
    raise Undetermined("<xacro:attribute> is not supported")


def _check_name(name: Value, node: XacroNode, expander: Expander) -> None:
    if not isinstance(name, str) or not _NAME.fullmatch(name):
        raise TagFails(f"<{node.tag}> needs a name that XML allows, not {expander.texts.written(name)[:60]!r}")


def _include(expander: Expander, node: XacroNode, out: XacroNode, scopes: Scopes) -> None:
    texts = expander.texts
    if node.attributes.get("ns"):
        texts.names_open = Undetermined("an included file with a namespace is not supported")
        raise texts.names_open
    optional = node.attributes.get("optional")
    is_optional = optional is not None and _boolean(optional, optional)
    try:
        path = expander.files.path(texts.text(needed(node, "filename"), scopes.symbols))
        _insert_file(expander, path, out, scopes)
        expander.files.followed.setdefault((node.place.source.path, node.place.tag), []).append(path)
    except FileFails as error:
        if is_optional:
            return
        texts.names_open = texts.names_open or Reported(str(error))
        raise
    except Undetermined as error:
        if not isinstance(texts.names_open, Undetermined):
            texts.names_open = error
        raise


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
    "xacro:macro": define_macro,
    "xacro:call": call_dynamically,
    "xacro:insert_block": insert_block,
    "xacro:if": _if,
    "xacro:unless": _if,
    "xacro:arg": _arg,
    "xacro:element": _element,
    "xacro:attribute": _attribute,
    "xacro:include": _include,
}
CALL: Handler = call_macro
