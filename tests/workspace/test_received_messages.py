"""Messages that arrive and cannot be used: a mistake each, and what is right or not known."""

import pytest

from tests.workspace.rovers import HORN, LAUNCH, MORE, PILOT, Edit, problems_of

pytestmark = pytest.mark.slow

_NODES = "Node(package='rover', executable='pilot'), Node(package='rover', executable='horn'),"
_FUSE = """\
        self.first = Subscriber(self, JointState, 'joints')
        pose = message_filters.Subscriber(self, TYPE, 'pose', qos_profile=5)
        filters = [self.first, pose]
        self.pairs = SYNCHRONISER
        self.pairs.registerCallback(print)
"""
_SEND = "        self.publisher.publish(self.bridge.cv2_to_imgmsg(None, '16UC1'))\n"
_HEARD = "        self.bridge.imgmsg_to_cv2(message, desired_encoding='bgr8')\n"


def _fused(synchroniser: str, kind: str = "Twist") -> list[Edit]:
    subscription = "        self.create_subscription(Twist, 'drive', self.heard, 10)\n"
    fuse = _FUSE.replace("SYNCHRONISER", synchroniser).replace("TYPE", kind)
    imports = (
        "import Node\nimport message_filters\nfrom sensor_msgs.msg import JointState\n"
        "from message_filters import ApproximateTimeSynchronizer, Subscriber\n"
    )
    stamped = "import Twist, TwistStamped"
    return [
        (HORN, subscription, fuse),
        (HORN, "import Node\n", imports),
        (HORN, "import Twist", stamped),
    ]


def _converted(send: str = _SEND, heard: str = _HEARD) -> list[Edit]:
    """Return two nodes with images, each with its own bridge."""
    edits: list[Edit] = [(LAUNCH, MORE, _NODES)]
    for file in (PILOT, HORN):
        edits += [
            (file, "geometry_msgs.msg import Twist", "sensor_msgs.msg import Image"),
            (file, "(Twist, ", "(Image, "),
            (file, "import Node\n", "import Node\nfrom cv_bridge import CvBridge\n"),
            (
                file,
                "    def __init__(self):\n",
                "    bridge = CvBridge()\n\n    def __init__(self):\n",
            ),
        ]
    edits.append((PILOT, "        self.publisher.publish(Twist())\n", send))
    edits.append((HORN, "        self.get_logger().info('beep')\n", heard))
    return edits


_CMAKE = """\
project(viewer)
find_package(ament_cmake REQUIRED)
find_package(cv_bridge REQUIRED)
find_package(geometry_msgs REQUIRED)
find_package(message_filters REQUIRED)
find_package(rclcpp REQUIRED)
find_package(sensor_msgs REQUIRED)
add_executable(viewer src/viewer.cpp)
ament_target_dependencies(
  viewer cv_bridge geometry_msgs message_filters rclcpp sensor_msgs)
install(TARGETS viewer DESTINATION lib/viewer)
ament_package()
"""
_MANIFEST = """\
<package format="3">
  <name>viewer</name>
  <version>1.0.0</version>
  <description>Shows images</description>
  <maintainer email="a@example.org">A</maintainer>
  <license>MIT</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <depend>cv_bridge</depend>
  <depend>geometry_msgs</depend>
  <depend>message_filters</depend>
  <depend>rclcpp</depend>
  <depend>sensor_msgs</depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""
_VIEWER = """\
#include <cv_bridge/cv_bridge.hpp>
#include <message_filters/subscriber.h>
#include <message_filters/time_synchronizer.h>
#include <rclcpp/rclcpp.hpp>

namespace encodings = sensor_msgs::image_encodings;
using geometry_msgs::msg::Twist;
using sensor_msgs::msg::Image;

