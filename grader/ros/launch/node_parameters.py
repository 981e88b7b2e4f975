"""The parameters of nodes: what launch_ros gives a node, and which value counts in the end.

Launch evaluates them first; rclcpp and rclpy then read the files and rules on the node's command
line, in order.
"""

import posixpath
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import chain, pairwise, starmap
from math import inf, nan
from pathlib import PurePosixPath
from typing import Any

from grader.base.grouping import as_list
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.source import Location
from grader.ros.config.yaml_nodes import Visits, YamlFault, YamlNode, read_yaml, yaml_value
from grader.ros.config.yaml_values import is_misspelt_key
from grader.ros.installation.places import PREFIX
from grader.ros.known.package_rows import program_row
from grader.ros.launch.call_arguments import (
    FILE,
    SCALARS,
    TYPED,
    describe_kind,
    items_in,
    read_type,
)
from grader.ros.launch.launch_model import (
    NAMESPACE,
    Contents,
    Context,
    FileText,
    GivenParameters,
    ParameterValue,
    Resolved,
    StartedNode,
    UnknownTable,
    UnknownText,
)
from grader.ros.launch.substitutions import (
    PART_UNKNOWN,
    TEXT_PARTS,
    boolean,
    known_text,
    located,
    not_a_text,
    resolve,
)
from grader.ros.python.parse import START, Position
from grader.ros.python.values import (
    Call,
    EvaluationFails,
    EvaluationSignal,
    Undetermined,
    Unknown,
    Value,
)

_KnownValues = Mapping[str, ParameterValue]

_Values = dict[str, ParameterValue]  # parameters by their names

_EVERY_NODE = "/**"
# the launch configuration that has what SetParameter gives to all nodes, as in launch_ros
TO_ALL = "global_params"
_MAX_YAML = 200_000  # characters
_MAX_DEPTH = 40
_MAX_WORD = 40  # characters of a text that may be read as a number
_HEAD = '<?xml version="1.0" ?>\n<!-- by xacro -->\n'  # of what xacro writes
# xacro writes blanks in place of tabs, but for those in comments.
_COMMENT_OR_TAB = on_use(r"<!--.*?(?:-->|\Z)|\t", re.DOTALL)
_KEY = "ros__parameters"
_SUBSTITUTION = "$("
# As rcl reads a scalar of YAML, which is not what PyYAML makes of it.
_TRUE = frozenset(["Y", "y", "yes", "Yes", "YES", "true", "True", "TRUE", "on", "On", "ON"])
_FALSE = frozenset(["N", "n", "no", "No", "NO", "false", "False", "FALSE", "off", "Off", "OFF"])
_INTEGER = on_use(r"([+-]?)(0[xX][0-9a-fA-F]+|0[0-7]*|[1-9][0-9]*)")
_FLOAT = on_use(r"[+-]?([0-9]++\.?[0-9]*+|\.[0-9]++)([eE][+-]?[0-9]+)?")
_SPECIAL = {".nan": nan, ".inf": inf, "+.inf": inf, "-.inf": -inf}
_PARAM_FILES = ("-p", "--param-file")


class _Place(Named):
    """Where the parameters of a node are written: in which action, and the place of it."""

    context: Context
    at: Position
    location: Location
    is_named: bool


_Read = Iterator[GivenParameters | EvaluationSignal]


def evaluate_parameters(
    call: Call, context: Context, location: Location
) -> tuple[Iterator[GivenParameters], EvaluationSignal | None]:
    """Evaluate the parameters of a Node action up to the first error or doubt.

    There launch_ros stops.

    Returns:
        What each item gives the node: what follows the first error or doubt is evaluated when it is
        iterated; and that error or doubt, if there is one.
    """
    has_namespace = call.kwargs.get("namespace") is not None or NAMESPACE in context.arguments
    is_named = has_namespace and call.kwargs.get("name") is not None
    place = _Place(context, call.at, location, is_named)
    reading = _read_items(call.kwargs.get("parameters"), place)
    read: list[GivenParameters] = []
    for part in reading:
        if isinstance(part, EvaluationSignal):
            rest = (part for part in reading if isinstance(part, GivenParameters))
            return chain(read, rest), part
        read.append(part)
    return iter(read), None


