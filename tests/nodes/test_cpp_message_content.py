"""What nodes in C++ ask of the content of messages: what is certain is known, and nothing else."""

import pytest

from tests.nodes.test_cpp_nodes import nodes_of

pytestmark = pytest.mark.slow

_HEAD = """
#include <cv_bridge/cv_bridge.hpp>
#include <rclcpp/rclcpp.hpp>
using sensor_msgs::msg::Image;
using std::placeholders::_1;
namespace enc = sensor_msgs::image_encodings;
"""
_PUBLISHER = 'pub_ = create_publisher<Image>("image", 10);'
_SUBSCRIPTION = 'sub_ = create_subscription<Image>("image", 10, {});'
_BOUND = "std::bind(&Talker::heard, this, _1)"
_SEND = "pub_->publish(*cv_bridge::CvImage(h, WIDE, m).toImageMsg());"


def _text(constructor: str, methods: str, initializers: str = "", before: str = "") -> str:
    return (
        f"{_HEAD}{before}class Talker : public rclcpp::Node {{ public:"
        f'Talker() : Node("talker"){initializers} {{ {constructor} }} {methods}'
        'const std::string WIDE = "16UC1"; std::string set_; Image whole_;'
        "rclcpp::Publisher<Image>::SharedPtr pub_; rclcpp::Subscription<Image>::SharedPtr sub_; };\n"
        "int main() { rclcpp::spin(std::make_shared<Talker>()); }"
    )


def encodings(text: str) -> list[str]:
    """Return the encodings of the images that the only endpoint of a node sends or asks for."""
    [node] = nodes_of(text).nodes
    [endpoint] = node.endpoints
    return [it.name for it in endpoint.encodings]


_COPY = 'cv_bridge::toCvCopy(b, "bgr8")'
_BLURRED = "cv::blur(a->image, a->image, s); pub_->publish(*a->toImageMsg());"
SENT = [
    ("16UC1", _SEND),
    ("16UC1", "auto a = cv_bridge::CvImage(h, enc::TYPE_16UC1, m).toImageMsg(); pub_->publish(*a);"),
    ("bgr8", "cv_bridge::CvImage a(h, enc::BGR8, m); this->pub_->publish(*(a.toImageMsg()));"),
    ("rgb8", 'cv_bridge::CvImage a{h, "rgb8", m}; pub_->publish(*a.toImageMsg());'),
    ("mono8", "cv_bridge::CvImage a; a.image = m; a.encoding = enc::MONO8; pub_->publish(*a.toImageMsg());"),
    ("32FC1", 'auto a = std::make_shared<cv_bridge::CvImage>(h, "32FC1", m); pub_->publish(*a->toImageMsg());'),
    ("bgr8", 'pub_->publish(*cv_bridge::CvImage{h, "bgr8", m}.toImageMsg());'),
    ("16UC1", 'Image a; a.encoding = "16UC1"; a.data.resize(9); pub_->publish(a);'),
    ("16UC1", "auto a = std::make_unique<Image>(); a->encoding = WIDE; pub_->publish(std::move(a));"),
    ("mono8", 'Image a; a.encoding = "mono8"; if (pub_->get_subscription_count() > 0) { pub_->publish(a); }'),
    ("bgr8", f"cv_bridge::CvImagePtr a; try {{ a = {_COPY}; }} catch (...) {{ return; }} {_BLURRED}"),
]  # fmt: skip


@pytest.mark.parametrize(("encoding", "body"), SENT)
def test_the_encoding_that_is_sent(encoding: str, body: str) -> None:
    """Of a message whose encoding is set, and of an image of cv_bridge."""
    assert encodings(_text(_PUBLISHER, f"void send() {{ {body} }}")) == [encoding]


def test_a_message_that_the_constructor_fills() -> None:
    """Its encoding is set once, before any method is called."""
    constructor = f'{_PUBLISHER} whole_.encoding = "8UC1";'
    assert encodings(_text(constructor, "void send() { pub_->publish(whole_); }")) == ["8UC1"]
    late = 'void set() { whole_.encoding = "8UC1"; } void send() { pub_->publish(whole_); }'
    assert encodings(_text(_PUBLISHER, late)) == []


