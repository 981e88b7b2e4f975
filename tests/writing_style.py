"""The text of an element tree in a random style: other digits, quotes, blanks, comments and orders of attributes."""

from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from random import Random
from xml.sax.saxutils import escape

from lxml import etree

from grader.ros.xml.elements import FOREIGN
from grader.ros.xml.parsing import Element
from grader.ros.xml.urdf_format import PARTS

_COMMENTS = (
    "<!---->",
    "<!-- a robot -->",
    '<!-- <link name="ghost"/> -->',
    "<!--\n  0.6 / 4\n  -->",
    "<!-- $ & % -->",
)


@dataclass(frozen=True, slots=True)
class Style:
    """Options for writing an element tree as text; the text is as plain as possible with all of them off."""

    random: Random
    blanks: tuple[str, ...] = ("\n",)
    quotes: str = '"'
    numbers: bool = False
    comments: bool = False
    references: bool = False
    orders: bool = False

    def text(self, element: Element) -> str:
        """Return an element as text."""
        pick = self.random.choice
        tight = self.blanks if self.orders else ("",)
        loose = [space for space in tight if space] or [" "]
        if element.tag in FOREIGN:  # a simulator may read anything in it
            return etree.tostring(element, encoding="unicode", with_tail=False)
        attributes = [
            (name, value) for name, value in element.attrib.items() if "}" not in str(name)
        ]
        if self.orders:
            self.random.shuffle(attributes)
        inside = [self.attribute(str(name), str(value)) for name, value in attributes]
        space = [pick(loose) for _ in inside]
        opening = f"<{element.tag}{''.join(map(''.join, zip(space, inside, strict=True)))}"
        children = [self.text(child) for child in element]
        content = element.text or ""
        if content.strip() and not children:  # of an element that ROS 2 ignores
            return f"{opening}>{escape(content)}</{element.tag}>"
        if not children and not (self.orders and pick((True, False))):
            return f"{opening}{pick(tight)}/>"
        between = [self.blank_space() for _ in range(len(children) + 1)]
        body = "".join(map("".join, zip(between, [*children, ""], strict=True)))
        return f"{opening}{pick(tight)}>{body}</{element.tag}{pick(tight)}>"

    def blank_space(self) -> str:
        """Return the text between two elements."""
        comment = (
            self.random.choice(_COMMENTS) if self.comments and self.random.random() < 0.2 else ""
        )
        return f"{self.random.choice(self.blanks)}{comment}{self.random.choice(self.blanks)}"

    def attribute(self, name: str, value: str) -> str:
        """Return an attribute as text."""
        quote = self.random.choice(self.quotes)
        if self.numbers and len(PARTS.get(name, ())) > 1:
            pieces = [self.number(piece) for piece in value.split(" ")]
            value = "".join(f"{' ' * self.random.randint(1, 3)}{piece}" for piece in pieces)
            value += " " * self.random.randint(0, 2)
        elif self.numbers and PARTS.get(name):
            value = " " * self.random.randint(0, 2) + self.number(value)
        value = value.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;")
        if self.references and value and value[0].isalnum():
            value = f"&#{ord(value[0])};{value[1:]}"
        equals = (
            f"{self.random.choice(self.blanks)}={self.random.choice(self.blanks)}"
            if self.orders
            else "="
        )
        return f"{name}{equals}{quote}{value}{quote}"

    def number(self, text: str) -> str:
        """Return the same number in other digits."""
        try:
            value = Decimal(text)
        except InvalidOperation:
            return text
        sign = "-" if value.is_signed() else self.random.choice(("", "+"))
        value = value.copy_abs()
        forms = [f"{value:e}", f"{value:E}", f"{value:e}".replace("e-", "e-0")]
        if value.adjusted() > -20:
            plain = f"{value:f}"
            forms += [
                plain,
                f"0{plain}",
                f"{plain}0" if "." in plain else f"{plain}.",
                f"{plain}00" if "." in plain else f"{plain}.00",
            ]
            forms += [plain[1:]] if plain.startswith("0.") else []
        return sign + self.random.choice(forms)