def _read_items(parameters: Value, place: _Place) -> _Read:
    """Yield what each item gives the node, and each error or doubt where it is met."""
    try:
        items = items_in(parameters) or []
    except Undetermined as signal:
        yield signal
        items = [parameters]
    for item in items:
        try:
            yield from _read_item(item, place)
        except EvaluationSignal as signal:
            yield signal
            yield GivenParameters(place.location, unknown=str(signal))


def _read_item(item: Value, place: _Place) -> _Read:
    """Yield the table, or the file by its path, that an item is. Raises EvaluationSignal."""
    if isinstance(item, dict):
        yield from _read_table(item, place)
    elif isinstance(item, Call) and item.name == FILE:
        yield from _read_file(item, place)
    elif isinstance(item, Call) and item.name in TYPED:
        raise Undetermined("a parameter of this kind is not evaluated", item.at)
    elif isinstance(item, PurePosixPath):
        yield GivenParameters(place.location, str(item))
    elif isinstance(item, set) and any(isinstance(part, FileText) for part in item):
        yield GivenParameters(place.location, values={})  # launch_ros looks for a file of this name
    else:
        yield _make_file(resolve(item, place.context, place.at), place)


def _read_file(call: Call, place: _Place) -> _Read:
    """Yield the file of a ParameterFile. Raises EvaluationSignal."""
    with located(call.at):
        path = _resolve_path(call, place.context)
    is_plain = call.kwargs.get("allow_substs") in (None, False)
    text = place.context.find_text(path) if isinstance(path, str) else None
    if not is_plain and (text is None or _SUBSTITUTION in text):
        yield Undetermined("substitutions in a parameter file are not evaluated", call.at)
    yield _make_file(path, place, is_plain=is_plain)


def _make_file(path: Resolved, place: _Place, *, is_plain: bool = True) -> GivenParameters:
    if isinstance(path, str):
        return GivenParameters(place.location, path, is_plain=is_plain)
    return GivenParameters(place.location, unknown=str(not_a_text(path)))


def _read_table(table: dict[Any, Value], place: _Place) -> _Read:
    """Yield the values in a dict, each unknown for itself; all are unknown if a name is.

    Raises EvaluationSignal for names and for dicts in it.
    """
    context, at, location, is_named = place
    values: _Values = {}
    for key, value in table.items():
        name = resolve(key, context, at)
        if not isinstance(name, str):
            try:
                _evaluate_dict(table, context, at)  # launch needs no name to go on
            except EvaluationSignal as signal:
                yield signal
            yield GivenParameters(location, unknown=str(not_a_text(name)))
            return
        try:
            evaluated = _evaluate_dict({name: value}, context, at)
        except EvaluationSignal as signal:
            if isinstance(value, dict):
                raise
            yield signal
            evaluated = {name: Unknown(str(signal), at)}
        values |= _parameter_values(evaluated, value, at, location)
    yield GivenParameters(location, values=values, is_named=is_named)


def _resolve_path(call: Call, context: Context) -> Resolved:
    """Return the path in a ParameterFile. Raises EvaluationSignal."""
    given = call.kwargs["param_file"]
    if isinstance(given, PurePosixPath):
        return str(given)
    if not all(isinstance(part, TEXT_PARTS) for part in as_list(given)):
        raise Undetermined("the path of a parameter file is not evaluated")
    return resolve(given, context, call.at)


def _evaluate_dict(table: dict[Any, Value], context: Context, at: Position) -> dict[str, Any]:
    """Return the values in a dict of parameters, those of dicts in it by dotted names.

    Raises EvaluationSignal.
    """
    values = {}
    for key, value in table.items():
        name = resolve(key, context, at)
        if not isinstance(name, str):
            name = "?"
        if not isinstance(value, dict):
            values[name] = _evaluate_value(name, value, context, at)
            continue
        for inner, evaluated in _evaluate_dict(value, context, at).items():
            values[f"{name}.{inner}"] = evaluated
    return values


