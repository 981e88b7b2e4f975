"""The same mutated URDFs under the library of ROS 2 Lyrical, which reads versions 1.1 and 1.2 too."""

from functools import partial

from tests.differential import urdfs
from tests.oracles.check_urdf import LYRICAL

compare = partial(urdfs.compare, release=LYRICAL)
