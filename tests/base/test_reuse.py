"""Equal small files are read once."""

from grader.base.reuse import reuse


def test_equal_small_files_are_read_once() -> None:
    """A reader gets equal bytes under one path once, other bytes, other paths and large files each time."""
    given: list[tuple[bytes, str]] = []

    @reuse
    def read(data: bytes, path: str) -> list[str]:
        given.append((data, path))
        return [path]

    small, large = b"<package/>", bytes(20_000)
    assert read(small, "a") is read(small, "a") == ["a"]
    assert [read(small, "b"), read(b"", "a"), read(large, "a"), read(large, "a")] == [
        ["b"],
        ["a"],
        ["a"],
        ["a"],
    ]
    assert given == [(small, "a"), (small, "b"), (b"", "a"), (large, "a"), (large, "a")]