def _evaluate_value(name: str, value: Value, context: Context, at: Position) -> Any:
    match value:
        case Call() if value.name in TYPED:
            with located(value.at):
                return _evaluate_typed(value, context)
        case UnknownText():
            resolve(value, context, at)
        case list() | tuple() | range():
            return _evaluate_list(name, list(value), context, at)
        case Call() | Unknown():
            return _read_as_yaml(name, value, context, at)
    return value


def _evaluate_list(name: str, items: list[Value], context: Context, at: Position) -> Any:
    kinds = {type(item) for item in items if isinstance(item, SCALARS)}
    if any(isinstance(item, Call) for item in items) and all(
        isinstance(element, TEXT_PARTS) for element in items
    ):
        return _read_as_yaml(name, items, context, at)
    if not items or not all(isinstance(item, SCALARS) for item in items):
        raise Undetermined(f"the value of the parameter {name!r} is not evaluated")
    if len(kinds) > 1 and kinds != {int, float}:
        raise EvaluationFails(f"the parameter {name!r} is a list of values of different types")
    if len(kinds) > 1:
        return list(map(float, items))
    return items


def _evaluate_typed(call: Call, context: Context) -> Any:
    value = call.kwargs["value"]
    if isinstance(value, UnknownText):
        resolve(value, context, call.at)
    if isinstance(value, (*SCALARS, UnknownText)) or (
        isinstance(value, list | tuple) and not any(isinstance(element, Call) for element in value)
    ):
        return value
    try:
        kind = read_type(call)
    except Undetermined as error:
        raise Undetermined(f"{error} is not evaluated") from None
    if kind is None:
        return _read_as_yaml("value", value, context, call.at)
    text = resolve(value, context, call.at)
    if kind is str:
        return text
    if not isinstance(text, str):
        raise Undetermined("the value of a parameter is not evaluated")
    try:
        if kind is bool:
            return boolean(text)
        return kind(text)
    except ValueError:
        raise EvaluationFails(
            f"the value {text[:40]!r} of a parameter is not {kind.__name__}"
        ) from None


def _read_as_yaml(name: str, value: Value, context: Context, at: Position) -> Any:
    loaded = _value_as_yaml(name, value, context, at)
    if not (isinstance(loaded, list) and _is_uniform(loaded)) and not isinstance(
        loaded, (*SCALARS, bytes)
    ):
        hint = "write ParameterValue(..., value_type=str)"
        raise EvaluationFails(
            f"the parameter {name!r} is read as YAML, and is {describe_kind(loaded)} then: {hint}",
        )
    return loaded


def _value_as_yaml(name: str, value: Value, context: Context, at: Position) -> Any:
    """Return the value of a text as YAML. Raises EvaluationSignal."""
    resolved = resolve(value, context, at)
    if isinstance(resolved, Unknown):
        raise Undetermined(
            f"the value of the parameter {name!r} is not evaluated: {resolved.reason}"
        )
    text = context.find_text(resolved.path) if isinstance(resolved, Contents) else resolved
    if text is None:
        return ""  # a file that is not there is reported for itself
    try:
        if len(text) > _MAX_YAML:
            raise Undetermined(f"the parameter {name!r} is too long to be read as YAML")
        if isinstance(resolved, Contents) and resolved.by == "xacro":
            text = _COMMENT_OR_TAB.sub(lambda match: " " if match[0] == "\t" else match[0], text)
        return yaml_value(text) if text else text
    except ValueError:
        if isinstance(resolved, Contents) and resolved.by == "xacro" and not _is_never_yaml(text):
            raise Undetermined(
                f"whether the output of xacro is YAML, as which {name!r} is read, is not evaluated",
            ) from None
        hint = "write ParameterValue(..., value_type=str)"
        raise EvaluationFails(
            f"the parameter {name!r} is read as YAML, which fails: {hint}"
        ) from None


def _is_never_yaml(text: str) -> bool:
    """Return whether a URDF is no YAML after xacro either.

    The reason is that xacro keeps comments, texts and values.
    """
    if "xacro:" in text or "${" in text or "$(" in text:
        return False
    try:
        yaml_value(_HEAD + re.sub(r"[ \t]+", " ", text))
    except ValueError:
        return True
    return False


