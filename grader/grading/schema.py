"""The JSON Schema of a rubric, for editors: its keys, and the arguments of every installed check."""

import json
from collections.abc import Iterable
from typing import Any

from grader.checks.check import Check
from grader.checks.registry import check_names, usable_check
from grader.checks.toml_types import TomlType, described
from grader.grading.keys import CRITERION, DEFAULTS, RUBRIC
from grader.grading.toml_rows import KeyTable

_DRAFT = "https://json-schema.org/draft/2020-12/schema"
_Schema = dict[str, Any]


def rubric_schema() -> _Schema:
    """Return the JSON Schema of a rubric, with the arguments of every check, also of installed plug-ins."""
    named = {name: usable_check(name) for name in check_names()}
    checks = [check for check in named.values() if check is not None]
    facts = [check.documentation.fact if check is not None else "" for check in named.values()]
    schema, criterion = RUBRIC.schema, CRITERION.schema
    carried = criterion["properties"]["carried"]
    for row in (criterion, carried, carried["items"]):
        row["properties"]["check"] |= {"enum": list(named), "x-taplo": {"docs": {"enumValues": facts}}}
        # In a row with allOf, taplo completes no key.
        row |= {"if": {"required": ["check"]}, "then": {"$ref": "#/$defs/arguments"}}
    criterion["required"] = [key for key in criterion["required"] if key not in DEFAULTS.keys]
    schema["properties"]["criterion"]["items"] = criterion
    defaults = {check.name: {"$ref": f"#/$defs/{check.name}"} for check in checks}
    schema["properties"]["defaults"]["properties"]["with"] |= {"properties": defaults, "additionalProperties": False}
    definitions = {check.name: _arguments(check) for check in checks}
    definitions["arguments"] = {"allOf": [_if_check(check, {"$ref": f"#/$defs/{check.name}"}) for check in checks]}
    definitions |= _complete(checks)
    # Only the loader knows which of the missing keys the defaults give.
    complete = {"properties": {"criterion": {"items": {"$ref": "#/$defs/complete"}}}}
    schema |= {"if": {"not": {"required": ["defaults"]}}, "then": complete}
    return {"$schema": _DRAFT, "title": "grader rubric", **schema, "$defs": definitions}


def _complete(checks: Iterable[Check]) -> _Schema:
    """Return definitions of what else a rubric without defaults requires: in its criteria, and in what they carry."""
    needed = [(check, [name for name, it in check.parameters.items() if it.required]) for check in checks]
    rules = [_if_check(check, {"required": names}) for check, names in needed if names]
    of_check = {"$ref": "#/$defs/needed"}
    required = [key for key in CRITERION.schema["required"] if key in DEFAULTS.keys]
    complete = {**of_check, "required": required, "properties": {"carried": {**of_check, "items": of_check}}}
    return {"needed": {"allOf": rules}, "complete": complete}


def _if_check(check: Check, arguments: _Schema) -> _Schema:
    """Return the rule that the arguments of a check, where a table names it, meet a schema."""
    then: _Schema = {"properties": {"with": arguments}}
    if "required" in arguments:
        then["required"] = ["with"]
    return {"if": {"properties": {"check": {"const": check.name}}, "required": ["check"]}, "then": then}


def _arguments(check: Check) -> _Schema:
    """Return the schema of the arguments of a check, none of which is required."""
    return KeyTable(check.name, {name: _argument(check, name) for name in check.parameters}).schema


def _argument(check: Check, name: str) -> TomlType:
    """Return the type of an argument with its meaning, and its default if a rubric can give that."""
    parameter, meaning = check.parameters[name], check.documentation.arguments.get(name, "")
    try:
        json.dumps(parameter.default, allow_nan=False)
    except (TypeError, ValueError):  # of a plug-in
        return described(parameter.type, meaning)
    return described(parameter.type, meaning, **({} if parameter.default is None else {"default": parameter.default}))
