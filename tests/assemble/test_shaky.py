"""Mechanisms that move to first order only are refused; those that move are not."""

import numpy as np
import pytest

from trsim.assemble.shaky import definite, none_is
from trsim.errors import ModelError

from .. import sizes
from ..overconstrained import (
    ORDINARY,
    TILTED,
    Z,
    bennett,
    bricard,
    chain,
    cranks,
    framework,
    sarrus,
    slider_crank_at_dead_centre,
    text,
)
from ..runs import built

CHAINS = {"two": [(0,), (1,), (2,)], "unequal": [(0,), (1,), (1.3,)],
          "three": [(0,), (1,), (2.5,), (3,)]}  # fmt: skip
DRIVEN = "drives: {motor: {joint: J0, velocity: 1}}"


@pytest.mark.parametrize("R", [ORDINARY, TILTED], ids=["drawn", "tilted"])
@pytest.mark.parametrize("axis", [Z, (0, 1, 0), (0, 1, 1), None], ids=str)
@pytest.mark.parametrize("points", CHAINS.values(), ids=CHAINS)
def test_stretched_bars_do_not_swing(points, axis, R):
    with pytest.raises(ModelError, match="shaky"):
        built(text(chain(points, axis), R=R))


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("more", ["", DRIVEN, "gravity: [1, -9.81]"])
def test_nor_in_the_plane_whatever_drives_or_loads_them(more, size):
    for points in CHAINS.values():
        with pytest.raises(ModelError, match="shaky"):
            built(text(chain(points), more, planar="true", size=size))


@pytest.mark.parametrize("planar", ["true", "false"])
def test_a_third_crank_of_another_length_stops_a_parallelogram(planar):
    with pytest.raises(ModelError, match=r"F0, T0, F1, T1, F2, T2 .* shaky") as error:
        built(text(cranks((1, 1, 0.5), (0, 1, 2), 1.2), planar=planar))
    assert error.value.exit_code == 4
    assert built(text(cranks((1, 1, 1), (0, 1, 2), 1.2), planar=planar)).mobility == 1


def test_what_does_not_belong_to_it_is_no_excuse():
    bodies, joints = chain(CHAINS["two"])
    bodies["pendulum"] = (5, -0.5, 0)
    joints["pin"] = ("ground", "pendulum", (5, 0, 0), Z)
    with pytest.raises(ModelError, match="J0, J1, J2 allow"):
        built(text((bodies, joints), planar="true"))


MOVING = {
    "bennett": (bennett(), "false"),
    "bricard": (bricard(), "false"),
    "sarrus": (sarrus(), "false"),
    "five cranks": (cranks((1,) * 5, (0, 1, 2, 3.3, 5), 1.0), "true"),
    "flat cranks": (cranks((1, 1, 1), (0, 1.2, 2.5), 0.0, 0.0), "true"),
    "flat parallelogram": (chain([(0,), (1,), (3,), (2,)]), "true"),
    "folded rhombus": (chain([(0,), (1,), (2,), (1,)]), "true"),
    "dead centre": (slider_crank_at_dead_centre(), "true"),
}


@pytest.mark.parametrize("R", [ORDINARY, TILTED], ids=["drawn", "tilted"])
@pytest.mark.parametrize("parts", MOVING.values(), ids=MOVING)
def test_what_moves_is_not_refused(parts, R):
    linkage, planar = parts
    flat = planar == "true" and R is ORDINARY
    assert built(text(linkage, R=R, planar=planar if flat else "false")).mobility >= 0


def test_a_drive_is_no_bar():
    """Driven where it cannot go on, a slider-crank is at a dead centre, not rigid."""
    more = "drives: {motor: {joint: track, velocity: 0}}"
    assert built(text(slider_crank_at_dead_centre(), more, planar="true")).mobility == 0


def by_nodes(nodes, bars, held):
    """(motions, stresses, forms) of a framework, from its rigidity matrix.

    Rows p_i - p_j; sum over the bars of stress |v_i - v_j|^2 is the form [ConnellyWhiteley1996].
    """
    p = np.array(nodes, float)
    free = [k for k in range(len(p)) if k not in held]
    R = np.zeros((len(bars), 2 * len(p)))
    for row, (i, j) in zip(R, bars, strict=True):
        row[2 * i : 2 * i + 2], row[2 * j : 2 * j + 2] = p[i] - p[j], p[j] - p[i]
    R = R.reshape(len(bars), len(p), 2)[:, free].reshape(len(bars), -1)
    u, s, vt = np.linalg.svd(R)
    rank = int(np.sum(s > 1e-9 * s[0]))
    motions, stresses = vt[rank:], u[:, rank:].T
    V = np.zeros((len(motions), len(p), 2))
    V[:, free] = motions.reshape(len(motions), len(free), 2)
    across = np.array([V[:, i] - V[:, j] for i, j in bars])
    return motions, stresses, np.einsum("wb,bmx,bnx->wmn", stresses, across, across)