def _is_uniform(values: list[Any]) -> bool:
    kind = type(values[0]) if values else None
    return kind in SCALARS and all(isinstance(value, kind) for value in values if kind)


_OpenFile = Callable[
    [str], tuple[bytes, str] | None
]  # returns an installed file, and its path in the workspace


def set_for_all(
    name: Value, value: Value, context: Context, at: Position, location: Location
) -> GivenParameters:
    """Return what SetParameter gives to all nodes; unknown where its name is not known.

    Raises EvaluationSignal for its value.
    """
    evaluated = _evaluate_dict({"": value}, context, at)
    try:
        prefix = known_text(name, context)
    except EvaluationSignal as signal:
        return GivenParameters(location, unknown=str(signal))
    values = _parameter_values(evaluated, value, at, location)
    rules = {f"{prefix}{below}": _as_rule(given) for below, given in values.items()}
    return GivenParameters(location, values=rules)


def _as_rule(given: ParameterValue) -> ParameterValue:
    """Return a value as rcl reads its text in the rule name:=value."""
    value = given.value
    if isinstance(value, list | bytes | Unknown):
        return given._replace(value=Unknown("the text of this parameter is not evaluated", START))
    return given._replace(value=_read_text(str(value)))


def _parameter_values(
    evaluated: Mapping[str, Any], value: Value, at: Position, location: Location
) -> _Values:
    """Return what a value in a table gives by the names of parameters, with its place."""
    given_at = None
    if isinstance(value, Call) and location.line != value.at.line:
        # In XML and YAML the place of the value is that of the parameter.
        given_at = location if location.path.endswith(".py") else None
        location = location._replace(line=value.at.line, column=value.at.column)
    values = {}
    for name, given in evaluated.items():
        written = _replace_stand_ins(given, at)
        read = _as_file_has(written)
        is_other = isinstance(written, str) and not isinstance(read, str)
        text = written if is_other else ""
        values[name] = ParameterValue(read, location, text=text, given_at=given_at)
    return values


def _as_file_has(value: Any) -> Any:
    """Return a value as rcl reads it in the file that launch_ros writes for the node.

    PyYAML writes a text without quotes if it would read a text there, and rcl reads some of these
    as other values: y, 0483, 1e5.
    """
    if isinstance(value, list):
        return [_as_file_has(item) for item in value]
    if not isinstance(value, str) or len(value) > _MAX_WORD:
        return value
    read = _scalar(value)
    has_quotes = not isinstance(read, str) and not isinstance(yaml_value(value), str)
    return value if has_quotes else read


def _replace_stand_ins(value: Any, at: Position) -> Any:
    """Return a value without stand-ins; the contents of a file are unknown."""
    is_plain = isinstance(value, (*SCALARS, list)) and PART_UNKNOWN not in str(value)
    if is_plain or isinstance(value, Unknown):
        return value
    if isinstance(value, Contents):
        return FileText("the contents of a file are not evaluated", at, value)
    return Unknown("the contents of a file are not evaluated", at)


def parameters_in_words(words: Sequence[str], at: Location) -> Iterator[GivenParameters]:
    """Yield the parameters of the arguments for ROS: -p name:=value, --params-file path."""
    for option, word in pairwise(words):
        if option not in ("-p", "--param", "--params-file"):
            continue
        rule, _, text = word.partition(":=")
        node, _, name = rule.rpartition(":")
        if PART_UNKNOWN in rule:
            yield GivenParameters(at, unknown="an argument of the node is not evaluated")
        elif option == "--params-file":
            yield GivenParameters(at, word)
        else:
            yield GivenParameters(
                at, values={name: ParameterValue(_read_text(text), at)}, node=node
            )


def _read_text(text: str) -> Any:
    try:
        if PART_UNKNOWN not in text:
            return _read_value(read_yaml(text.encode(), ""))
        return Unknown("a text", START)
    except YamlFault as fault:
        return Unknown(str(fault), START)