class Viewer : public rclcpp::Node
{
public:
  Viewer()
  : Node("viewer")
  {
    CONSTRUCTOR
  }

private:
  METHODS
  rclcpp::Publisher<Image>::SharedPtr publisher_;
  rclcpp::Subscription<Image>::SharedPtr subscription_;
  message_filters::Subscriber<Image> images_;
  message_filters::Subscriber<Twist> twists_;
};

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  rclcpp::spin(std::make_shared<Viewer>());
}
"""
_CPP_HEARS = (
    'subscription_ = create_subscription<Image>("drive", 10, '
    "[this](Image::ConstSharedPtr message) { heard(message); });"
)
_CPP_HEARD = (
    "void heard(Image::ConstSharedPtr message) "
    "{ show(cv_bridge::toCvShare(message, encodings::BGR8)->image); }"
)
_CPP_SENDS = 'publisher_ = create_publisher<Image>("drive", 10);'
_CPP_SENT = (
    'void send() { Image message; message.encoding = "16UC1"; publisher_->publish(message); }'
)
_CPP_FUSED = (
    'images_.subscribe(this, "image"); twists_.subscribe(this, "twist"); '
    "auto pairs = std::make_shared<SYNCHRONISER>(10); "
    "pairs->registerCallback(std::bind(&Viewer::both, this, std::placeholders::_1));"
)
_CPP_PAIRS = "message_filters::TimeSynchronizer<Image, Twist>"


def _viewer(constructor: str, methods: str = "", started: str = "") -> list[Edit]:
    """Return the edits that add a package with a node in C++."""
    text = _VIEWER.replace("CONSTRUCTOR", constructor).replace("METHODS", methods)
    files = {"package.xml": _MANIFEST, "CMakeLists.txt": _CMAKE, "src/viewer.cpp": text}
    edits: list[Edit] = [(f"/viewer/{path}", it, it) for path, it in files.items()]
    return [*edits, (LAUNCH, MORE, f"Node(package='viewer', executable='viewer'), {started}")]


_PLAIN = "ApproximateTimeSynchronizer(filters, 10, 0.1)"
_ALONE = {  # nodes in Python, of which a launch file starts one
    name: f"Node(package='rover', executable='{name}')," for name in ("pilot", "horn")
}
WRONG: list[tuple[str, list[Edit]]] = [
    (
        (
            "REF025 rover/horn.py:13 geometry_msgs.msg.Twist has no header with a time: "
            "ApproximateTimeSynchronizer drops messages without allow_headerless"
        ),
        _fused(_PLAIN),
    ),
    (
        (
            "REF025 rover/horn.py:13 geometry_msgs.msg.Twist has no header with a time: "
            "ApproximateTimeSynchronizer drops messages without allow_headerless"
        ),
        _fused("ApproximateTimeSynchronizer(filters, 10, 0.1, False)"),
    ),
    (
        (
            "REF025 rover/horn.py:13 geometry_msgs.msg.Twist has no header with a time: "
            "TimeSynchronizer stops at messages"
        ),
        _fused("message_filters.TimeSynchronizer(filters, 10)"),
    ),
    (
        (
            "REF025 rover/pilot.py:9 the publisher keeps 0 messages, which ROS 2 reads as the default "
            "of the middleware, mostly 1: write how many"
        ),
        [(PILOT, "'drive', 10", "'drive', 0")],
    ),
    (
        (
            "REF025 rover/horn.py:15 the images of /drive have the encoding '16UC1' "
            "(rover/rover/pilot.py:16), which cv_bridge does not convert to 'bgr8'"
        ),
        _converted(),
    ),
    (
        (
            "REF025 rover/horn.py:15 the images of /drive have the encoding 'rgb8' "
            "(rover/rover/pilot.py:16), which cv_bridge does not convert to '32FC1'"
        ),
        _converted(_SEND.replace("16UC1", "rgb8"), _HEARD.replace("bgr8", "32FC1")),
    ),
    (
        (
            "REF025 rover/horn.py:15 the images of /drive have the encoding '16UC1' "
            "(rover/rover/pilot.py:16), which cv_bridge does not convert to 'mono8'"
        ),
        _converted(
            "        image = self.bridge.cv2_to_imgmsg(None, encoding='16UC1')\n"
            "        self.publisher.publish(image)\n",
            _HEARD.replace("bgr8", "mono8"),
        ),
    ),
    (
        (
            "REF025 /viewer/src/viewer.cpp:20 the images of /drive have the encoding '16UC1' "
            "(viewer/src/viewer.cpp:20), which cv_bridge does not convert to 'bgr8'"
        ),
        _viewer(f"{_CPP_SENDS} {_CPP_HEARS}", f"{_CPP_SENT} {_CPP_HEARD}"),
    ),
    (
        (
            "REF025 /viewer/src/viewer.cpp:20 the images of /drive have the encoding '16UC1' "
            "(rover/rover/pilot.py:16), which cv_bridge does not convert to 'bgr8'"
        ),
        [*_converted()[1:], *_viewer(_CPP_HEARS, _CPP_HEARD, _ALONE["pilot"])],
    ),
    (
        (
            "REF025 rover/horn.py:15 the images of /drive have the encoding '16UC1' "
            "(viewer/src/viewer.cpp:20), which cv_bridge does not convert to 'bgr8'"
        ),
        [*_converted()[1:], *_viewer(_CPP_SENDS, _CPP_SENT, _ALONE["horn"])],
    ),
    (
        (
            "REF025 /viewer/src/viewer.cpp:16 geometry_msgs.msg.Twist has no header with a time: "
            "message_filters::TimeSynchronizer uses time 0 instead, so it stops or never matches "
            "the messages"
        ),
        _viewer(_CPP_FUSED.replace("SYNCHRONISER", _CPP_PAIRS)),
    ),
]


@pytest.mark.parametrize(("problem", "edits"), WRONG, ids=[it[0][:90] for it in WRONG])
def test_a_message_that_cannot_be_used_is_named(problem: str, edits: list[Edit]) -> None:
    """It is one problem, and nothing else is reported."""
    assert problems_of(*edits) == [problem]


CORRECT: list[tuple[str, list[Edit]]] = [
    ("messages with headers", _fused(_PLAIN, "TwistStamped")),
    ("messages of a type that is not known", _fused(_PLAIN, "made()")),
    (
        "a synchroniser that takes any",
        _fused("ApproximateTimeSynchronizer(filters, 10, 0.1, True)"),
    ),
    (
        "a synchroniser that may take any",
        _fused("ApproximateTimeSynchronizer(filters, 10, 0.1, allow_headerless=any_of())"),
    ),
    ("arguments that are unpacked", _fused("ApproximateTimeSynchronizer(filters, 10, **more())")),
    ("another class", _fused("Synchronizer(filters, 10)")),
    ("filters that are not known", _fused("ApproximateTimeSynchronizer(made(), 10, 0.1)")),
    ("a colour of another order", _converted(_SEND.replace("16UC1", "rgb8"))),
    ("the same encoding", _converted(heard=_HEARD.replace("bgr8", "16UC1"))),
    ("as many channels", _converted(heard=_HEARD.replace("bgr8", "32FC1"))),
    ("any encoding", _converted(heard=_HEARD.replace("bgr8", "passthrough"))),
    ("an encoding that is not known", _converted(heard=_HEARD.replace("bgr8", "jpeg"))),
    ("an encoding that is computed", _converted(_SEND.replace("'16UC1'", "made()"))),
    (
        "a callback that asks for the encoding",
        _converted(heard=f"        if message.encoding != '16UC1':\n    {_HEARD}"),
    ),
    ("another image", _converted(heard=f"        message = made()\n{_HEARD}")),
    ("another message", _converted("        self.publisher.publish(made())\n")),
    (
        "a second encoding",
        _converted(_SEND + _SEND.replace("16UC1", "bgr8")),
    ),
    (
        "a callback with a second conversion",
        _converted(heard=_HEARD + _HEARD.replace("bgr8", "16UC1")),
    ),
    (
        "a colour of another order in C++",
        [
            *_converted(_SEND.replace("16UC1", "rgb8"))[1:],
            *_viewer(_CPP_HEARS, _CPP_HEARD, _ALONE["pilot"]),
        ],
    ),
    (
        "a second publisher, of which nothing is known",
        [
            *_converted()[1:],
            *_viewer(_CPP_SENDS, "void send() { publisher_->publish(made()); }", MORE),
            (LAUNCH, MORE, _NODES),
        ],
    ),
    (
        "messages with headers in C++",
        _viewer(_CPP_FUSED.replace("SYNCHRONISER", _CPP_PAIRS.replace("Twist", "Image"))),
    ),
    (
        "messages in C++ of which none has a header",
        _viewer(_CPP_FUSED.replace("SYNCHRONISER", _CPP_PAIRS.replace("Image", "Twist"))),
    ),
]


@pytest.mark.parametrize("edits", [it[1] for it in CORRECT], ids=[it[0] for it in CORRECT])
def test_messages_that_may_be_used_are_not_reported(edits: list[Edit]) -> None:
    """What is right, and what is not known."""
    assert [it for it in problems_of(*edits) if "REF025" in it] == []
