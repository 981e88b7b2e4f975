"""What the code of nodes does is known where it is certain, and open elsewhere: names, services, interfaces and faults."""

from functools import cache

import pytest

from grader.workspace.graph.code_ends import opened_by
from grader.workspace.rules.names import Mismatch
from tests.labs.variants import FOLDER
from tests.workspace.carts import Edit, agreement_of, cart

DRUM, DOOR, PANEL = "laundry/drum.py", "laundry/door.py", "laundry/panel.py"
LAUNCH, YAML = "laundry.launch.py", "laundry.yaml"
CMAKE, STATE, LOCK, WASH = "CMakeLists.txt", "DrumState.msg", "LockDoor.srv", "Wash.action"
MANIFEST = "laundry_interfaces/package.xml"


@cache
def laundry_files() -> dict[str, str]:
    """Return the texts of the lab's solution by their paths."""
    root = FOLDER / "laundry" / "solution"
    paths = [path for path in sorted(root.rglob("*")) if path.is_file()]
    return {path.relative_to(root).as_posix(): path.read_text(encoding="utf-8") for path in paths}


def edited(*edits: Edit) -> dict[str, str]:
    """Return the texts with edits."""
    texts = dict(laundry_files())
    for end, old, new in edits:
        [path] = [it for it in texts if it.endswith(end)]
        assert old in texts[path], f"{old!r} does not occur in {path}"
        texts[path] = texts[path].replace(old, new)
    return texts


def wrong(*edits: Edit) -> list[Mismatch]:
    """Return what does not agree in the solution with edits."""
    return [*agreement_of(edited(*edits)).mismatches]


def opened(executable: str, *edits: Edit) -> list[tuple[str, str]]:
    """Return the kinds and names of what a program opens as it is started."""
    workspace = cart(edited(*edits)).workspace
    return [
        (found.endpoint.kind, found.name)
        for node in workspace.launches.nodes
        if node.executable == executable and node.when
        for found in opened_by(workspace, node)
    ]


def test_the_solution_has_no_fault() -> None:
    """All families are compared."""
    found = agreement_of(edited())
    assert found.mismatches == ()
    assert {"topics", "services", "interfaces", "code"} <= found.families
    assert found.undecided == {}


NAME = 'f"{self.get_name()}/state"'
ITEMS = "for name in {}:\n            self.create_client(LockDoor, {})\n        if True:\n            pass"
NAMES = [
    ('"state"', "/state"),
    ('"~/state"', "/drum/state"),
    ('"/far/state"', "/far/state"),
    (NAME, "/drum/state"),
    ("self.get_name() + '/state'", "/drum/state"),
    ("'%s/state' % self.get_name()", "/drum/state"),
    ("'%s/%d%%' % (self.get_name(), 5)", "/drum/5%"),
    ("'{}/{{state'.format(self.get_name())", "/drum/{state"),
    ("'{1}{0}'.format('state', 'a')", "/astate"),
    ("f'{self.get_namespace()}state'", "/state"),
    ("f'{self.get_namespace()}/state'", "*"),
    ("str(5) + 'state'", "/5state"),
    ("f'state_{self._find()}'", "/state_*"),
    ("f'{self._find()}_{self.get_name()}'", "/*_drum"),
    ("f'{self.get_name():>9}'", "*"),
    ("'{name}'.format(name='state')", "/state"),
    ("'{name}'.format(name=self._find())", "*"),
    ("self._find()", "*"),
    ("f'x{self.get_parameter(\"period\").value}'", "/x*"),
    ("self.get_parameter('top_speed').get_parameter_value().string_value", "*"),
    ("f'a{self.get_parameter(self._find()).value}'", "/a*"),
]


@pytest.mark.parametrize(("written", "name"), NAMES)
def test_a_name_is_evaluated_for_the_started_node(written: str, name: str) -> None:
    """What stays unknown is a pattern of the known parts, * for a name with no known part."""
    assert ("publisher", name) in opened("drum", (DRUM, NAME, written))


LOOPS = [
    ("for name in ['a', 'b']:", "name", ["/a", "/b"]),
    ("for number, name in enumerate(('a', 'b')):", "f'{name}/{name}'", ["/a/a", "/b/b"]),
    ("for name in {'a': 1}:", "name + '/lock'", ["/a/lock"]),
    ("for name in self._find():", "f'{name}/lock'", ["/*/lock"]),
    ("for name in self.get_parameter('names').value:", "f'{name}/lock'", ["/p/lock", "/q/lock"]),
    ("for name in self.get_parameter('machine').value:", "f'{name}/lock'", ["/*/lock"]),
    ("for name in ['a']:", "other", ["*"]),
]