def _read_value(node: YamlNode) -> Any:
    """Return the value of a parameter as rcl reads it: a scalar or a list of them; else Unknown."""
    if isinstance(node.value, list):
        if any(item.text is None for item in node.items):
            return Unknown("a list of different values", START)
        items = [_read_value(item) for item in node.items]
        kinds = {type(item) for item in items}
        if len(kinds) == 1 and kinds <= {*SCALARS}:
            return items
        return Unknown("a list of different values", START)
    text = node.text
    if text is None or (not text and not node.is_string):
        return Unknown("no value", START)
    if node.has_type:
        return Unknown("a value with a tag, which rcl reads from Lyrical on", START)
    return text if node.is_string else _scalar(text)


def _scalar(text: str) -> "bool | int | float | str":
    if text in _TRUE or text in _FALSE:
        return text in _TRUE
    if match := _INTEGER.fullmatch(text):
        sign, digits = match.groups()
        if digits[:2].lower() == "0x":
            base = 16
        elif digits[0] == "0":
            base = 8
        else:
            base = 10
        return int(sign + digits, base)
    if text.lower() in _SPECIAL:
        return _SPECIAL[text.lower()]
    if _FLOAT.fullmatch(text):
        return float(text)
    return text


class NodeParameters(Named):
    """The parameters that a node is given, by their names.

    If something is `unknown`, there may be more of them.

    The value of one is Unknown where it is not evaluated, or may be replaced by what is unknown.
    """

    values: _KnownValues
    node: StartedNode  # that is given them
    unknown: str = ""  # why there may be more


class _Table(Named):
    """What a section of a parameter file, or a launch file, gives the nodes of a key."""

    key: str | None
    known: _KnownValues
    opened: Mapping[str, Unknown] = {}  # tables that are not known, whose names are not either


class FileTables(Named):
    """The sections of a parameter file, or why it is not read."""

    tables: tuple[_Table, ...]
    fault: str = ""


_ReadFile = Callable[[bytes, str, bool], FileTables]


def read_tables(
    data: bytes, path: str, is_plain: bool, *, are_keys_meant: bool = False
) -> FileTables:
    """Return the sections of a parameter file; of one that is not plain, launch replaces `$(`.

    With `are_keys_meant`, a misspelt key ros__parameters counts as that.
    """
    try:
        root = read_yaml(data, path)
    except YamlFault as fault:
        return FileTables((), f"the file {path} is not readable as YAML: {fault}")
    visits = Visits()
    sections = tuple(_sections(root, "", visits, is_plain=is_plain, is_meant=are_keys_meant))
    if not visits.is_complete:
        return FileTables((), f"the file {path} has too many aliases to read")
    return FileTables(tuple(starmap(_make_table, sections)))


def _make_table(key: str | None, values: _KnownValues) -> _Table:
    known = {}
    opened = {}
    for parameter, row in values.items():
        if isinstance(row.value, UnknownTable):
            opened[parameter] = row.value
        else:
            known[parameter] = row
    return _Table(key, known, opened)


def collect_parameters(
    node: StartedNode, open_file: _OpenFile, name: str = "", read: _ReadFile = read_tables
) -> NodeParameters:
    """Return the parameters that a node gets from a launch file, and where each is written.

    Later files and tables replace earlier ones. Of the keys of nodes in them (`/**`, `/ns/node`,
    `node`), the one counts that is met last for the first time, for rclcpp and, since rclpy 3.7,
    for rclpy.

    Args:
        node: The node, as it is started.
        open_file: Returns the parameter file at a path below the prefix, and its path in the
            workspace.
        name: The name that the node has in its program if the launch file gives it none; or the
            full name of another node of the same process, such as a controller.
        read: Returns the sections of a parameter file.
    """
    full = _full_name(node, name)
    by_key: dict[str | None, _Values] = {}
    reasons = []
    if node.parameters is None:
        return NodeParameters({}, node, "the parameters of the node are not evaluated")
    for given in node.parameters:
        try:
            tables = _read_tables(given, open_file, _full_name(node, ""), read)
        except Undetermined as error:
            reasons.append(str(error))
            doubt = Unknown(str(error), START)
            for before in by_key.values():
                before.update(
                    {parameter: row._replace(value=doubt) for parameter, row in before.items()}
                )
            continue
        for table in tables:
            reasons += [unknown.reason for unknown in table.opened.values()]
            _forget_below(table.opened, by_key)
            by_key.setdefault(table.key, {}).update(table.known)
    return NodeParameters(_select_values(by_key, full), node, "; ".join(dict.fromkeys(reasons)))


