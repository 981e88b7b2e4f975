"""The grammar of a value in XML and YAML launch files: texts and $(substitutions ...), as ros2/launch's grammar.lark has it."""

from grader.names import closest
from grader.static_python.values import Made, Spot, Value

_MOST_DEPTH = 40
# What a frontend's substitution is called in Python.
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
# Substitutions of ROS 1, and what they are called now.
_ROS1 = {"find": "find-pkg-share", "arg": "var", "optenv": "env"}
_ON_STDERR = ("fail", "ignore", "warn", "capture")

Faults = list[tuple[str, Spot]]


def read_line(text: str, at: Spot, faults: Faults) -> list[Value]:
    """A value with its substitutions, as a list of texts and what Python would call them; what is wrong joins `faults`."""
    return _Line(text, at, faults).pieces("", 0)


class _Line:
    """A value that is read from its beginning to its end."""

    def __init__(self, text: str, at: Spot, faults: Faults) -> None:
        self.text = text
        self.at = at
        self.faults = faults
        self.position = 0

    def pieces(self, ends: str, depth: int) -> list[Value]:
        """Texts and substitutions, up to one of the characters that end them."""
        found: list[Value] = []
        plain: list[str] = []
        while self.position < len(self.text) and self.text[self.position] not in ends:
            if self.text.startswith("$(", self.position) and depth < _MOST_DEPTH:
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

    def substitution(self, depth: int) -> Made:
        """What is in the brackets: a name, and values with a space between them, in quotes or not."""
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
            self.faults.append((f"the bracket of $({name[:40]} is not closed", self.at))
        self.position += 1
        return self.named(name, values)

    def named(self, name: str, values: list[Value]) -> Made:
        """What a substitution is in Python."""
        if name in _ROS1:
            self.faults.append((f"$({name} ...) is of ROS 1; in ROS 2 it is $({_ROS1[name]} ...)", self.at))
            name = _ROS1[name]
        if name == "command" and len(values) > 1 and values[1] not in [[each] for each in _ON_STDERR]:
            message = "$(command ...) takes its command in quotes: $(command 'xacro ...')"
            self.faults.append((message, self.at))
            values = [[part for value in values for part in (*value, " ")]]
        similar = closest(name, _SUBSTITUTIONS) if name not in _SUBSTITUTIONS else None
        if similar:
            self.faults.append((f"there is no substitution $({name} ...); did you mean $({similar} ...)?", self.at))
        return Made(_SUBSTITUTIONS.get(name, f"launch.substitutions.{name}"), values, {}, self.at)
