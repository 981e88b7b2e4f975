"""The files that the nodes of a launch description are given: the URDF of robot_state_publisher, the configuration of RViz."""

import shlex
from collections.abc import Callable
from dataclasses import dataclass, field

from grader.package.launch.model import Purpose, Reference
from grader.package.launch.places import SHARE
from grader.package.launch.substitutions import CMDLINE, UNTOLD, Contents, Context, resolve
from grader.source import Location
from grader.static_python.values import Made, Spot, Unknown, Value

DESCRIBED = "robot_state_publisher"
SHOWS = "rviz2"
# What is given to robot_description where the last call is missing.
_UNFINISHED = {
    "xacro.process_file": "robot_description is given a document, not its text: .toxml() is missing behind xacro.process_file(...)",
    "builtins.open": "robot_description is given an open file, not what is in it: .read() is missing behind open(...)",
}


@dataclass(slots=True)
class NamedFiles:
    """The files that were named so far. `sets_parameters` tells that nodes get parameters from elsewhere, too."""

    place: Callable[[Spot], Location]
    references: list[Reference] = field(default_factory=list)
    sets_parameters: bool = False

    def described(self, made: Made, context: Context) -> None:
        """Where robot_state_publisher gets the robot from."""
        given = made.kwargs.get("parameters")
        parameters = given if isinstance(given, list | tuple) else [given] if given is not None else []
        found = [
            each["robot_description"] for each in parameters if isinstance(each, dict) and "robot_description" in each
        ]
        if found:
            self._description_from(found[-1], made, context)
            return
        unclear = next((each for each in parameters if not isinstance(each, dict) or "**" in each), None)
        words = self.words(made.kwargs.get("arguments"), context)
        files = [each for each in words[: _index(words, "--ros-args")] if not each.startswith("-")]
        if isinstance(unclear, Unknown):
            self.refer("urdf", unclear, made)
        elif files and files[0] != UNTOLD:
            self.refer("urdf", files[0], made)
        elif (
            words
            or unclear is not None
            or "**" in made.kwargs
            or "ros_arguments" in made.kwargs
            or self.sets_parameters
        ):
            self.refer("urdf", Unknown("what it is given is told only by a run", made.at), made)
        else:
            message = "robot_state_publisher is started without robot_description: it has no robot to publish"
            self.references.append(Reference("urdf", None, self.place(made.at), message))

    def _description_from(self, value: Value, made: Made, context: Context) -> None:
        unfinished = _UNFINISHED.get(value.name) if isinstance(value, Made) else None
        if unfinished is not None:
            self.references.append(Reference("urdf", None, self.place(_spot(value, made)), unfinished))
            return
        known = resolve(value, context)
        match known:
            case Contents(path=path, by=by):
                if by != "xacro" and path.endswith(".xacro"):
                    name = path.rpartition("/")[2]
                    message = f"{name} is read as it is; if anything of xacro is in it, use Command(['xacro ', ...])"
                    self.references.append(Reference("urdf", path, self.place(made.at), message, sure=False, by=by))
                    return
                self.refer("urdf", path, made, value, by)
            case str() if "<robot" in known:
                return
            case str():
                message = "robot_description is given the path of the URDF, not what is in it: read the file first"
                self.references.append(Reference("urdf", None, self.place(_spot(value, made)), message))
            case Unknown():
                self.refer("urdf", known, made, value)

    def shown(self, arguments: Value, made: Made, context: Context) -> None:
        """Which configuration RViz opens."""
        if isinstance(arguments, Unknown):
            self.refer("rviz", arguments, made)
            return
        words = self.words(arguments, context)
        path = _display_config(words)
        if path is None and UNTOLD not in words:
            message = (
                "rviz2 is started without -d and a file, so it opens its own default instead of the lab's configuration"
            )
            self.references.append(Reference("rviz", None, self.place(made.at), message))
        elif path is None or UNTOLD in path:
            self.refer("rviz", self._why(arguments, made, context), made)
        elif path != path.lstrip():
            message = "'-d' and the path have to be two entries of arguments: ['-d', path]"
            self.references.append(Reference("rviz", None, self.place(made.at), message))
        elif path:
            self.refer("rviz", path, made)
        else:
            message = "rviz2 is given -d without the path of a file"
            self.references.append(Reference("rviz", None, self.place(made.at), message))

    def refer(self, purpose: Purpose, path: "str | Unknown", made: Made, value: Value = None, by: str = "") -> None:
        """Note that an action names a file, or why it cannot be told which."""
        where = self.place(_spot(value, made))
        if isinstance(path, Unknown):
            self.references.append(Reference(purpose, None, where, path.reason, sure=False))
        else:
            self.references.append(Reference(purpose, path, where, by=by))

    def urdf_launch(self, name: str, made: Made, context: Context) -> tuple[str, ...]:
        """What urdf_launch's own files do with their arguments; the nodes that they start."""
        package, path = (
            resolve(context.arguments.get(each), context) for each in ("urdf_package", "urdf_package_path")
        )
        if isinstance(package, str) and isinstance(path, str):
            self.refer("urdf", f"{SHARE}/{package}/{path}", made, by="xacro")
        else:
            message = "urdf_launch needs the arguments urdf_package and urdf_package_path"
            unknown = next(each for each in (package, path) if not isinstance(each, str))
            told = context.arguments.get("urdf_package") is None or context.arguments.get("urdf_package_path") is None
            reason = message if told or not isinstance(unknown, Unknown) else unknown.reason
            self.references.append(Reference("urdf", None, self.place(made.at), reason, sure=told))
        if name == "display":
            config = context.arguments.get("rviz_config")
            shown = resolve(config, context) if config is not None else None
            if isinstance(shown, str | Unknown):
                self.refer("rviz", shown, made)
            else:
                message = (
                    "urdf_launch is included without rviz_config, so it opens its own configuration, not the lab's"
                )
                self.references.append(Reference("rviz", None, self.place(made.at), message))
        return (DESCRIBED, "joint_state_publisher_gui", SHOWS) if name == "display" else (DESCRIBED,)

    def words(self, value: Value, context: Context) -> list[str]:
        """The words of a command: an entry of a list is one of them, a line of XML or YAML is split."""
        pieces = value if isinstance(value, list | tuple) else [value] if value is not None else []
        words: list[str] = []
        for piece in pieces:
            if isinstance(piece, Made) and piece.name == CMDLINE:
                words += _line_words(piece, context)
            else:
                words.append(_told(piece, context))
        return words

    def _why(self, arguments: Value, made: Made, context: Context) -> Unknown:
        pieces = arguments if isinstance(arguments, list | tuple) else [arguments]
        unknown = (resolve(piece, context) for piece in pieces)
        found = next((each for each in unknown if isinstance(each, Unknown)), None)
        return found or Unknown("which file it opens is told only by a run", made.at)