def _forget_below(tables: Mapping[str, Unknown], by_key: dict[str | None, _Values]) -> None:
    """Make the values unknown that parameters in a table that is not known may replace."""
    for name, doubt in tables.items():
        for values in by_key.values():
            below = [other for other in values if not name or f"{other}.".startswith(f"{name}.")]
            values.update((other, values[other]._replace(value=doubt)) for other in below)


def _full_name(node: StartedNode, name: str) -> str | None:
    """Return the name of a node with its namespace; None where it is not known."""
    own_name = name or node.node_name
    if own_name and own_name.startswith("/"):
        return own_name
    if own_name and node.namespace is not None:
        return f"/{node.namespace.strip('/')}/{own_name}".replace("//", "/")
    return None


def _read_tables(
    given: GivenParameters, open_file: _OpenFile, full_name: str | None, read: _ReadFile
) -> Sequence[_Table]:
    """Return the parameters by keys of nodes; `full_name` is the one that the launch file gives.

    Raises Undetermined.
    """
    if given.unknown:
        raise Undetermined(given.unknown)
    if not given.path:
        return [_make_table(_find_key(given, full_name), given.values)]
    path = posixpath.normpath(given.path)
    file = open_file(path.removeprefix(f"{PREFIX}/")) if path.startswith(f"{PREFIX}/") else None
    if file is None:
        raise Undetermined(
            f"the file {path.removeprefix(PREFIX)} is not read: the submission does not install it"
        )
    parsed = read(*file, given.is_plain)
    if parsed.fault:
        raise Undetermined(parsed.fault)
    return parsed.tables


def _find_key(given: GivenParameters, full_name: str | None) -> str | None:
    """Return for which nodes the parameters of a launch file are.

    Returns None for the node itself, whose name is not known.
    """
    if given.is_named:
        return full_name
    if given.node:
        return f"/{given.node.strip('/')}"
    return _EVERY_NODE


def _sections(
    node: YamlNode, key: str, visits: Visits, *, is_plain: bool, is_meant: bool
) -> Iterator[tuple[str, _Values]]:
    """Yield the sections of a parameter file, each with its key, which begins with a slash.

    With `is_meant`, a misspelt key ros__parameters is one as well.
    """
    if key.count("/") >= _MAX_DEPTH or not visits.enters(node):
        return
    for name, value in node.pairs:
        if name == _KEY or (is_meant and is_misspelt_key(name, value)):
            values = {}
            for parameter, row, named_at in _flat(value, "", None, 0, visits):
                if isinstance(row.value, str | list):
                    given = value_in_file(row, is_plain=is_plain)
                    values[parameter] = given._replace(named_at=named_at)
            yield key, values
        else:
            below = f"{key}/{name.strip('/')}"
            yield from _sections(value, below, visits, is_plain=is_plain, is_meant=is_meant)


def _flat(
    node: YamlNode, name: str, named_at: Location | None, depth: int, visits: Visits
) -> Iterator[tuple[str, YamlNode, Location | None]]:
    """Yield the values below a node, with the names of their parameters, and where these end."""
    if not isinstance(node.value, dict) or depth > _MAX_DEPTH:
        yield name, node, named_at
    elif visits.enters(node):
        for key, value in node.value.items():
            at = node.key_location(key) if key in node.key_marks else None
            yield from _flat(value, f"{name}.{key}" if name else key, at, depth + 1, visits)


def value_in_file(node: YamlNode, *, is_plain: bool = True) -> ParameterValue:
    """Return the value that a parameter file has for a parameter.

    In a file that is not plain, launch replaces `$(`.
    """
    if not is_plain and _SUBSTITUTION in str(node.text):
        return ParameterValue(
            Unknown("substitutions in a parameter file are not evaluated", START), node.location
        )
    return ParameterValue(_read_value(node), node.location)