@pytest.mark.parametrize(("loop", "written", "names"), LOOPS)
def test_a_loop_opens_something_for_each_item(loop: str, written: str, names: list[str]) -> None:
    """Of a list in the code, or in a parameter."""
    old = '        self.door = self.create_client(LockDoor, "door/lock")\n'
    declared = "        self.declare_parameter('names', ['p', 'q'])\n"
    made = f"        {loop}\n            self.create_client(LockDoor, {written})\n"
    found = opened("panel", (PANEL, old, f"{declared}{made}{old}"))
    assert [name for kind, name in found if kind == "client"] == [*names, "/door/lock"]


def test_a_node_that_a_function_makes_has_names() -> None:
    """Its methods are called by way of a variable."""
    made = "rclpy.create_node('door')\n    node.create_service(LockDoor, f'{node.get_name()}/lock', print)"
    names = "    for name in node.declare_parameter('names', ['a']).value:\n        node.create_client(LockDoor, name)"
    edit = (DOOR, "    rclpy.spin(Door())", f"    node = {made}\n{names}\n    rclpy.spin(node)")
    assert opened("door", edit) == [("service", "/door/lock"), ("client", "/a")]


@pytest.mark.slow
def test_a_name_depends_on_the_launch_file() -> None:
    """On the name that it gives the node, the namespace, remappings, and parameters of a file."""
    named = (
        LAUNCH,
        'name="drum",\n                namespace=""',
        'name="d1",\n                namespace="cellar"',
    )
    assert ("publisher", "/cellar/d1/state") in opened("drum", named)
    remapped = (LAUNCH, 'name="door")', 'name="door", remappings=[("~/lock", "lock")])')
    assert ("service", "/lock") in opened("door", remapped)
    assert ("subscription", "/left/state") in opened(
        "panel", (YAML, "machine: drum", "machine: left")
    )
    unknown = (LAUNCH, 'name="door")', 'name="door", parameters=[find()])')
    assert ("service", "/door/lock") in opened("door", unknown)


