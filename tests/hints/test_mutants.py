"""The share of single mistakes for which hints are found that undo them."""

from tests.hints.trials import bases, hints_for

BASES = {base.name: base for base in bases()}
REFERENCE = BASES["reference"]


def test_a_link_without_name_gets_its_name() -> None:
    """The name that a joint uses is added to the link; the link is not copied."""
    changed = REFERENCE.text.replace('<link name="lidar">', "<link>")
    hints = hints_for(REFERENCE.changed(changed))
    assert [(edit.old, edit.new) for found in hints.found for edit in found.edits] == [("<link", '<link name="lidar"')]
    assert hints.is_full