def _select_values(by_key: Mapping[str | None, _KnownValues], full: str | None) -> _Values:
    """Return the values that count for a node.

    They are of all sections in the order in which their keys are met first.
    """
    if full is None:
        return _select_for_any_name(by_key)
    return _merge(values for key, values in by_key.items() if is_section_key(key, full))


def _select_for_any_name(
    by_key: Mapping[str | None, _KnownValues],
) -> _Values:
    """Return the values of sections for every node.

    Those that another section may replace are unknown.
    """
    doubt = Unknown("the name of the node is not known", START)
    known = _merge(values for key, values in by_key.items() if key in (_EVERY_NODE, None))
    others = _merge(values for key, values in by_key.items() if key not in (_EVERY_NODE, None))
    return {**known, **{name: given._replace(value=doubt) for name, given in others.items()}}


def _merge(tables: Iterable[_KnownValues]) -> _Values:
    merged: _Values = {}
    for table in tables:
        merged |= table
    return merged


def is_section_key(key: str | None, full: str) -> bool:
    """Return whether the key of a section names a node by its full name.

    `*` stands for one name, `**` for any number of them. The keys of what a launch file gives are
    None.
    """
    if key is None or "*" not in key:
        return key == full
    names = full.split("/")
    reached: Sequence[int] = range(1)  # how many names the parts so far may stand for
    for part in key.split("/"):
        if part == "**":
            reached = range(reached[0], len(names) + 1)
        else:
            after = [count + 1 for count in reached if part in ("*", *names[count : count + 1])]
            reached = [count for count in after if count <= len(names)]
        if not reached:
            return False
    return len(names) in reached


def remap_rules(words: Sequence[str]) -> list[tuple[str, str, str]]:
    """Return the remappings among arguments for ROS, each with its separator between the names."""
    return [word.partition(":=") for option, word in pairwise(words) if option in ("-r", "--remap")]


def list_controllers(spawner: StartedNode) -> tuple[StartedNode, ...] | None:
    """Return the controllers that a spawner starts, as nodes.

    The nodes have the files and remappings that it gives them.

    They are None if not all are known. A controller has the namespace of its controller manager, in
    whose process it runs: what that is given applies to it as well, and what the spawner gives
    counts more.
    """
    words = spawner.arguments
    if words is None or None in words or spawner.namespace is None:
        return None
    names, given = _read_spawner_words([word for word in words if word])
    files = [path for option in _PARAM_FILES for path in given.get(option, ())]
    parameters = tuple(GivenParameters(spawner.location, path) for path in files)
    rules = remap_rules(" ".join(given.get("--controller-ros-args", ())).split())
    started = spawner._replace(
        namespace=_namespace_of_manager(given, spawner.namespace),
        parameters=parameters,
        arguments=(),
        remaps=tuple((name, to) for name, _, to in rules),
    )
    return tuple(started._replace(node_name=name) for name in names)


def _read_spawner_words(words: Sequence[str]) -> tuple[list[str], dict[str, list[str]]]:
    """Return the names of controllers in a spawner's command line, and its options."""
    names = []
    given: dict[str, list[str]] = {}
    options = program_row("controller_manager", "spawner").valued_options
    if "--ros-args" in words:
        words = words[: words.index("--ros-args")]
    rest = iter(words)
    for word in rest:
        option, is_joined, value = word.partition("=")
        if option in options:
            given.setdefault(option, []).append(value if is_joined else next(rest, ""))
        elif not word.startswith("-"):
            names.append(word)
    return names, given


def _namespace_of_manager(given: Mapping[str, Sequence[str]], namespace: str) -> str:
    """Return the namespace of the controller manager that the options of a spawner name."""
    managers = [*given.get("-c", ()), *given.get("--controller-manager", ())]
    manager = managers[-1] if managers else "controller_manager"
    if not manager.startswith("/"):
        manager = f"/{namespace.strip('/')}/{manager}"
    return manager.replace("//", "/").rpartition("/")[0] or "/"
