"""Programs and nodes: what launch files start, entry points, and nodes under a manager.

The nodes are those that a lifecycle manager looks after.
"""

from collections.abc import Collection, Sequence
from contextlib import suppress

from grader.base.errors import InputError
from grader.base.names import last_part
from grader.base.records import Named
from grader.base.source import Location
from grader.ros.installation.installation import Installation
from grader.ros.installation.places import is_launch_file
from grader.ros.known.package_rows import package_row
from grader.ros.launch.launch_model import StartedNode
from grader.ros.launch.node_parameters import collect_parameters
from grader.ros.package.entry_points import (
    entry_fault,
    entry_points,
    module_path,
    modules_beside,
    modules_not_installed,
    read_module,
)
from grader.ros.package.package import CMAKE, SETUP, Package
from grader.ros.package.program_names import meant_program, program_names, program_of_module
from grader.ros.python.parse import bound_in
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Definition,
    Facts,
    Mismatch,
    Mismatches,
    Open,
    Undecided,
    Use,
    warning,
)
from grader.workspace.rules.rule_table import NO_PROGRAM, NO_RUN, Rule, Symptom

_MAX_FIRST_LINE = 100  # bytes
_OF_MISSING = 5_000  # parts: similar names are searched among all programs


_PROGRAM_EXISTS = Rule(
    "program-exists",
    "programs",
    NO_PROGRAM,
    "The package of a started node has its program.",
    why=(
        "ros2 launch prints that the executable is not found on the libexec directory, and "
        "shuts down all nodes of the launch."
    ),
    symptoms=(
        Symptom(
            "executable-not-found",
            pattern=(
                r"executable '(?P<program>[^']{1,200}+)' not found on the libexec directory "
                r"'[^']{1,400}?/lib/(?P<package>[\w-]{1,100}+)\'"
            ),
            source=(
                "ros2/launch_ros f9ab937, launch_ros/launch_ros/substitutions/"
                "executable_in_package.py:85"
            ),
            sentence="The package is installed, and has no program of this name.",
            example=(
                "executable 'mover' not found on the libexec directory "
                "'/home/ann/ws/install/cell/lib/cell'"
            ),
            within=("program", "package"),
        ),
        Symptom(
            "libexec-missing",
            pattern=(
                r"package '(?P<package>[\w-]{1,100}+)' found at '[^']{1,400}+', but libexec "
                r"directory '[^']{1,400}+' does not exist"
            ),
            source=(
                "ros2/launch_ros f9ab937, launch_ros/launch_ros/substitutions/"
                "executable_in_package.py:80"
            ),
            sentence="The package is installed without programs where ros2 looks for them.",
            example=(
                "package 'cell' found at '/home/ann/ws/install/cell', but libexec directory "
                "'/home/ann/ws/install/cell/lib/cell' does not exist"
            ),
            within=("package",),
        ),
    ),
    wrong="Node(package='rover', executable='joystick_node'),",
    right="Node(package='rover', executable='joystick'),",
    beside={
        "joystick.py": "",
    },
)


def program_facts(workspace: Workspace) -> Facts:
    """Yield the programs that launch files start and no package has, and unstarted nodes."""
    nodes = [pair for pair in workspace.launches.placed_nodes if not pair[1].is_component]
    started = {node.program for _, node in nodes}
    for package in workspace.packages:
        yield from _entry_points(workspace, package)
        yield from _unstarted_scripts(package, started)
    for package, node in nodes:
        if not workspace.folder.means_one(package, node.package):
            yield Undecided("programs", f"several packages are named {node.package!r}")
            continue
        owner = package.find(node.package)
        if owner:
            yield from _own_program(workspace, owner, node)
            continue
        row = package_row(node.package)
        programs = row.programs if row.is_compared else None
        if programs is None:
            continue
        yield Compared("programs")
        if node.executable not in programs:
            workspace.charge(_OF_MISSING)
            missing = _missing_program(node.package, node.executable, programs)
            yield _program_missing(node, missing)
    yield from _lifecycle(workspace)