def test_a_publisher_that_is_made_before_the_body() -> None:
    """In the list of initializers, and as a local variable."""
    send = f"void send() {{ {_SEND} }}"
    made = ', pub_(create_publisher<Image>("image", 10))'
    assert encodings(_text("", send, made)) == ["16UC1"]
    local = f"auto p = {_PUBLISHER.removeprefix('pub_ = ')} {_SEND.replace('pub_', 'p')}"
    assert encodings(_text(local, "")) == ["16UC1"]


OPEN_SENT = [
    "pub_->publish(*made());",
    "pub_->publish(*cv_bridge::CvImage(h, set_, m).toImageMsg());",
    "pub_->publish(*cv_bridge::CvImage().toImageMsg());",
    "pub_->publish(*cv_bridge::CvImage(h, enc::NV21, m).toImageMsg());",
    "pub_->publish(*cv_bridge::toCvCopy(a)->toImageMsg());",
    'pub_->publish(*cv_bridge::toCvCopy(a, "passthrough")->toImageMsg());',
    "pub_->publish(list[0]);",
    "pub_->publish(other_->whole_);",
    "pub_->publish(another_);",
    f"{_SEND} send_all(pub_);",
    f"{_SEND} pub_->borrow_loaned_message();",
    f"{_SEND} pub_->impl.all();",
    f"{_SEND} pub_ = nullptr;",
    f"{_SEND} pub_->publish(*made());",
    'Image a; if (b) { a.encoding = "16UC1"; } pub_->publish(a);',
    'Image a; pub_->publish(a); a.encoding = "16UC1";',
    'Image a; a.encoding = "16UC1"; a.encoding = "bgr8"; pub_->publish(a);',
    'Image a; a.encoding = "16UC1"; fill(a); pub_->publish(a);',
    'Image a; a.encoding = "16UC1"; Image & b = a; pub_->publish(a);',
    'Image a; a.encoding = "16UC1"; a.encoding.assign(b); pub_->publish(a);',
    'Image a; a.encoding = "16UC1"; a.swap(b); pub_->publish(a);',
    "Image a = made(); pub_->publish(a);",
    "Image a; a = b; a = c; pub_->publish(a);",
    '{ Image a; } Image a; a.encoding = "16UC1"; pub_->publish(a);',
    'Image a; if (b) a.encoding = "16UC1"; pub_->publish(a);',
    'Image a; for (auto & b : c) a.encoding = "16UC1"; pub_->publish(a);',
    'Image a; switch (b) { case 0: a.encoding = "16UC1"; break; case 1: pub_->publish(a); }',
    'Image a; a.encoding = "16UC1"; a = *cv_bridge::CvImage(h, "bgr8", m).toImageMsg(); pub_->publish(a);',
    '\nImage a;\n#ifdef WIDE\na.encoding = "16UC1";\n#endif\npub_->publish(a);',
]  # fmt: skip


@pytest.mark.parametrize("body", OPEN_SENT)
def test_an_encoding_that_is_not_known(body: str) -> None:
    """It may be another one, or another function may set it."""
    assert encodings(_text(_PUBLISHER, f"void send() {{ {body} }}")) == []


HEARD = [
    ("bgr8", "const Image::ConstSharedPtr & m", 'auto a = cv_bridge::toCvShare(m, "bgr8");'),
    ("bgr8", "Image::ConstSharedPtr m", "cv_bridge::CvImagePtr a; try { a = cv_bridge::toCvCopy(*m, enc::BGR8); } catch (...) {}"),
    ("mono8", "Image::ConstSharedPtr m", 'show(cv_bridge::toCvShare(*m, m, "mono8")->image);'),
]  # fmt: skip