def _spot(value: Value, made: Made) -> Spot:
    if isinstance(value, list | tuple):
        value = next((each for each in value if isinstance(each, Made)), None)
    while isinstance(value, Made) and isinstance(value.owner, Made):  # of open(path).read() the path is what counts
        value = value.owner
    return value.at if isinstance(value, Made) else made.at


def _index(words: list[str], word: str) -> int:
    return words.index(word) if word in words else len(words)


def _told(value: Value, context: Context) -> str:
    text = resolve(value, context)
    return text if isinstance(text, str) else UNTOLD


def _line_words(line: Made, context: Context) -> list[str]:
    """The words of a line as launch splits it: its plain texts are split, what a substitution gives is not."""
    words = [""]
    for piece in line.args:
        if not isinstance(piece, str):
            words[-1] += _told(piece, context)
            continue
        try:
            found = shlex.split(piece)
        except ValueError:
            context.wrong.append(
                ("quotes cannot go around a substitution in a line of arguments: leave them out", line.at)
            )
            found = piece.replace("'", " ").replace('"', " ").split()
        if piece[:1].isspace() or not found:
            words.append("")
        words[-1] += "".join(found[:1])
        words += [*found[1:], *([""] if piece[-1:].isspace() else [])]
    return [word for word in words if word]


def _display_config(words: list[str]) -> str | None:
    """The file that rviz2 is told to open; None where it is told nothing."""
    for index, word in enumerate(words):
        if word in ("-d", "--display-config"):
            return "".join(words[index + 1 : index + 2])
        if word.startswith("--display-config="):
            return word.partition("=")[2]
        if word.startswith("-d"):
            return word[2:].removeprefix("=")
    return None