def _own_program(workspace: Workspace, owner: Package, node: StartedNode) -> Facts:
    """Yield that a package of the workspace does not have the program of a node.

    If it has the program, yield that Linux cannot execute it.
    """
    yield Compared("programs")
    if owner.installation and owner.installation.unread:
        yield Undecided("programs", owner.installation.unread)
    if owner.has_program(*node.program) is False:
        workspace.charge(_OF_MISSING + len(owner.tree.files))
        missing = _why_no_program(owner, node.executable)
        start = Location(owner.path(CMAKE if owner.is_cmake else SETUP), 1, 1)
        yield _program_missing(node, missing, start)
    else:
        yield from _not_executed(owner, node.executable, node.location)


_ENTRY_POINT = Rule(
    "entry-point",
    "programs",
    NO_PROGRAM,
    "An entry point names a function that exists.",
    why=(
        "colcon build succeeds, because it does not import the module. The program then ends at"
        " its start with an ImportError or AttributeError."
    ),
    symptoms=(
        Symptom(
            "entry-point",
            pattern=(
                r"functools\.reduce\(getattr, attrs, module\).{0,100}? AttributeError: module "
                r"'(?P<module>[\w.]{1,200}+)' has no attribute '(?P<function>\w{1,200}+)\'"
            ),
            source="python/cpython v3.11.7, Lib/importlib/metadata/__init__.py:204",
            sentence="The module of an entry point has no such function.",
            example=(
                'Traceback (most recent call last): File "/usr/lib/python3.11/importlib/metadata/'
                '__init__.py", line 204, in load return functools.reduce(getattr, attrs, module) '
                "AttributeError: module 'lab_nodes.worker' has no attribute 'mian'"
            ),
            within=("function",),
        ),
    ),
    wrong="entry_points={'console_scripts': ['joystick = rover.joystick:run']},",
    right="entry_points={'console_scripts': ['joystick = rover.joystick:main']},",
    frame="setup.py",
    beside={
        "joystick.py": "",
    },
)


def _entry_points(workspace: Workspace, package: Package) -> Facts:
    """Yield the entry points of a package that name no function."""
    for entry in entry_points(package):
        yield Compared("programs")
        path = module_path(package, entry.module)
        size = package.tree.files[path].size if path is not None else 0
        workspace.charge(len(package.tree.files) + size)  # the functions of the module
        fault = entry_fault(package, entry.name)
        if fault:
            message = f"the entry point of {entry.name!r} names no function: {fault.message}"
            wrong = Mismatch(_ENTRY_POINT, message, fault.location)
            yield wrong.correcting(fault.written, fault.meant)
    yield from _other_modules(package)
    yield from _modules_not_installed(workspace, package)


_MODULE_INSTALLED = Rule(
    "module-installed",
    "code",
    NO_RUN,
    "A build installs the modules of the package that a node imports.",
    why=(
        "The program works in the source folder. After colcon build it ends at its start with a"
        " ModuleNotFoundError."
    ),
    wrong="from rover.tools.gains import GAIN",
    right="GAIN = 2.0",
    frame="plain/pilot.py",
    beside={
        "rover/tools/gains.py": "GAIN = 2.0",
    },
)


def _modules_not_installed(workspace: Workspace, package: Package) -> Mismatches:
    """Yield the modules of the package that an entry point imports and no build installs."""
    for missing in modules_not_installed(package):
        message = (
            f"no build installs {missing.package!r}, so that this import fails: add it to packages "
            "in setup.py"
        )
        place = Location(package.path(SETUP), 1, 1)
        yield Mismatch(_MODULE_INSTALLED, message, missing.location, place, word=missing.module)
    setups = [other.installation for other in workspace.packages]
    for beside in modules_beside(package):
        if any(setup is not None and beside.module in setup.packages for setup in setups):
            continue
        message = (
            f"there is no module {beside.module} after a build, but {beside.package}."
            f"{beside.module}, so that this import fails: import it from {beside.package}"
        )
        yield Mismatch(_MODULE_INSTALLED, message, beside.location, word=beside.module)