@pytest.mark.parametrize(("encoding", "parameter", "body"), HEARD)
def test_the_encoding_that_a_callback_asks_for(encoding: str, parameter: str, body: str) -> None:
    """In a method, in a lambda, and in a method that a lambda calls."""
    method = f"void heard({parameter}) {{ {body} }}"
    whole = f"[this]({parameter}) {{ {body} }}"
    assert encodings(_text(_SUBSCRIPTION.format(_BOUND), method)) == [encoding]
    assert encodings(_text(_SUBSCRIPTION.format(whole), "")) == [encoding]
    for call in ("heard(m)", "this->heard(std::move(m))"):
        calling = f"[this]({parameter}) {{ {call}; }}"
        assert encodings(_text(_SUBSCRIPTION.format(calling), method)) == [encoding]
    named = f"auto callback = {whole}; {_SUBSCRIPTION.format('callback')}"
    assert encodings(_text(named, "")) == [encoding]


_ASKS = 'cv_bridge::toCvShare(m, "bgr8");'
OPEN_HEARD = [
    (_BOUND, f"if (!convert_) {{ return; }} {_ASKS}"),
    (_BOUND, 'if (m->encoding == "mono8") {{ cv_bridge::toCvShare(m, "bgr8"); }}'),
    (_BOUND, f"m = other(); {_ASKS}"),
    (_BOUND, f"cv_bridge::toCvShare(m); {_ASKS}"),
    (_BOUND, f"cv_bridge::toCvShare(m, set_); {_ASKS}"),
    (_BOUND, 'cv_bridge::toCvShare(other_, "bgr8");'),
    (_BOUND, f"\n#ifdef COLOUR\n{_ASKS}\n#endif\n"),
    ("std::bind(&Other::heard, this, _1)", _ASKS),
    ("std::bind(heard, this, _1)", _ASKS),
    ("callback(&Talker::heard)", _ASKS),
    ("callback_", _ASKS),
    ("[this](Image::ConstSharedPtr) { heard(other_); }", _ASKS),
    ("[this](Image::ConstSharedPtr m) { later(m); }", _ASKS),
    ("[this](Image::ConstSharedPtr m) { next_->heard(m); }", _ASKS),
    ("[this](Image::ConstSharedPtr m) { if (m) heard(m); }", _ASKS),
]  # fmt: skip


@pytest.mark.parametrize(("callback", "body"), OPEN_HEARD)
def test_what_a_callback_asks_for_is_not_known(callback: str, body: str) -> None:
    """It reads the encoding itself, converts something else, or is not the callback."""
    method = f"void heard(Image::ConstSharedPtr m) {{ {body} }}"
    assert encodings(_text(_SUBSCRIPTION.format(callback), method)) == []


def test_a_method_that_is_overloaded_asks_for_nothing() -> None:
    """Which of the two is the callback is not known."""
    methods = f"void heard(Image::ConstSharedPtr m) {{ {_ASKS} }} void heard(int m) {{ use(m); }}"
    assert encodings(_text(_SUBSCRIPTION.format(_BOUND), methods)) == []


# --- Synchronisers
# ----------------------------------------------------------------------

_TWIST = "geometry_msgs::msg::Twist"
_STARTS = "sync_->registerCallback(std::bind(&Talker::both, this, _1, _2));"


def synchronised(text: str) -> list[tuple[str, str]]:
    """Return the types of the messages that synchronisers compare, and the classes of these."""
    return [(it.type, it.by) for it in nodes_of(text).synchronised]


SYNCHRONISERS = [
    (f"std::shared_ptr<message_filters::TimeSynchronizer<Image, {_TWIST}>> sync_;", "TimeSynchronizer"),
    (f"message_filters::TimeSynchronizer<Image, {_TWIST}> sync_;", "TimeSynchronizer"),
    (f"typedef message_filters::sync_policies::ApproximateTime<Image, {_TWIST}> Policy;", "sync_policies::ApproximateTime"),
    (f"using Kind = {_TWIST}; using Policy = policies::ExactTime<Image, Kind>;", "sync_policies::ExactTime"),
    (f"std::shared_ptr<message_filters::Synchronizer<policies::ApproximateTime<Image, {_TWIST}>>> sync_;", "sync_policies::ApproximateTime"),
]  # fmt: skip