FOUND = [
    (
        "code",
        (DOOR, '~/lock", self.on_lock', '~/lock", self.on_lok'),
        "Door has no attribute on_lok; did you mean on_lock?",
    ),
    (
        "code",
        (
            DOOR,
            "        self.publish()\n        response",
            "        self.lights.on()\n        response",
        ),
        "Door has no attribute lights",
    ),
    (
        "code",
        (
            DOOR,
            "        self.publish()\n        response",
            "        if hasattr(self, 'lights'): self.lights.on()\n        response",
        ),
        None,
    ),
    (
        "code",
        (
            DOOR,
            "        self.publish()\n        response",
            "        try: self.lights.on()\n        except AttributeError: pass\n        response",
        ),
        None,
    ),
    (
        "code",
        (
            DOOR,
            "    rclpy.spin(Door())",
            "    door = Door()\n    door.lights = door.publish()\n    rclpy.spin(door)",
        ),
        None,
    ),
    (
        "code",
        (DOOR, "class Door(Node):", "class Door(Node):\n    import time\n    lights = time\n"),
        None,
    ),
    ("interfaces", (CMAKE, '"msg/DrumState.msg"', '"msg/DrumStates.msg"'), None),
    (
        "services",
        (PANEL, '"door/lock")', '"door/look")'),
        "nothing serves the service /door/look; did you mean /door/lock",
    ),
    ("services", (DOOR, '"~/lock"', 'f"{self._find()}/lock"'), None),
    ("services", (PANEL, '"door/lock")', 'f"{self._find()}/lock")'), None),
    (
        "interfaces",
        (PANEL, "state.speed", "state.sped"),
        "DrumState has no field 'sped'; did you mean speed?",
    ),
    (
        "interfaces",
        (PANEL, "state.stamp.sec", "state.stamp.secs"),
        "builtin_interfaces/msg/Time has no field 'secs'",
    ),
    ("interfaces", (PANEL, "state.stamp.sec", "state.sec"), "did you mean stamp.sec?"),
    ("interfaces", (PANEL, "state.stamp.sec", "state.get_fields_and_field_types()"), None),
    (
        "interfaces",
        (
            PANEL,
            "def on_state(self, state):",
            "def on_state(self, state):\n        state = self._find(state)\n        state.other",
        ),
        None,
    ),
    (
        "interfaces",
        (
            PANEL,
            "def on_state(self, state):",
            "def on_state(self, state):\n        if hasattr(state, 'other'): state.other",
        ),
        None,
    ),
    (
        "interfaces",
        (
            PANEL,
            "def on_state(self, state):",
            "def on_state(self, state):\n        try: state.other\n        except AttributeError: pass",
        ),
        None,
    ),
    (
        "interfaces",
        (PANEL, "self.is_locked = message.data", "self.is_locked = message.value"),
        "Bool has no field 'value'; it has data",
    ),
    (
        "interfaces",
        (PANEL, "goal.minutes = self", "goal.minute = self"),
        "Wash.Goal has no field 'minute'",
    ),
    (
        "interfaces",
        (PANEL, "request.lock = True", "request.lock = 'yes'"),
        "lock of laundry_interfaces/srv/LockDoor.Request is bool; it is set to 'yes', a text",
    ),
    (
        "interfaces",
        (PANEL, "request.lock = True", "request.lock = 1"),
        "it is set to '1', an integer",
    ),
    ("interfaces", (PANEL, "request.lock = True", "request.lock = 0"), None),
    (
        "interfaces",
        (DRUM, "state.speed = self.speed", "state.speed = 5"),
        "is float64; it is set to '5', an integer",
    ),
    ("interfaces", (DRUM, "state.speed = self.speed", "state.speed = 0"), None),
    (
        "interfaces",
        (DRUM, "state.speed = self.speed", "state.stamp = None"),
        "is builtin_interfaces/msg/Time; it is set to None",
    ),
    (
        "interfaces",
        (DRUM, "state.speed = self.speed", "state.SPEED"),
        "has no constant 'SPEED'; it has none",
    ),
    (
        "interfaces",
        (DRUM, "Wash.Goal.COTTON", "Wash.Goal.COTTONS"),
        "has no constant 'COTTONS'; did you mean COTTON?",
    ),
    (
        "interfaces",
        (DRUM, "import DrumState\n", "import DrumStates as DrumState\n"),
        "there is no type laundry_interfaces/msg/DrumStates; did you mean DrumState?",
    ),
    (
        "interfaces",
        (
            DRUM,
            "from laundry_interfaces.msg import DrumState\n",
            "try:\n    from laundry_interfaces.msg import Drums as DrumState\nexcept ImportError:\n    DrumState = None\n",
        ),
        None,
    ),
    (
        "interfaces",
        (DOOR, "from std_msgs.msg import Bool", "from std_msgs.srv import Bool"),
        "there is no type std_msgs/srv/Bool; there is std_msgs/msg/Bool",
    ),
    (
        "interfaces",
        (MANIFEST, "  <member_of_group>rosidl_interface_packages</member_of_group>\n", ""),
        "package.xml needs <member_of_group>",
    ),
    (
        "interfaces",
        (STATE, "bool is_turning", "geometry_msgs/Pose is_turning"),
        "has a type of geometry_msgs, which DEPENDENCIES of",
    ),
    (
        "interfaces",
        (STATE, "bool is_turning", "mars_msgs/Pose is_turning"),
        "has a type of mars_msgs, which DEPENDENCIES of",
    ),
    (
        "interfaces",
        (STATE, "bool is_turning", "Turning is_turning"),
        "there is no type laundry_interfaces/msg/Turning; there is DrumState",
    ),
    (
        "interfaces",
        (STATE, "bool is_turning", "builtin_interfaces/Tim is_turning"),
        "there is no type builtin_interfaces/msg/Tim; did you mean Time?",
    ),
    (
        "interfaces",
        (LOCK, "bool lock", "boolean lock"),
        "there is no type 'boolean'; did you mean 'bool'?",
    ),
    ("code", (PANEL, "QoSProfile,", ""), "undefined name 'QoSProfile'"),
    ("code", (PANEL, "def start(self):", "def start(self) -> Anything:"), None),
    (
        "code",
        (PANEL, "def start(self):", "def start(self):\n        '{} {}'.format(1)"),
        "'...'.format(...) is missing argument(s) for placeholder(s): 1",
    ),
    (
        "code",
        (PANEL, "1.0, self.start)", "1.0, self.start())"),
        "create_timer() is given what self.start() returns, which is None",
    ),
    ("code", (PANEL, "1.0, self.start)", "1.0, self._find())"), None),
    (
        "code",
        (DOOR, '"~/lock", self.on_lock)', '"~/lock", self.on_lock())'),
        "create_service() calls self.on_lock() without its arguments",
    ),
    (
        "code",
        (DOOR, "            return response", "            return"),
        "on_lock() ends without returning its response here",
    ),
    (
        "code",
        (DOOR, "        response.done = True\n        return response", "        raise ValueError"),
        None,
    ),
    (
        "code",
        (
            DOOR,
            "        response.done = True\n        return response",
            "        while True:\n            self._find()",
        ),
        None,
    ),
    (
        "code",
        (
            DOOR,
            "        return response\n\n",
            "        try:\n            self._find()\n        finally:\n            return response\n\n",
        ),
        None,
    ),
    (
        "code",
        (
            DOOR,
            "        response.done = True\n        return response",
            "        with self._find():\n            response.done = True",
        ),
        "on_lock() does not return its response",
    ),
    (
        "code",
        (
            DOOR,
            "        response.done = True\n        return response",
            "        if self.is_locked:\n            return response\n        else:\n            response.done = True",
        ),
        "on_lock() does not return its response",
    ),
    (
        "code",
        (
            DOOR,
            "        response.done = True\n        return response",
            "        try:\n            return response\n        except ValueError:\n            pass",
        ),
        "on_lock() does not return its response",
    ),
    ("code", (DOOR, "    rclpy.spin(Door())", "    Door()"), "nothing spins the node"),
    ("code", (DOOR, "    rclpy.spin(Door())", "    find(Door())"), "nothing spins the node"),
    (
        "code",
        (DOOR, "    rclpy.spin(Door())", "    Door()\n    while True:\n        pass"),
        "nothing spins the node",
    ),
    ("code", (DOOR, "    rclpy.init()\n", ""), "rclpy.init() is missing, so rclpy makes no node"),
    (
        "code",
        (
            PANEL,
            "self.door.call_async(request).add_done_callback(self.on_answer)",
            "self.door.call(request)",
        ),
        "self.door.call() in the callback start() waits for ever",
    ),
    (
        "code",
        (
            PANEL,
            "self.door.call_async(request).add_done_callback(self.on_answer)",
            "self.door.call(request, timeout_sec=1.0)",
        ),
        None,
    ),
    (
        "code",
        (
            PANEL,
            "self.door.call_async(request).add_done_callback(self.on_answer)",
            "rclpy.spin_until_future_complete(self, self.door.call_async(request))",
        ),
        "spin_until_future_complete() in the callback start() waits for ever",
    ),
    (
        "code",
        (
            PANEL,
            "self.door.call_async(request).add_done_callback(self.on_answer)",
            "rclpy.spin_until_future_complete(self._other, self.door.call_async(request))",
        ),
        None,
    ),
    ("code", (PANEL, "import rclpy\n", "import rclpy\nimport threading\n"), None),
]


