"""The grammar of values in XML and YAML launch files, text and $(substitutions ...): grammar.lark of ros2/launch."""

from dataclasses import dataclass

from grader.names import closest
from grader.package.launch.model import Findings
from grader.static_python.parse import Position
from grader.static_python.values import Call, Value

_MAX_DEPTH = 40
# The Python name of each substitution of the XML and YAML frontends.
_SUBSTITUTIONS = {
    "find-pkg-share": "launch_ros.substitutions.FindPackageShare",
    "find-pkg-prefix": "launch_ros.substitutions.FindPackagePrefix",
    "var": "launch.substitutions.LaunchConfiguration",
    "command": "launch.substitutions.Command",
    "find-exec": "launch.substitutions.FindExecutable",
    "dirname": "launch.substitutions.ThisLaunchFileDir",
    "env": "launch.substitutions.EnvironmentVariable",
    "eval": "launch.substitutions.PythonExpression",
    "file-content": "launch.substitutions.FileContent",
    "equals": "launch.substitutions.EqualsSubstitution",
    "not-equals": "launch.substitutions.NotEqualsSubstitution",
    "not": "launch.substitutions.NotSubstitution",
    "and": "launch.substitutions.AndSubstitution",
    "or": "launch.substitutions.OrSubstitution",
    "all": "launch.substitutions.AllSubstitution",
    "any": "launch.substitutions.AnySubstitution",
    "if": "launch.substitutions.IfElseSubstitution",
}
# The substitutions of ROS 1 and their names in ROS 2.
_ROS1 = {"find": "find-pkg-share", "arg": "var", "optenv": "env"}
_ON_STDERR = ("fail", "ignore", "warn", "capture")


def parse_value(text: str, at: Position, findings: Findings) -> list[Value]:
    """Return a value as a list of strings and calls of substitutions; mistakes in it are added to the findings."""
    return _ValueParser(text, at, findings).pieces("", 0)


@dataclass(slots=True)
class _ValueParser:
    """Parses a value from its beginning to its end."""

    text: str
    at: Position
    findings: Findings
    position: int = 0

    def pieces(self, ends: str, depth: int) -> list[Value]:
        """Return strings and substitutions, up to one of the characters that end them."""
        found: list[Value] = []
        plain: list[str] = []
        while self.position < len(self.text) and self.text[self.position] not in ends:
            if self.text.startswith("$(", self.position) and depth < _MAX_DEPTH:
                found += ["".join(plain)] if plain else []
                plain.clear()
                self.position += 2
                found.append(self.substitution(depth + 1))
                continue
            if self.text[self.position] == "\\" and self.position + 1 < len(self.text):
                self.position += 1
            plain.append(self.text[self.position])
            self.position += 1
        return [*found, "".join(plain)] if plain or not found else found

    def substitution(self, depth: int) -> Call:
        """Return the substitution in brackets: a name, and values separated by spaces, with or without quotes."""
        start = self.position
        while self.position < len(self.text) and self.text[self.position] not in " \t\n)":
            self.position += 1
        name = self.text[start : self.position]
        values: list[Value] = []
        while self.position < len(self.text) and self.text[self.position] != ")":
            first = self.text[self.position]
            if first in " \t\n":
                self.position += 1
            elif first in "'\"":
                self.position += 1
                values.append(self.pieces(first, depth))
                self.position += 1
            else:
                values.append(self.pieces(" \t\n)", depth))
        if self.position >= len(self.text):
            self.findings.add_fault(f"the bracket of $({name[:40]} is not closed", self.at)
        self.position += 1
        return self.call(name, values)

    def call(self, name: str, values: list[Value]) -> Call:
        """Return a substitution as the call that it is in Python."""
        if name in _ROS1:
            message = f"$({name} ...) is a substitution of ROS 1; in ROS 2 write $({_ROS1[name]} ...)"
            self.findings.add_fault(message, self.at)
            name = _ROS1[name]
        if name == "command" and len(values) > 1 and values[1] not in [[mode] for mode in _ON_STDERR]:
            message = "$(command ...) needs quotes around its command: $(command 'xacro ...')"
            self.findings.add_fault(message, self.at)
            values = [[part for value in values for part in (*value, " ")]]
        similar = closest(name, _SUBSTITUTIONS) if name not in _SUBSTITUTIONS else None
        if similar:
            self.findings.add_fault(f"there is no substitution $({name} ...); did you mean $({similar} ...)?", self.at)
        return Call(_SUBSTITUTIONS.get(name, f"launch.substitutions.{name}"), values, {}, self.at)