_ENTRY_MODULE = Rule(
    "entry-module",
    "programs",
    NO_PROGRAM,
    "An entry point runs the module of its own name, if that has such a function.",
    why=(
        "ros2 run starts the node of another module without an error. The node with the name of"
        " the program never runs."
    ),
    wrong="""
entry_points={'console_scripts': ['pilot=rover.joystick:main', 'joystick=rover.joystick:main']},
""",
    right="""
entry_points={'console_scripts': ['pilot=rover.pilot:main', 'joystick=rover.joystick:main']},
""",
    frame="setup.py",
    beside={
        "joystick.py": "",
        "start/pilot.py": "",
    },
)


def _other_modules(package: Package) -> Mismatches:
    """Yield the entry points that run another module than the one of their own name.

    The one of their name has the function that they name, and no other entry point runs it.
    """
    entries = entry_points(package)
    modules = {entry.module for entry in entries}
    for entry in entries:
        folder, _, last = entry.module.rpartition(".")
        own_module = f"{folder}.{entry.name}" if folder else entry.name
        path = module_path(package, own_module)
        if entry.name == last or own_module in modules or path is None or not entry.function:
            continue
        if entry_fault(package, entry.name):  # which is said
            continue
        code = read_module(package, path)
        if code and entry.function in bound_in(code.tree):
            message = (
                f"the entry point {entry.name!r} runs {entry.module}; no entry point runs "
                f"{own_module}, which has {entry.function}() too"
            )
            place = Location(package.path(path), 1, 1)
            yield warning(_ENTRY_MODULE, message, entry.location, place)


def _unstarted_scripts(package: Package, started: Collection[tuple[str, str]]) -> Mismatches:
    """Yield the scripts that CMake installs as programs, and that Linux cannot execute.

    A launch file that starts one is said to start it.
    """
    setup = package.installation
    home = f"lib/{package.name}/"
    for target in setup.scripts if setup else ():
        name = target.removeprefix(home)
        source = package.installed.get(target, "")
        is_other = "/" in name or name == "__init__.py" or is_launch_file(source)
        if not is_other and (package.name, name) not in started:
            for wrong in _not_executed(package, name, None):
                yield wrong._replace(is_certain=False)


_PROGRAM_RUNS = Rule(
    "program-runs",
    "programs",
    NO_PROGRAM,
    "The first line of a script names an interpreter.",
    why=(
        "Linux does not execute the script: ros2 run and ros2 launch fail with 'Exec format "
        "error', or because the interpreter does not exist."
    ),
    symptoms=(
        Symptom(
            "exec-format",
            pattern=r"\[Errno 8\] Exec format error: '(?:[^']{0,400}/)?(?P<program>[^'/]{1,200}+)'",
            source="python/cpython v3.11.7, Lib/subprocess.py:1950",
            sentence="A script does not begin with the line that names its interpreter.",
            example=(
                "OSError: [Errno 8] Exec format error: '/home/ann/ws/install/cell/lib/cell/"
                "mover.py'"
            ),
            within=("program",),
        ),
    ),
    wrong="""
import rclpy

rclpy.init()
""",
    right="""
#!/usr/bin/env python3
import rclpy

rclpy.init()
""",
    frame="scripts/drive.py",
    beside={
        "package.xml": "",
        "CMakeLists.txt": "install(PROGRAMS scripts/drive.py DESTINATION lib/${PROJECT_NAME})",
        "rover.launch.py": "Node(package='rover', executable='drive.py'),",
    },
)


def _not_executed(package: Package, name: str, at: Location | None) -> Mismatches:
    """Yield that Linux cannot execute a script, which is started at a place.

    Its first line has to name the interpreter, and end without CR.
    """
    source = package.installed.get(f"lib/{package.name}/{name}", "")
    if source.endswith(".py"):
        with suppress(InputError):
            start = package.tree.files[source].read(_MAX_FIRST_LINE, first=True)
            line = start.partition(b"\n")[0]
            if not line.startswith(b"#!"):
                wrong = "is not #!/usr/bin/env python3"
            elif line.endswith(b"\r"):
                wrong = "ends as on Windows, with CR LF"
            else:
                return
            message = f"Linux cannot execute {name}: its first line {wrong}"
            yield Mismatch(_PROGRAM_RUNS, message, Location(package.path(source), 1, 1), at)