@pytest.mark.slow
@pytest.mark.parametrize(("family", "edit", "message"), FOUND)
def test_what_certainly_fails_is_found(family: str, edit: Edit, message: str | None) -> None:
    """What may be right has no mismatch."""
    found = [it for it in wrong(edit) if it.is_certain and it.family != "dependencies"]
    if message is None:
        assert found == []
    else:
        assert message in found[0].message
        assert {it.family for it in found} == {family}


MAYBE = [
    (
        "        response.done = True\n        return response",
        "        if self.is_locked:\n            return response",
        "on_lock() does not return its response on every path",
    ),
    (
        "        response.done = True\n        return response",
        "        for _ in 'ab':\n            return response",
        "on_lock() does not return its response on every path",
    ),
    (
        "        response.done = True\n        return response",
        (
            "        time.sleep(1)\n        time.sleep(1)\n        return response\n\n"
            "    def watch(self):\n        self.timer = self.create_timer(1.0, self.publish)"
        ),
        "while time.sleep() in the callback on_lock() waits, no other callback runs",
    ),
    (
        "    rclpy.spin(Door())",
        "    door = Door()\n    while door:\n        door.publish()",
        "nothing spins the node",
    ),
]


TIMER = '        self.create_service(LockDoor, "~/lock", self.on_lock)\n'
SPUN_ONCE = [
    ("self.create_timer(1.0, self.publish)", "rclpy.spin_once(Door())", True),
    (
        "if self.is_locked:\n            self.create_timer(1.0, self.publish)",
        "rclpy.spin_once(Door())",
        False,
    ),
    ("self.other = None", "rclpy.spin_once(Door())", False),
    (
        "self.create_timer(1.0, self.publish)",
        "for _ in range(9):\n        rclpy.spin_once(Door())",
        None,
    ),
]


