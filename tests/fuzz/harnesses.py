"""The harnesses by name, each with its seeds, its dictionary and the size of its inputs."""

import tomllib
from collections.abc import Callable, Iterable
from functools import partial

from tests.fuzz import (
    classes,
    documents,
    meshes,
    packages,
    recordings,
    robots,
    seeds,
    submissions,
)
from tests.fuzz.harness import FOLDER, Harness

_WORDS: dict[str, list[str]] = tomllib.loads((FOLDER / "words.toml").read_text())
_FAULTY_PACKAGES = (
    "launch",
    "setup",
    "rviz",
    "glob",
    "missing",
    "folder",
    "no",
    "package",
    "cmake",
)


def _row(
    run: Callable[[bytes], object],
    words: str,
    size: int,
    made: Callable[[], Iterable[bytes]] = tuple,
    found: Iterable[str] = (),
) -> Harness:
    """Return a harness with the words of some topics, the seeds that are made, and those that patterns find."""
    pieces = tuple(piece for topic in words.split() for piece in _WORDS[topic])
    return Harness(run, tuple(found), pieces, size, made)


def _launch(ending: str, words: str) -> Harness:
    patterns = (f"tests/launch/launch_samples/*.{ending}.txt", f"rubrics/**/*.launch.{ending}")
    return _row(packages.LAUNCHES[ending], words, 4096, found=patterns)


def _graded(run: Callable[..., None], rubric: str, words: str, size: int, *found: str) -> Harness:
    return _row(
        partial(run, rubric=rubric),
        words,
        size,
        found=[f"submissions/{pattern}" for pattern in found],
    )


HARNESSES: dict[str, Harness] = {
    "urdf": _row(robots.urdf, "xml urdf", 1024, seeds.urdfs),
    "inspection": _row(robots.inspection, "urdf", 1024, seeds.urdfs),
    "tinyxml2": _row(robots.tinyxml2, "xml urdf", 512, seeds.urdfs),
    "syntax": _row(robots.syntax, "xml urdf", 256, seeds.broken),
    "xacro": _row(
        robots.xacro, "xacro expression xacro-more", 1536, seeds.xacro, ["rubrics/**/*.xacro"]
    ),
    "expressions": _row(robots.expressions, "expression", 200, seeds.expressions),
    "yaml-values": _row(robots.yaml_values, "yaml yaml-values", 192, seeds.yaml_files),
    "setup": _row(
        packages.setup,
        "python",
        4096,
        found=["tests/installation/setup_samples/*", "rubrics/**/setup.py"],
    ),
    "launch-py": _launch("py", "python launch"),
    "launch-xml": _launch("xml", "xml frontend"),
    "launch-yaml": _launch("yaml", "frontend yaml"),
    "cmake": _row(packages.cmake, "cmake", 4096, found=["submissions/**/CMakeLists.txt"]),
    "cpp": _row(
        packages.cpp,
        "cpp",
        3072,
        found=["tests/labs/*/solution/**/*.cpp"],
    ),
    "manifest": _row(packages.manifest, "xml manifest", 4096, found=["rubrics/**/package.xml"]),
    "rviz": _row(packages.rviz, "yaml rviz", 4096, found=["rubrics/**/*.rviz"]),
    "yaml": _row(
        packages.yaml, "yaml", 2048, seeds.yaml_files, ["tests/launch/launch_samples/*.yaml.txt"]
    ),
    **{
        f"mesh-{ending}": _row(
            run, f"{'xml ' if ending == 'dae' else ''}mesh", 2048, partial(meshes.seeds, ending)
        )
        for ending, run in meshes.MESHES.items()
    },
    **{
        f"recording-{ending}": _row(run, "recording", 16_384, partial(recordings.seeds, ending))
        for ending, run in recordings.RECORDINGS.items()
    },
    "archive": _row(documents.archive, "archive", 4096, documents.archives),
    "class-zip": _row(documents.class_zip, "class-zip", 4096, documents.classes),
    "answers": _row(documents.answers, "markdown", 1024, documents.documents),
    "names": _row(documents.names, "names", 512, documents.file_names),
    "picture": _row(documents.picture, "picture", 512, documents.pictures),
    "rubric": _row(classes.rubric, "toml", 8192, classes.rubrics),
    "roster": _row(classes.roster, "csv", 1024, classes.rosters),
    **{
        name: _row(run, "csv lms", 2048, classes.LMS_SEEDS[name])
        for name, run in classes.LMS.items()
    },
    "requests": _row(classes.requests, "http", 1024, classes.sent_requests),
    "grade-lab6": _graded(
        submissions.urdf,
        "lab6",
        "xml urdf",
        4096,
        "../rubrics/lab6/**/*.urdf",
        "lab6/*/my_robot/urdf/*.urdf",
    ),
    "grade-arm": _graded(
        submissions.urdf, "arm", "xml urdf", 6144, "../rubrics/arm/*.urdf", "arm/*/*.urdf"
    ),
    "grade-package": _graded(
        submissions.package,
        "lab6",
        "xml urdf python launch",
        16384,
        "../rubrics/lab6",
        "lab6/reference",
        *(f"lab6/{start}-*" for start in _FAULTY_PACKAGES),
    ),
    "grade-xacro": _graded(
        submissions.package,
        "sensors",
        "xml urdf xacro launch",
        12288,
        "../rubrics/sensors",
        "sensors/*",
    ),
}