def test_frameworks_are_judged_as_by_their_rigidity_matrices():
    """Random frameworks of pinned bars, a third of them with nodes on one line or circle."""
    rng, seen = np.random.default_rng(16), {"rigid": 0, "shaky": 0, "moves": 0}
    for case in range(sizes.size(36, 60)):
        n = int(rng.integers(4, 7))
        nodes = rng.uniform(-1, 1, (n, 2))
        if case % 3 == 1:
            nodes[:, 1] *= 0.0
            nodes[:, 0] = np.sort(nodes[:, 0]) + np.arange(n)
        pairs = [(i, j) for i in range(n) for j in range(i)]
        held = {0, n - 1}
        pairs = [p for p in pairs if not set(p) <= held]
        rng.shuffle(pairs)
        used = [tuple(map(int, p)) for p in pairs[: int(rng.integers(n - 1, 2 * (n - 2) + 2))]]
        free = [k for k in range(n) if k not in held]
        if any(sum(k in bar for bar in used) < 2 for k in free):
            continue
        motions, stresses, forms = by_nodes(nodes, used, held)
        signs = np.linalg.eigvalsh(forms) if len(forms) and len(motions) else np.zeros((0, 1))
        proved = any(np.abs(v).min() > 1e-2 * np.abs(v).max() and np.ptp(np.sign(v)) == 0
                     for v in signs)  # fmt: skip
        whole = framework(nodes, used, held)
        try:
            built(text(whole, planar="true"))
            refused = False
        except ModelError as error:
            refused = "shaky" in str(error)
            assert refused, str(error)
        if proved:
            assert refused, (case, nodes, used)
            seen["shaky"] += 1
        elif not len(motions) or not len(stresses):
            assert not refused, (case, nodes, used)
            seen["rigid" if not len(motions) else "moves"] += 1
    assert min(seen.values()) >= 3, seen


def test_definite_combinations_are_found_and_only_those():
    rng = np.random.default_rng(4)
    for _ in range(50):
        n, w = rng.integers(1, 6), rng.integers(1, 5)
        forms = rng.normal(size=(w, n, n))
        forms += forms.transpose(0, 2, 1)
        c = definite(forms)
        if c is not None:
            assert np.linalg.eigvalsh(np.tensordot(c, forms, 1)).min() > 0
        hidden = rng.normal(size=w)
        hidden /= np.linalg.norm(hidden)
        forms += np.multiply.outer(hidden, 8 * np.eye(n))
        c = definite(forms)
        assert c is not None
        assert np.linalg.eigvalsh(np.tensordot(c, forms, 1)).min() > 0
    assert definite(np.array([[[1.0, 0.0], [0.0, -1.0]]])) is None
    assert definite(np.zeros((0, 2, 2))) is None


@pytest.mark.parametrize("size", [1e-8, 1.0, 1e8])
def test_what_is_definite_is_so_in_any_unit(size):
    one = size * np.array([np.diag([1.0, 2.0, 3.0])])
    assert definite(one) is not None
    assert definite(-one) is not None
    assert definite(size * np.array([np.diag([1.0, -1.0, 3.0])])) is None


def test_what_is_proved_not_to_be_there():
    """Of two motions always: of all forms of a span one has the largest determinant."""
    rng = np.random.default_rng(5)
    proved = 0
    for _ in range(300):
        many = rng.integers(1, 3)
        forms = rng.normal(size=(many, 2, 2))
        forms = forms + forms.transpose(0, 2, 1)
        more = np.einsum("vw,wij->vij", rng.normal(size=(4, many)), forms)  # of the same span
        angle = np.linspace(0.0, np.pi, 2000)
        a, b = (forms if many == 2 else forms[[0, 0]])[:2]
        total = np.cos(angle)[:, None, None] * a + np.sin(angle)[:, None, None] * b
        there = (np.linalg.det(total) / np.linalg.norm(total, axis=(1, 2)) ** 2).max()
        if abs(there) > 0.01:
            proved += none_is(more)
            assert none_is(more) == (there < 0.0)
            assert there > 0.0 or definite(more) is None
    assert 50 < proved < 250
    assert none_is(np.array([np.diag([1.0, -1.0, 0.0]), np.diag([0.0, 1.0, -1.0])]))
    assert not none_is(np.array([np.diag([1.0, -1.0, 0.0]), np.diag([0.0, 1.0, 1.0])]))
    assert none_is(np.array([np.diag([1.0, 0.0])]))
    assert not none_is(np.array([np.diag([1.0, 0.0]), np.diag([0.0, 1.0])]))