def _program_missing(
    node: StartedNode, missing: "_MissingProgram", start: Location | None = None
) -> Mismatch:
    """Return that the program of a node is missing, which another name at `start` may have."""
    name = node.executable
    wrong = Mismatch(_PROGRAM_EXISTS, missing.message, node.location, word=name)
    return wrong._replace(names=(node.package,)).correcting(name, missing.meant, start)


class _MissingProgram(Named):
    """Why a package has no program of a name, and the name of the program that may be meant."""

    message: str
    meant: str | None = None


def _why_no_program(package: Package, name: str) -> _MissingProgram:
    """Return that ros2 run does not find a program, and where it is, or which there are."""
    setup = package.installation
    home = f"lib/{package.name}"
    entries = [entry.name for entry in entry_points(package)]
    if name in entries:
        folder = setup.scripts_folder if setup else ""
        return _MissingProgram(
            f"a build installs {name!r} in {folder}, not in {home}: see install_scripts of "
            "setup.cfg"
        )
    if _is_built_only(setup, name):
        message = f"CMakeLists.txt builds {name!r}, but no install(TARGETS ...) names it"
        return _MissingProgram(message)
    installed = []
    if setup:
        installed = [*setup.programs, *(copy.target for copy in setup.copies)]
    paths = {last_part(path): path for path in reversed(installed)}
    if name in paths and paths[name] == f"{home}/{name}":
        return _MissingProgram(
            f"a build installs {name!r} without the right to execute it: write "
            "install(PROGRAMS ...)"
        )
    if name in paths:
        where = f"as {paths[name]}, but ros2 run looks in {home}"
        return _MissingProgram(f"a build installs {name!r} {where}")
    meant = program_of_module(package, name)
    return _missing_program(package.name, name, program_names(package), meant)


def _is_built_only(setup: Installation | None, name: str) -> bool:
    """Return whether CMake makes a program that no install() names."""
    for target in setup.targets if setup else ():
        is_program = target.kind == "executable" and (target.program or target.name) == name
        if is_program and not target.is_installed:
            return True
    return False


def _missing_program(
    package: str, name: str, programs: Sequence[str], meant: str | None = None
) -> _MissingProgram:
    """Return that a package has only programs of other names, and the one that may be meant."""
    guess = meant or meant_program(name, programs)
    there = f"did you mean {guess!r}?" if guess else f"it has {', '.join(programs) or 'none'}"
    return _MissingProgram(f"the package {package!r} has no program {name!r}; {there}", guess)


def _lifecycle(workspace: Workspace) -> Facts:
    """Yield the nodes that lifecycle managers are told of, and all that are started."""
    managers = [
        pair
        for pair in workspace.launches.placed_nodes
        if pair[1].executable == "lifecycle_manager"
    ]
    if managers:
        yield from _started(workspace)
    for package, manager in managers:
        given = collect_parameters(manager, package.open_installed, "lifecycle_manager")
        workspace.charge(len(given.values))
        names = given.values.get("node_names")
        if given.unknown and not names:
            yield Undecided("programs", given.unknown)
        if names and isinstance(names.value, list):
            for name in names.value:
                yield Use("node", last_part(str(name)), names.location, "node_names")


def _started(workspace: Workspace) -> Facts:
    """Yield the nodes that launch files start, and that there may be more."""
    for launch in workspace.launches.every:
        if launch.more:
            yield Open("node", reason=launch.more)
    for node in workspace.launches.nodes:
        name = workspace.code.find_name(node)
        if name is not None:
            yield Definition("node", name, node.location)
        elif "lifecycle" not in package_row(node.package).without:
            yield Open("node")
