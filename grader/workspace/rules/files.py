"""Files: the paths that launch files, xacro and YAML name, and whether they are installed."""

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from posixpath import basename, dirname, join, normpath, split

from grader.base.names import closest, first_part, near
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.source import Location, Source
from grader.ros.installation.installation import Installation
from grader.ros.installation.places import PREFIX, SHARE, share_parts
from grader.ros.known.package_rows import names_of_read_files, package_row, written_files
from grader.ros.launch.launch_model import Launch, StartedNode
from grader.ros.package.file_places import DROPS_FOLDERS
from grader.ros.package.found_problems import why_no_match
from grader.ros.package.installed_files import (
    are_installs_known,
    is_surely_absent,
    look_up,
    similar_file,
)
from grader.ros.package.package import Package
from grader.ros.xml.elements import first_text
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Correction,
    Facts,
    Mismatch,
    Mismatches,
    Undecided,
    charge_guess,
    corrections,
    cost_of_guess,
    warning,
)
from grader.workspace.rules.rule_table import NO_FILE, SIMILAR, Rule, Symptom

# A path ends at a quote, a tag or a space, in YAML's flow style and in a substitution also at a
# comma or a bracket.
_FIND = on_use(
    r"\$\(find(?:-pkg-share)? ([\w-]+)\)/?((?:[^\"'<>\s$,()[\]{}]|,(?=\w))*)(?=[\"'<\s,)\]}])"
)
_PACKAGE = on_use(r"package://([\w-]+)/([\w./-]+)(?=[\"'<\s,\]}])")
_MAX_TAG = 80  # characters of a tag and the spaces behind it
_LAUNCH_FOLDER = "launch/"
_PROPERTY = on_use(r"<xacro:property\b[^<>]*?\bname\s*=\s*[\"'](\w+)[\"']")
_URI = on_use(r"package://([\w-]+)/([\w./-]+)")  # of a whole text
_PATH = on_use(rf"{re.escape(SHARE)}/[^\s'\",\x00]+")


def file_facts(workspace: Workspace) -> Facts:
    """Yield the paths at which a build of the workspace installs no file."""
    yield from _find_faults(workspace, named_paths(workspace))
    yield from _map_images(workspace)
    yield from _models(workspace)
    # Last: reading C++ takes work that the others need where little is left.
    for package in workspace.packages:
        yield from _find_faults(workspace, _paths_in_cpp(workspace, package))


def _find_faults(workspace: Workspace, every: Iterable["PathInFile"]) -> Facts:
    """Yield the paths that are compared, and then what is wrong with them."""
    first_named: dict[tuple[str, Location], PathInFile] = {}
    for named in every:
        yield Compared("files", normpath(named.path).removeprefix(f"{PREFIX}/"))
        first = first_named.setdefault((named.path, named.location), named)
        if named.is_needed:
            first_named[named.path, named.location] = first._replace(is_needed=True)
    for named in first_named.values():
        for fact in _find_fault(workspace, named):
            if isinstance(fact, Mismatch) and not named.is_read:
                yield fact._replace(is_certain=False)
            else:
                yield fact


class PathInFile(Named):
    """A path below the prefix, with the package whose file names it.

    It says whether the path is certainly looked for. The path of a file of the package behind a
    slash, which is not below the prefix, is one by mistake.

    `is_needed` says whether a program certainly reads the file and never writes it, and `is_output`
    whether an own node, which is given the path, may write it.
    """

    package: Package
    path: str
    location: Location
    is_read: bool
    is_output: bool = False
    is_needed: bool = False


def named_paths(workspace: Workspace) -> Iterator[PathInFile]:
    """Yield the paths that are named."""
    for package, own_path, launch in workspace.launches.files:
        yield from _paths_in_launch_file(workspace, package, own_path, launch)
    for package in workspace.packages:
        left_out = _robots_left_out(workspace, package)
        for source in workspace.texts.read_sources(package, (".xacro", ".urdf", ".yaml")):
            is_read = (
                source.path.endswith(".yaml")
                or not workspace.robots.known
                or source.path in workspace.robots.files
            ) and source.path not in left_out
            yield from _paths_in_source(workspace, package, source, is_read=is_read)


