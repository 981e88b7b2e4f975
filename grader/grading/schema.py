"""The JSON Schema of a rubric, for editors: its keys, and the arguments of every installed check."""

import json
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
    # Only the loader knows which of the missing keys and arguments the defaults give.
    criterion["required"] = [key for key in criterion["required"] if key not in DEFAULTS.keys]
    schema["properties"]["criterion"]["items"] = criterion
    defaults = {check.name: {"$ref": f"#/$defs/{check.name}"} for check in checks}
    schema["properties"]["defaults"]["properties"]["with"] |= {"properties": defaults, "additionalProperties": False}
    tables = [KeyTable(check.name, {name: _argument(check, name) for name in check.parameters}) for check in checks]
    definitions = {table.name: table.schema for table in tables}
    chosen = [({"check": {"const": name}}, {"with": arguments}) for name, arguments in defaults.items()]
    rules = [{"if": {"properties": it, "required": ["check"]}, "then": {"properties": then}} for it, then in chosen]
    definitions["arguments"] = {"allOf": rules}
    return {"$schema": _DRAFT, "title": "grader rubric", **schema, "$defs": definitions}


def _argument(check: Check, name: str) -> TomlType:
    """Return the type of an argument with its meaning, and its default if a rubric can give that."""
    parameter, meaning = check.parameters[name], check.documentation.arguments.get(name, "")
    try:
        json.dumps(parameter.default, allow_nan=False)
    except (TypeError, ValueError):  # of a plug-in
        return described(parameter.type, meaning)
    return described(parameter.type, meaning, **({} if parameter.default is None else {"default": parameter.default}))
