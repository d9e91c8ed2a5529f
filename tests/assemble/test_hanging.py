"""Which bodies hang on those that are parked."""

from types import SimpleNamespace

import pytest

from trsim.assemble.hanging import hanging


def joint(name, i, j):
    return SimpleNamespace(
        section="joints", name=name, row=SimpleNamespace(relates=False, con=(i, j)),
        named_by_rows=None,
    )  # fmt: skip


@pytest.mark.parametrize("a, b", [(1, 2), (2, 1)])
def test_what_only_a_parked_body_holds_hangs_on_it(a, b):
    """Wherever it stands in the scene; not what the ground holds as well, nor what is apart."""
    frames = {"ground": 0, **dict(sorted({"parked": a, "hung": b, "held": 3}.items()))}
    joints = [joint("p", a, b), joint("q", a, 3), joint("r", 3, 0)]
    assert set(hanging(["parked"], joints, frames, ())) == {"parked", "hung"}
    assert hanging(["parked"], joints, frames, ["p"]) == ("parked",)
    assert set(hanging(["parked"], joints, frames, ["r"])) == {"parked", "hung", "held"}