def _paths_in_source(
    workspace: Workspace, package: Package, source: Source, *, is_read: bool
) -> Iterator[PathInFile]:
    """Yield the paths that a file of a robot or of parameters names."""
    for match in (*_FIND.finditer(source.text), *_PACKAGE.finditer(source.text)):
        start = match.start()
        before = source.text[max(0, start - _MAX_TAG) : start].rstrip()
        is_used = is_read and not _is_unused_property(workspace, source, start)
        yield PathInFile(
            package=package,
            path=f"{SHARE}/{match[1]}/{match[2]}",
            location=source.at(start),
            is_read=is_used,
            is_needed=before.endswith("<parameters>"),  # which gz_ros2_control reads
        )


def _robots_left_out(workspace: Workspace, package: Package) -> frozenset[str]:
    """Return the robots that a build of a package does not install, while it has others.

    It installs others, or has several of one name, of which one is copied to where it is needed.
    What launch files read is not among them.
    """
    installed = set(package.installed.values())
    robots = [path for path in package.tree.files if path.endswith((".urdf", ".xacro"))]
    if not are_installs_known(package):
        return frozenset()
    counts = Counter(map(basename, robots))
    are_others_installed = not installed.isdisjoint(robots)
    launched = set()
    for launch in workspace.launches.every:
        launched |= {basename(named.path or "") for named in launch.named("urdf")}
    left_out = set()
    for path in robots:
        name = basename(path)
        has_others = are_others_installed or counts[name] > 1
        if has_others and path not in installed and name not in launched:
            left_out.add(package.path(path))
    return frozenset(left_out)


def _paths_in_launch_file(
    workspace: Workspace, package: Package, own_path: str, launch: Launch
) -> Iterator[PathInFile]:
    """Yield the paths that a launch file of a package names."""
    beside = None
    # From the folder of the sources, a launch file finds what is beside it.
    if own_path not in package.installed.values():
        beside = f"{PREFIX}/{package.share}{dirname(own_path)}/"
    for text in _list_texts(workspace, launch):
        written = text.text or ""
        paths = _PATH.findall(written)
        uri = _URI.fullmatch(written)
        if uri:
            paths.append(f"{SHARE}/{uri[1]}/{uri[2]}")
        if text.is_whole and written.startswith("/") and written[1:] in package.tree.files:
            paths.append(written)
        for path in paths:
            is_beside = beside is not None and path.startswith(beside)
            is_read = text.is_read and not is_beside
            yield PathInFile(package, path, text.location, is_read, text.is_output, text.is_needed)


def _paths_in_cpp(workspace: Workspace, package: Package) -> Iterator[PathInFile]:
    for text, at in workspace.code.by_package[package.name].texts:
        for match in _PACKAGE.finditer(f"{text} "):
            yield PathInFile(package, f"{SHARE}/{match[1]}/{match[2]}", at, is_read=True)


def _is_unused_property(workspace: Workspace, source: Source, at: int) -> bool:
    """Return whether a place is in the value of a property of xacro that no other place names."""
    tag = source.text[source.text.rfind("<", 0, at) : at]
    name = _PROPERTY.match(tag)
    if not name:
        return False
    return name[1] not in workspace.robots.words_in_expressions


class _Text(Named):
    """A text of a launch file that may name files, and whether it is certainly used."""

    text: str | None
    location: Location
    is_read: bool = True
    is_output: bool = False  # whether an own node gets it, which may write the file
    is_needed: bool = False  # whether a program reads the file, and never writes it
    is_whole: bool = False  # whether it is a path as a program gets it


def _list_texts(workspace: Workspace, launch: Launch) -> Iterator[_Text]:
    """Yield the texts of a launch file that may name files."""
    for passed in launch.passed:
        is_own = any(
            passed.path.startswith(own_package.share) for own_package in workspace.packages
        )
        for name, value in passed.values:
            is_needed = bool(passed.when) and not is_own and name in names_of_read_files()
            yield _Text(value, passed.location, is_needed=is_needed)
    for node in launch.nodes:
        yield from _texts_given(node, is_own=workspace.find_package(node) is not None)
    for reference in launch.references:
        yield _Text(reference.path, reference.location, is_needed=True, is_whole=True)