@pytest.mark.parametrize(("more", "spin", "is_certain"), SPUN_ONCE)
def test_a_node_with_several_callbacks_is_spun_more_than_once(
    more: str, spin: str, is_certain: bool | None
) -> None:
    """One with a single callback may wait for one message."""
    edits = (
        (DOOR, TIMER, f"{TIMER}        {more}\n"),
        (DOOR, "    rclpy.spin(Door())", f"    {spin}"),
    )
    messages = {it.message: it.is_certain for it in wrong(*edits)}
    message = (
        "spin_once() runs one callback at most, and nothing else spins the node; "
        "write rclpy.spin(node)"
    )
    assert messages.get(message) == is_certain


IDLE_LOOPS = [
    ("while rclpy.ok():\n        time.sleep(1)", True),
    ("while not door.publish():\n        time.sleep(1)", False),
    ("import threading\n    while True:\n        time.sleep(1)", False),
]


@pytest.mark.parametrize(("loop", "is_certain"), IDLE_LOOPS)
def test_a_loop_that_only_waits_does_nothing_for_a_node(loop: str, is_certain: bool) -> None:
    """Its condition, or another thread, may do something."""
    edits = (
        (DOOR, "    rclpy.spin(Door())", f"    door = Door()\n    {loop}"),
        (DOOR, "import rclpy\n", "import time\n\nimport rclpy\n"),
    )
    [mismatch] = [it for it in wrong(*edits) if it.message.startswith("nothing spins")]
    assert mismatch.is_certain == is_certain


def test_a_loop_in_a_callback_that_nothing_calls_is_not_reached() -> None:
    """So that it does nothing, either."""
    edits = (
        (DOOR, "    rclpy.spin(Door())", "    Door()"),
        (
            DOOR,
            "        self.is_locked = request.lock",
            "        while self.x:\n            self.x -= 1",
        ),
    )
    [mismatch] = [it for it in wrong(*edits) if it.message.startswith("nothing spins")]
    assert mismatch.is_certain


@pytest.mark.parametrize(("old", "new", "message"), MAYBE)
def test_what_may_fail_is_a_warning(old: str, new: str, message: str) -> None:
    """It fails no criterion."""
    [found] = wrong((DOOR, old, new), (DOOR, "import rclpy\n", "import time\n\nimport rclpy\n"))
    assert found.message.startswith(message)
    assert not found.is_certain


def test_a_service_has_one_type() -> None:
    """That of the server counts."""
    changes = (
        (PANEL, "import LockDoor", "import LockDoor\nfrom std_srvs.srv import SetBool"),
        (PANEL, "create_client(LockDoor", "create_client(SetBool"),
    )
    [found] = [it for it in wrong(*changes) if it.family == "services"]
    assert found.message.startswith("the service /door/lock is called with std_srvs.srv.SetBool")
    assert found.rule.is_of_type


def test_interfaces_of_several_packages_with_one_name_are_open() -> None:
    """Which of them is built is not known."""
    copies = {
        f"second/{path}": text for path, text in laundry_files().items() if "_interfaces" in path
    }
    found = agreement_of({**edited((PANEL, "state.speed", "state.sped")), **copies})
    assert [it for it in found.mismatches if it.family == "interfaces"] == []


def test_code_may_be_too_long_to_search(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whether it fails is left to a person."""
    monkeypatch.setattr("grader.ros.nodes.python.python_nodes._MAX_CODE", 1_000)
    found = agreement_of(edited((DOOR, "    rclpy.spin(Door())", "    Door()")))
    assert found.undecided["code"] == "the code of 'laundry' is too long to search"


@pytest.mark.slow
def test_conditions_may_be_nested_too_deeply() -> None:
    """The function is not searched further."""
    branches = "".join(
        f"        elif request == {number}:\n            pass\n" for number in range(900)
    )
    edit = (
        DOOR,
        "        self.is_locked = request.lock\n",
        f"        if request:\n            pass\n{branches}",
    )
    found = agreement_of(edited(edit))
    assert found.mismatches == ()


def test_setters_check_types_before_jazzy() -> None:
    """0 is no float there; later releases take it for 0.0 by chance."""
    texts = edited((DRUM, "state.speed = self.speed", "state.speed = 0"))
    found = agreement_of({**texts, "README.md": "For ROS 2 Humble.\n"})
    assert [it.message for it in found.mismatches if it.family == "interfaces"] in (
        [],
        [
            "the field speed of laundry_interfaces/msg/DrumState is float64; it is set to '0', an integer"
        ],
    )
