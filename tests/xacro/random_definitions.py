"""Random definitions: properties, arguments and values of YAML, whose names can be used after them."""

from random import Random
from xml.sax.saxutils import quoteattr

from tests.xacro.documents.document import named
from tests.xacro.random_expressions import Expressions, Names

_YAML = "radius: 0.1\nname: left\nsizes: [0.6, 0.4, 0.2]\ninner: {mass: 5, ok: true}\nangle: !degrees 90\n"
_USES = (
    "$(arg {})",
    "a $(arg {}) b",
    "${{'$(arg {})' + '_x'}}",
    "${{xacro.arg('{}')}}",
    "$$(arg {})",
)


class Definitions:
    """Writes definitions; what they need besides their text is collected: files and arguments."""

    def __init__(self, random: Random) -> None:
        self._random = random
        self._defect = 0.03 if random.random() < 0.15 else 0.0
        self._write = Expressions(random, self._defect)
        self._files: dict[str, str | bytes] = {}
        self._arguments: dict[str, str] = {}
        self._count = 0
        self._is_in_macro = False

    def _name(self, beginning: str) -> str:
        self._count += 1
        return f"{beginning}{self._count}"

    def _maybe(self, probability: float) -> bool:
        return self._random.random() < probability

    def _value(self, names: Names, kind: str) -> str:
        """Return the text of an attribute, or of a parameter, whose value is of a kind."""
        match kind:
            case "numbers" if self._maybe(0.3):
                return self._random.choice(
                    ("0.1", "5", " 2 ", "1e-2", "-.5", "01", "+3", "1_0" if self._defect else "4.0")
                )
            case "numbers":
                return f"${{{self._write.number(names)}}}"
            case "texts" if self._maybe(0.4):
                return self._random.choice(
                    (
                        "wheel",
                        "base link",
                        "'quoted'",
                        "0 0 ${1 + 1}",
                        "$${kept}",
                        "a_${2 * 3}",
                        "'5'x",
                        "$5 off",
                    )
                )
            case "texts":
                return f"${{{self._write.text(names)}}}"
            case "lists":
                return f"${{{self._write.values(names)}}}"
        return self._random.choice(("true", "false", "1", "0", f"${{{self._write.flag(names)}}}"))

    def _property(self, names: Names) -> str:
        kind = self._random.choice(("numbers", "numbers", "numbers", "texts", "lists", "flags"))
        known = getattr(names, kind)
        own = [name for name in known if name.isidentifier()] if self._maybe(0.15) else []
        name = self._random.choice(own or [self._name("p")])
        # A new value that is made of the old one is evaluated at once.
        more = (
            'lazy_eval="false"'
            if own
            else self._random.choice(("", "", "", 'lazy_eval="false"', 'scope="global"'))
        )
        if not own and self._is_in_macro and self._maybe(0.3):
            more = 'scope="parent"'  # refused outside of macros
        text = named(name, self._value(names, kind), more)
        if name not in known:
            known.append(name)
        return text.replace(" value=", " default=", 1) if not more and self._maybe(0.1) else text

    def _later(self, names: Names) -> str:
        """Return a property that uses one that is defined after it."""
        first, second = self._name("p"), self._name("p")
        text = named(first, f"${{{second} * 2}}") + named(second, self._value(names, "numbers"))
        names.numbers += [first, second]
        return text

    def _removed(self, names: Names) -> str:
        """Return a property that is removed, and perhaps defined again."""
        name = self._name("p")
        text = (
            named(name, self._value(names, "numbers"))
            + f'<xacro:property name="{name}" remove="true"/>'
        )
        if self._maybe(0.5):
            names.numbers.append(name)
            text += f'<xacro:property name="{name}" default="7"/>'
        return text

    def _argument(self, names: Names) -> str:
        name = self._name("arg")
        if self._maybe(0.3):
            self._arguments[name] = self._random.choice(("3", "0.25", "true", "some text"))
        declared = f"<xacro:arg name='{name}' default={quoteattr(self._value(names, 'numbers'))}/>"
        used = self._random.choice(_USES)
        return f"{declared}<used x={quoteattr(used.format(name))}/>"

    def _yaml(self, names: Names) -> str:
        self._files["config/values.yaml"] = _YAML
        name = self._name("y")
        names.numbers += [
            f"{name}.radius",
            f"{name}['inner']['mass']",
            f"{name}.angle",
            f"{name}.sizes[1]",
        ]
        names.texts.append(f"{name}.name")
        names.lists.append(f"{name}.sizes")
        names.flags.append(f"{name}.inner.ok")
        return named(name, "${xacro.load_yaml('../config/values.yaml')}")