def _texts_given(node: StartedNode, *, is_own: bool) -> Iterator[_Text]:
    """Yield the texts that a node is given.

    The launch file that includes it may never start it, whatever the arguments.
    """
    is_read = node.when is not False or not node.included_by
    for word in node.arguments or ():
        yield _Text(word, node.location, is_read, is_own)
    for given in node.parameters or ():
        yield _Text(given.path, given.location, is_read, is_needed=is_read, is_whole=True)
        for name, parameter in given.values.items():
            if isinstance(parameter.value, str):
                is_needed = is_read and not is_own and name in names_of_read_files()
                yield _Text(parameter.value, parameter.location, is_read, is_own, is_needed)


def _find_fault(workspace: Workspace, named: PathInFile) -> Facts:
    """Yield that no file is installed at a path, if this is certain."""
    package = named.package
    at = named.location
    if not named.path.startswith(SHARE):
        message = f"the launch file looks for {named.path}: {DROPS_FOLDERS}"
        yield Mismatch(FILE_INSTALLED, message, at)
        return
    name, rest = share_parts(named.path)
    owner = package.find(name)
    if not owner:
        yield from _no_package(workspace, named)
        return
    target = f"share/{name}/{rest}"
    if not rest or target in owner.installed or rest in written_files():
        return
    workspace.charge(len(owner.installed) // 8)
    if any(path.startswith(f"{target}/") for path in owner.installed):
        return
    if not workspace.folder.means_one(package, name):
        yield Undecided("files", f"several packages are named {name!r}")
        return
    if not are_installs_known(owner):
        yield Undecided("files", f"whether a build installs {target} is not evaluated")
        return
    inside = target.removeprefix(owner.share)
    workspace.charge(2 * cost_of_guess(len(owner.tree.files)) + len(owner.tree.files))
    if inside in owner.tree.folders:
        yield from _no_folder(owner, inside, f"a build installs no {target}", at)
    else:
        is_absent = is_surely_absent(owner, target)
        if named.is_needed and not is_absent:  # the second question costs more
            is_absent = workspace.texts.is_nowhere(owner, target)
        yield _not_there(owner, target, at, is_output=named.is_output, is_absent=is_absent)


_FILE_PACKAGE = Rule(
    "file-package",
    "files",
    NO_FILE,
    "The package of a path exists.",
    why=(
        "get_package_share_directory() raises PackageNotFoundError for an unknown package. A "
        "package:// path in it leads to no file, so a mesh or calibration is missing."
    ),
    wrong="""
Node(package='usb_cam', executable='usb_cam_node_exe',
     parameters=[{'camera_info_url': 'package://rovr/config/a.yaml'}]),
""",
    right="""
Node(package='usb_cam', executable='usb_cam_node_exe',
     parameters=[{'camera_info_url': 'package://rover/config/a.yaml'}]),
""",
    beside={
        "a.yaml": "camera_name: front",
    },
)


def _no_package(workspace: Workspace, named: PathInFile) -> Mismatches:
    """Yield that the package of a path is a misspelt one of the workspace.

    Others may be installed; of a well-known one it is compared which launch files it has.
    """
    package = named.package
    at = named.location
    name, rest = share_parts(named.path)
    charge_guess(workspace, workspace.packages)
    meant = near(name, workspace.own_packages)
    if meant is not None and not package.depends_on(name):
        yield Mismatch(_FILE_PACKAGE, f"there is no package {name!r}", at).meaning(name, meant)
    elif rest.startswith(_LAUNCH_FOLDER):
        yield from _misspelt_launch_file(name, rest.removeprefix(_LAUNCH_FOLDER), at)


_LAUNCH_FILE_NAME = Rule(
    "launch-file-name",
    "files",
    SIMILAR,
    "An included launch file of a well-known package exists.",
    why=(
        "ros2 launch looks for the file in the share folder of the package. It stops with an "
        "error when the file is not there."
    ),
    wrong="IncludeLaunchDescription(os.path.join(gazebo, 'launch', 'gz_sever.launch.py')),",
    right="IncludeLaunchDescription(os.path.join(gazebo, 'launch', 'gz_server.launch.py')),",
)


def _misspelt_launch_file(package: str, file: str, at: Location) -> Mismatches:
    """Yield that a well-known package has a launch file of nearly this name, and none of this."""
    ending = file.partition(".")[2]
    stems = []
    for known_file in package_row(package).launch:
        if known_file == file:
            return
        if known_file.endswith(f".{ending}"):
            stems.append(known_file.removesuffix(f".{ending}"))
    stem = near(file.removesuffix(f".{ending}"), stems)
    if stem is not None:
        message = f"{package} is not known to have a launch file {file!r}"
        yield warning(_LAUNCH_FILE_NAME, message, at).meaning(file, f"{stem}.{ending}")


FILE_INSTALLED = Rule(
    "file-installed",
    "files",
    NO_FILE,
    "A build installs each file at the path that another file names.",
    why=(
        "Programs look in the share folder of the install space: an include stops ros2 launch "
        "with an error, a missing mesh is not shown, and RViz opens its default view."
    ),
    wrong="""
Node(
    package='rviz2', executable='rviz2',
    arguments=['-d', os.path.join(share, 'rviz', 'rover_view.rviz')],
),
""",
    right="""
Node(
    package='rviz2', executable='rviz2',
    arguments=['-d', os.path.join(share, 'rviz', 'rover.rviz')],
),
""",
)


def _not_there(
    owner: Package, target: str, at: Location, *, is_output: bool, is_absent: bool
) -> Mismatch:
    """Return where else a build installs a file, or what the package has instead of it."""
    setup = owner.installation
    name = basename(target)
    assert setup
    start = Location(setup.source.path, 1, 1)
    source = look_up(owner, target)
    missing = f"a build installs no {target}"
    if source.state == "elsewhere":
        message = f"{missing}: it installs the file as {source.path}"
        either = _folder_corrections(target, source.path, at, start)
        cause = f"{dirname(target)} is {dirname(source.path)}"
        return Mismatch(
            FILE_INSTALLED, message, at, corrections=either, cause=cause, names=(target,)
        )
    if source.state == "not installed":
        message = f"{missing}: no {setup.entry} names {source.path}"
        called_at = setup.location(setup.called_at)
        empty = setup.empty_for([source.path], None)
        if empty is not None:
            why = f"the pattern {empty.pattern!r} in {setup.file} matches no file"
            message = f"{missing}: {why}{why_no_match(owner, empty.pattern)}"
            called_at = setup.location(empty.at)
        either = _install_corrections(setup, source.path, start)
        cause = f"{setup.entry} lacks {dirname(source.path)}"
        return Mismatch(
            FILE_INSTALLED,
            message,
            at,
            called_at,
            corrections=either,
            cause=cause,
            names=(target,),
        )
    meant = similar_file(owner, name)
    message = f"{missing}: the package has no file {name!r}"
    is_certain = is_absent and not is_output
    cause = f"no file in {dirname(target)}" if meant is None else ""
    wrong = Mismatch(
        FILE_INSTALLED, message, at, is_certain=is_certain, cause=cause, names=(target,)
    )
    return wrong.meaning(name, meant)


def _no_folder(owner: Package, inside: str, missing: str, at: Location) -> Mismatches:
    """Yield where else a build installs what is in a folder, if anywhere."""
    setup = owner.installation
    assert setup
    # CMake also makes folders that stay empty.
    may_be_made = setup.is_cmake and basename(inside) in setup.source.text
    for target, source in owner.installed.items():
        if source.startswith(f"{inside}/"):
            message = f"{missing}: it installs {source} as {target}"
            yield Mismatch(FILE_INSTALLED, message, at, is_certain=not may_be_made)
            return
    if not may_be_made:
        yield Mismatch(FILE_INSTALLED, f"{missing}: it installs no file of the folder {inside}", at)


def _folder_corrections(
    target: str, elsewhere: str, at: Location, start: Location
) -> tuple[Correction, ...]:
    """Return the correction of the one folder in which a path differs from an installed one.

    The other path is the one at which the file is installed.
    """
    if target.count("/") != elsewhere.count("/"):
        return ()
    pairs = zip(target.split("/"), elsewhere.split("/"), strict=True)
    differing = [(own_part, other) for own_part, other in pairs if own_part != other]
    if len(differing) != 1:
        return ()
    [(own_part, other)] = differing
    return corrections(own_part, at, other, start)


def _install_corrections(setup: Installation, file: str, start: Location) -> tuple[Correction, ...]:
    """Return the correction of a path in setup.py or CMakeLists.txt that does not exist.

    The corrected path has the file.
    """
    wrong = [stop.path for stop in setup.stops]
    wrong += [dirname(empty.pattern) for empty in setup.empty]
    for path in wrong:
        meant = closest(path, [file, dirname(file)])
        if meant is not None:
            return corrections(path.rstrip("/"), start, meant)
    return ()


_MAP_IMAGE = Rule(
    "map-image",
    "files",
    NO_FILE,
    "The image of a map exists.",
    why=(
        "map_server fails to load the map when it is configured. The lifecycle manager then "
        "aborts the start of Nav2, and RViz shows no map."
    ),
    symptoms=(
        Symptom(
            "map-image",
            pattern=r"Failed to load image file (?:\S{0,400}/)?(?P<file>[^\s/]{1,200}+) for reason",
            source="ros-navigation/navigation2 a3a97043e, nav2_map_server/src/map_io.cpp:378",
            sentence="The image of the map is not where its YAML file says.",
            example=(
                "Failed to load image file /home/ann/ws/install/cell/share/cell/maps/hall.pgm "
                "for reason: Unable to open file"
            ),
            within=("file",),
        ),
    ),
    wrong="""
image: rom.pgm
resolution: 0.05
""",
    right="""
image: room.pgm
resolution: 0.05
""",
    frame="room.yaml",
    beside={
        "room.pgm": "P2 1 1 255 0",
    },
)


def _map_images(workspace: Workspace) -> Facts:
    """Yield the images of maps that are not there."""
    files = workspace.tree.files
    for tree in workspace.installed.trees:
        path = tree.source.path
        image = tree.get("image")
        if image is None or not image.text or tree.get("resolution") is None:
            continue
        wanted = normpath(join(dirname(path), image.text))
        if image.text.startswith("/") or wanted in files:
            continue
        workspace.charge(len(files) + cost_of_guess(len(files)))
        folder, name = split(wanted)
        beside = [file for file in files if dirname(file) == folder and file != path]
        meant = closest(name, map(basename, beside))
        message = f"the image of the map, {image.text!r}, does not exist"
        yield Mismatch(_MAP_IMAGE, message, image.location).meaning(name, meant)


_WORLD_MODEL = Rule(
    "world-model",
    "files",
    NO_FILE,
    "The models that a world includes exist.",
    why=(
        "Gazebo prints that it is unable to find the URI of the include, and the model is "
        "missing in the simulation."
    ),
    symptoms=(
        Symptom(
            "model-not-found",
            pattern=(
                r"Unable to find (?:uri|file with URI) ?\[(?:model|package)://"
                r"(?P<model>[\w.-]{1,200}+)"
            ),
            source="gazebosim/sdformat 2ace536, src/parser.cc:1553",
            sentence=(
                "Gazebo finds no such model: look at its name, at what a build installs, and at "
                "GZ_SIM_RESOURCE_PATH."
            ),
            example="Unable to find uri[model://crates]",
            within=("model",),
        ),
    ),
    wrong="<include><uri>model://crates</uri></include>",
    right="<include><uri>model://crate</uri></include>",
    frame="world.sdf",
    beside={
        "crate/model.sdf": '<sdf version="1.9"><model name="crate"/></sdf>',
    },
)


def _models(workspace: Workspace) -> Facts:
    """Yield models that worlds include, and whose names are similar to those of the workspace."""
    models = set()
    for package in workspace.packages:
        for path in package.tree.files:
            if path.endswith(("/model.sdf", "/model.config")):
                models.add(basename(dirname(path)))
    for file in workspace.texts.sdf_files:
        for element in file.root.iter("uri"):
            text = first_text(element)
            name = first_part(text.removeprefix("model://"))
            if not text.startswith("model://") or name in models:
                continue
            charge_guess(workspace, models)
            meant = near(name, models)
            if meant is not None:
                at = file.location(element)
                yield Mismatch(_WORLD_MODEL, f"there is no model {name!r}", at).meaning(name, meant)