@pytest.mark.parametrize(("members", "by"), SYNCHRONISERS)
def test_types_that_a_synchroniser_compares(members: str, by: str) -> None:
    """Each once, as the synchroniser or its policy names them, also in a namespace."""
    before = "namespace policies = message_filters::sync_policies;\n"
    text = _text(_STARTS, members, before=before)
    by = f"message_filters::{by}"
    types = ("sensor_msgs.msg.Image", "geometry_msgs.msg.Twist")
    assert synchronised(text) == [(each, by) for each in types]
    inside = text.replace("class Talker", "namespace hub { class Talker", 1)
    inside = inside.replace("int main", "} using hub::Talker; int main")
    assert synchronised(inside) == [(each, by) for each in types]
    repeated = _text(_STARTS, f"{members} {members.replace('sync_', 'other_')}", before=before)
    assert synchronised(repeated) == synchronised(text)


def test_types_that_no_synchroniser_compares() -> None:
    """Nothing starts it, the messages have a time of their own, or the types are not known."""
    [members, _], filters = SYNCHRONISERS[0], "#include <message_filters/message_traits.h>\n"
    trait = "template<> struct message_filters::message_traits::TimeStamp<Thing> {};\n"
    assert synchronised(_text("", members)) == []
    assert synchronised(_text(_STARTS, members, before=trait)) == []
    assert len(synchronised(_text(_STARTS, members, before=filters))) == 2
    assert synchronised(_text(_STARTS, members.replace("message_filters", "own"))) == []
    assert synchronised(_text(_STARTS, f"\n#ifdef A\n{members}\n#endif\n")) == []
    open_type = _text(_STARTS, members.replace(_TWIST, "Kind"))
    assert synchronised(open_type) == [
        ("sensor_msgs.msg.Image", "message_filters::TimeSynchronizer")
    ]


_FILTERS = [
    ('a_.subscribe(this, "image");', "message_filters::Subscriber<Image> a_;", "", 10),
    ('this->a_->subscribe(this, "image", rmw_qos_profile_sensor_data);', "std::shared_ptr<message_filters::Subscriber<Image>> a_;", "", 5),
    ('a_ = std::make_shared<message_filters::Subscriber<Image>>(this, "image", rclcpp::QoS(3).get_rmw_qos_profile());', "", "", 3),
    ('a_ = new message_filters::Subscriber<Image, rclcpp::Node>(this, "image");', "", "", 10),
    ('message_filters::Subscriber<Image> a(this, "image");', "", "", 10),
    ("", "message_filters::Subscriber<Image> a_;", ', a_(this, "image")', 10),
    ("", "message_filters::Subscriber<Image> a_;", ', a_{this, "image"}', 10),
]  # fmt: skip


@pytest.mark.parametrize(("constructor", "members", "initializers", "depth"), _FILTERS)
def test_the_subscription_of_a_filter(
    constructor: str, members: str, initializers: str, depth: int
) -> None:
    """A filter that is given the node opens one, and nothing else."""
    [node] = nodes_of(_text(constructor, members, initializers)).nodes
    [found] = node.endpoints
    assert (found.kind, found.type, found.name) == (
        "subscription",
        "sensor_msgs.msg.Image",
        "image",
    )
    assert (found.qos.depth, node.doubts) == (depth, ())


@pytest.mark.parametrize(
    ("constructor", "members"),
    [
        ('a_.subscribe(this, "image");', "own::Subscriber<Image> a_;"),
        ("a_.subscribe(this);", "message_filters::Subscriber<Image> a_;"),
        ('a_.add(this, "image");', "message_filters::Subscriber<Image> a_;"),
        ('made().subscribe(this, "image");', ""),
        ('a_.subscribe("image", this);', "message_filters::Subscriber<Image> a_;"),
    ],
)  # fmt: skip
def test_what_is_no_filter_leaves_the_node_open(constructor: str, members: str) -> None:
    """It is given the node, and may open anything."""
    [node] = nodes_of(_text(constructor, members)).nodes
    assert node.endpoints == ()
    assert node.doubts != ()
